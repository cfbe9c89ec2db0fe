//! The memory that this process may have.

use std::path::Path;

/// Bytes that are assumed to be free if the operating system does not report them.
const USUAL_MEMORY: f64 = (16_u64 << 30) as f64;

/// Returns the number of bytes of memory that this process may have: what the machine has free, or less by a limit of
/// its address space or of a group of processes to which it belongs, as those of a container or of a job.
pub(crate) fn free_memory() -> f64 {
    let text = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let machine = kilobytes(&text("/proc/meminfo")).unwrap_or(USUAL_MEMORY);
    let address_space = address_space(&text("/proc/self/limits"));
    let own = text("/proc/self/cgroup");
    let groups = group(&own).into_iter().flat_map(|group| Path::new(group).ancestors());
    let limits = groups.filter_map(|group| {
        let limit = Path::new("/sys/fs/cgroup").join(group).join("memory.max");
        std::fs::read_to_string(limit).ok()?.trim().parse().ok()
    });
    address_space.into_iter().chain(limits).fold(machine, f64::min)
}

/// Reads the line `MemAvailable: N kB` of `/proc/meminfo`, in bytes.
fn kilobytes(text: &str) -> Option<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    Some(line.split_whitespace().next()?.parse::<f64>().ok()? * 1024.0)
}

/// Reads the line `Max address space N ..` of `/proc/self/limits`, in bytes; `None` if it is unlimited.
fn address_space(text: &str) -> Option<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|bytes| bytes as f64)
}

/// Reads the line `0::/PATH` of `/proc/self/cgroup`: the group of processes, as a path relative to that of all.
fn group(text: &str) -> Option<&str> {
    text.lines().find_map(|line| line.strip_prefix("0::/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: the lines of the kernel are read in their units, and other texts give no number.
    #[test]
    fn what_the_kernel_says() {
        assert_eq!(kilobytes("MemTotal: 9 kB\nMemAvailable:    2048 kB\n"), Some(2_097_152.0));
        assert_eq!(kilobytes("MemTotal: 9 kB\n"), None);
        let limit = |value: &str| format!("Limit  Soft Limit\nMax address space         {value}   unlimited  bytes\n");
        assert_eq!(address_space(&limit("400000000")), Some(4e8));
        assert_eq!(address_space(&limit("unlimited")), None);
        assert_eq!(group("1:memory:/a\n0::/slurm/job_1\n"), Some("slurm/job_1"));
    }
}
