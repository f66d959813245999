//! Progress as lines, where standard error is not a terminal.

use std::time::{Duration, Instant};

use opendr::Unit;

/// Minimum time between two lines.
const PAUSE: Duration = Duration::from_secs(5);

/// Progress of one piece of work.
#[derive(Debug)]
pub struct ProgressLines {
    what: String,
    total: Option<u64>,
    unit: Unit,
    done: u64,
    /// What was done before it began.
    resumed: u64,
    status: String,
    begun: Instant,
    last_print: Instant,
}

impl ProgressLines {
    /// Begins a piece of work; a download prints its name and size at once.
    pub fn begin(what: &str, total: Option<u64>, unit: Unit) -> Self {
        if unit == Unit::Bytes {
            let size = total.map_or_else(String::new, |bytes| format!(" ({})", megabytes(bytes)));
            eprintln!("{what}{size}");
        }
        let now = Instant::now();
        Self {
            what: what.to_owned(),
            total,
            unit,
            done: 0,
            resumed: 0,
            status: String::new(),
            begun: now,
            last_print: now,
        }
    }

    /// Adds `amount` to the progress.
    pub fn advance(&mut self, amount: u64) {
        self.done += amount;
        if self.last_print.elapsed() >= PAUSE {
            self.last_print = Instant::now();
            eprintln!("{}: {}", self.what, self.state(self.begun.elapsed()));
        }
    }

    /// Adds `amount` that was done before.
    pub fn advance_resumed(&mut self, amount: u64) {
        self.done += amount;
        self.resumed += amount;
    }

    /// Sets the status text of the next line.
    pub fn status(&mut self, text: &str) {
        text.clone_into(&mut self.status);
    }

    fn state(&self, elapsed: Duration) -> String {
        let amount = |count| if self.unit == Unit::Bytes { megabytes(count) } else { count.to_string() };
        let status = if self.status.is_empty() { String::new() } else { format!(", {}", self.status) };
        let Some(total) = self.total else { return amount(self.done) + &status };
        let position = format!("{} of {}", amount(self.done), amount(total));
        match self.done - self.resumed {
            0 => position + &status,
            now => {
                let left = total.saturating_sub(self.done) as f64 / now as f64 * elapsed.as_secs_f64();
                format!("{position}, {left:.0} s left{status}")
            }
        }
    }
}

fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", bytes as f64 / 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_contain_size_and_time_left() {
        let mut lines = ProgressLines::begin("model", Some(20_000_000), Unit::Bytes);
        lines.advance(5_000_000);
        assert_eq!(lines.state(Duration::from_secs(2)), "5.0 MB of 20.0 MB, 6 s left");
        let mut resumed = ProgressLines::begin("training", Some(100), Unit::Steps);
        resumed.advance_resumed(80);
        assert_eq!(resumed.state(Duration::from_secs(2)), "80 of 100");
        resumed.advance(10);
        assert_eq!(resumed.state(Duration::from_secs(2)), "90 of 100, 2 s left");
        let mut frames = ProgressLines::begin("frames", None, Unit::Items);
        frames.advance(7);
        assert_eq!(frames.state(Duration::from_secs(2)), "7");
        frames.status("loss 0.5");
        assert_eq!(frames.state(Duration::from_secs(2)), "7, loss 0.5");
    }
}
