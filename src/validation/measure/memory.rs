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
