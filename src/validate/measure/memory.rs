//! What memory a measurement takes, where the system tells (Linux).

/// Forgets what memory this process has had, so that measurements do not see those before, where the system can.
pub(super) fn forget() {
    // without it the most memory so far is that of the whole process, which is what is said then
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Most memory that this process has had since the last was forgotten, in MB, where the system tells.
pub(super) fn most() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().trim_end_matches("kB").trim().parse::<f64>().ok()? / 1024.0)
}

#[cfg(test)]
mod tests {
    use super::{forget, most};

    /// Claim: memory that was given back counts until it is forgotten and not after. 256 MB stand out of what other tests take.
    #[test]
    fn what_was_given_back_is_forgotten() {
        const MB: usize = 1 << 20;
        drop(std::hint::black_box(vec![1u8; 256 * MB]));
        let Some(before) = most() else { return };
        if std::fs::OpenOptions::new().write(true).open("/proc/self/clear_refs").is_err() {
            return;
        }
        forget();
        let after = most().unwrap();
        assert!(before >= 256.0 && after <= before - 128.0, "{before} MB before, {after} MB after");
    }
}
