//! Numbers with their nouns.

/// Returns a number with its noun: `1 well`, `2 wells`.
pub fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
