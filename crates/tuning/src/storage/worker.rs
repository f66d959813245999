//! Identity of workers, and whether they are alive.

use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::Timestamp;

static COUNTER: AtomicU64 = AtomicU64::new(0);

/// Prefix of the names of this crate's workers; Optuna's begin with a random UUID.
const OURS: &str = "opendr";

/// Returns a unique name: the machine with its boot, the process with its start, and a counter.
pub fn this_worker() -> String {
    let pid = process::id();
    let (machine, begun) = (machine(), process_start(pid));
    let (machine, begun) =
        (machine.unwrap_or_default(), begun.unwrap_or_else(|| Timestamp::now().to_string()));
    format!("{OURS}|{machine}|{pid}|{begun}|{}", COUNTER.fetch_add(1, Ordering::Relaxed))
}

/// Returns whether the process of a worker has certainly ended. This is never certain for other machines, for Optuna's processes, and
/// on systems that do not report it.
pub fn is_dead(worker: &str) -> bool {
    let mut parts = worker.split('|');
    let (Some(OURS), Some(theirs), Some(pid), Some(begun)) =
        (parts.next(), parts.next(), parts.next(), parts.next())
    else {
        return false;
    };
    let Ok(pid) = pid.parse() else { return false };
    machine().is_some_and(|machine| machine == theirs)
        && process_start(pid).is_none_or(|start| start != begun)
}

/// Returns an identifier of the machine and its boot, within which process ids are unique.
#[cfg(target_os = "linux")]
fn machine() -> Option<String> {
    let boot = std::fs::read_to_string("/proc/sys/kernel/random/boot_id").ok()?;
    let numbers = std::fs::read_link("/proc/self/ns/pid").ok()?;
    Some(format!("{} {}", boot.trim(), numbers.display()))
}

/// Returns the start time of a running process, in ticks since boot.
#[cfg(target_os = "linux")]
fn process_start(pid: u32) -> Option<String> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    // The second field is a name in parentheses, which may contain anything.
    let (_, fields) = stat.rsplit_once(')')?;
    let mut fields = fields.split_whitespace();
    let state = fields.next()?;
    fields.nth(18).filter(|_| !matches!(state, "Z" | "X")).map(str::to_owned)
}

#[cfg(not(target_os = "linux"))]
fn machine() -> Option<String> {
    None
}

#[cfg(not(target_os = "linux"))]
fn process_start(_pid: u32) -> Option<String> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn running_processes_are_alive() {
        let worker = this_worker();
        assert_ne!(worker, this_worker());
        assert!(!is_dead(&worker));
        assert!(!is_dead("") && !is_dead("6f2d-140") && !is_dead("opendr|another machine|1|2|3"));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_process_that_ended_is_dead() {
        let mut child = process::Command::new("sleep").arg("60").spawn().unwrap();
        let (machine, start) = (machine().unwrap(), process_start(child.id()).unwrap());
        let worker = format!("opendr|{machine}|{}|{start}|0", child.id());
        assert!(!is_dead(&worker));
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(is_dead(&worker));
        assert!(
            is_dead(&format!("opendr|{machine}|{}|1|0", process::id())),
            "another process has the id now"
        );
    }
}
