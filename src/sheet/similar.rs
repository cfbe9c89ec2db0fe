//! Questions about slips of the pen: the known word that is most similar to an unknown one.

/// Least similarity, from 0 to 1, of words of which one may be a slip of the other: two letters in five may differ.
const SIMILAR: f64 = 0.6;

/// Returns the known word of which another one is likely to be a slip; `None` if none is similar enough. Letters that
/// are left out, added, replaced or exchanged make words less similar (Damerau's distance over the longer length).
pub fn most_similar<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let mut best = (SIMILAR, None);
    for candidate in known.into_iter().filter(|known| *known != word) {
        let similarity = strsim::normalized_damerau_levenshtein(word, candidate);
        if similarity > best.0 {
            best = (similarity, Some(candidate));
        }
    }
    best.1
}

/// Returns the beginning of an advice, "did you mean `word`? "; empty if no known word is similar.
pub(crate) fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    most_similar(word, known).map_or_else(String::new, |word| format!("did you mean `{word}`? "))
}

/// Returns the advice about a name that is none of the known ones: which of them may be meant, and all of them.
pub(crate) fn there_are<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let question = did_you_mean(name, known.iter().copied());
    format!("{question}there are {}", known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "))
}

/// Does the same as [`did_you_mean`] with a message as serde writes it, "unknown field `word`, expected one of `a`,
/// `b`", or "invalid value: string "word", expected "a" or "b"".
pub(crate) fn did_you_mean_of(message: &str) -> String {
    let mut quoted = message.split(['`', '"']).skip(1).step_by(2);
    quoted.next().map_or_else(String::new, |word| did_you_mean(word, quoted))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: slips of one letter, or of two in a long word, find their word, and other words find none. Source: slips
    /// that users of the program made.
    #[test]
    fn slips_are_recognised() {
        let known = ["stiffness", "rest", "law", "miura", "sides", "run", "M", "V"];
        for (word, meant) in
            [("stifness", "stiffness"), ("muira", "miura"), ("sids", "sides"), ("rnu", "run"), ("stifnes", "stiffness")]
        {
            assert_eq!(did_you_mean(word, known), format!("did you mean `{meant}`? "));
        }
        // a known word is wrong for another reason
        for word in ["angle", "crane", "B", "", "rest", "sides"] {
            assert_eq!(did_you_mean(word, known), "");
        }
        assert_eq!(did_you_mean_of("unknown field `rests`, expected `rest` or `law`"), "did you mean `rest`? ");
        assert_eq!(did_you_mean_of("missing field `pattern`"), "");
        let word = "invalid value: string \"flt\", expected \"drawn\", \"flat\" or { file = \"angles.csv\" }";
        assert_eq!(did_you_mean_of(word), "did you mean `flat`? ");
    }
}
