//! Memory check of a batch, before the operating system kills the training.

use std::fs;

use opendr_engine::{Error, Result};

/// Batch size below which the check is skipped.
const SMALL: usize = 8;
/// Number of samples in the trial step.
pub const TRIAL_SAMPLES: usize = 2;
/// Share of the free memory that a training may use.
const USABLE: f64 = 0.95;

/// Runs a step with [`TRIAL_SAMPLES`] samples and extrapolates the memory of `batch_size` samples. No check on systems that do
/// not report their memory; Linux does.
///
/// # Errors
/// `InvalidParam` when the batch exceeds the memory, with the largest size that fits; the errors of `step`.
pub fn check_memory(batch_size: usize, step: impl FnOnce() -> Result<()>) -> Result<()> {
    if batch_size < SMALL || fs::write("/proc/self/clear_refs", "5").is_err() {
        return Ok(());
    }
    let (Some(before), Some(free)) = (status("VmRSS:"), free()) else { return Ok(()) };
    step()?;
    let Some(peak) = status("VmHWM:") else { return Ok(()) };
    fits(batch_size, peak.saturating_sub(before) / TRIAL_SAMPLES as u64, free)
}

fn fits(batch_size: usize, sample: u64, free: u64) -> Result<()> {
    let usable = (free as f64 * USABLE) as u64;
    let needed = sample.saturating_mul(batch_size as u64);
    if needed <= usable {
        return Ok(());
    }
    let gigabytes = |bytes: u64| bytes as f64 / 1e9;
    let most = (usable / sample.max(1)).max(1);
    Err(Error::invalid_param(format!(
        "batch_size = {batch_size} needs about {:.1} GB of memory, but {:.1} GB are free; use at most {most}, and accumulate = {} \
         for equal steps",
        gigabytes(needed),
        gigabytes(free),
        (batch_size as u64).div_ceil(most)
    )))
}

/// Returns a row of the process's status in bytes.
fn status(row: &str) -> Option<u64> {
    kilobytes(&fs::read_to_string("/proc/self/status").ok()?, row)
}

/// Returns the available memory in bytes: that of the machine, or of the control group where that is less.
fn free() -> Option<u64> {
    let machine = kilobytes(&fs::read_to_string("/proc/meminfo").ok()?, "MemAvailable:")?;
    let number =
        |name: &str| fs::read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?.trim().parse::<u64>().ok();
    let group =
        number("memory.max").zip(number("memory.current")).map(|(most, used)| most.saturating_sub(used));
    Some(group.map_or(machine, |group| group.min(machine)))
}

fn kilobytes(text: &str, row: &str) -> Option<u64> {
    let value = text.lines().find_map(|line| line.strip_prefix(row))?;
    value.split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_states_the_largest_batch() {
        assert!(fits(16, 1_000_000, 17_000_000).is_ok());
        let text = fits(4096, 50_000_000, 20_000_000_000).unwrap_err().to_string();
        assert!(text.contains("batch_size = 4096 needs about 204.8 GB"), "{text}");
        assert!(text.contains("at most 380, and accumulate = 11"), "{text}");
    }

    #[test]
    fn rows_are_read() {
        assert_eq!(kilobytes("VmPeak:\t 5 kB\nVmHWM:\t    1024 kB\n", "VmHWM:"), Some(1 << 20));
        assert_eq!(kilobytes("VmHWM: many", "VmHWM:"), None);
    }
}
