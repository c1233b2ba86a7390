//! What the system knows of this process.

/// The most memory that was held so far, in bytes; none where the system does not tell (it is Linux that does).
pub(crate) fn peak_memory_bytes() -> Option<u64> {
    let kibibytes = status("VmHWM")?.strip_suffix("kB")?.trim_end().parse::<u64>().ok()?;
    Some(kibibytes * 1024)
}

/// A line of Linux's `/proc/self/status`, by its key.
pub(crate) fn status(key: &str) -> Option<String> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let mut lines = status.lines();
    let value = lines.find_map(|line| line.strip_prefix(key)?.strip_prefix(':'))?;
    Some(value.trim().to_owned())
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn peak_memory_is_at_least_what_is_held() {
        let held = vec![1_u8; 1 << 24];
        assert!(peak_memory_bytes().unwrap() > held.len() as u64);
    }

    #[test]
    fn unknown_keys_have_no_value() {
        assert_eq!(status("NoSuchKey"), None);
    }
}
