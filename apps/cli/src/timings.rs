//! Durations of the stages of one call.

use std::time::{Duration, Instant};

use opendr::Result;
use opendr::inference::timing;
use serde::Serialize;

/// Durations of the stages of one call, in milliseconds.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Timings {
    /// Time from the call to the first run of a network.
    pub pre: f64,
    /// Time in networks.
    pub session: f64,
    /// Remaining time, between and after the networks.
    pub post: f64,
    /// Total time.
    pub total: f64,
}

impl Timings {
    /// Runs `call` and measures it.
    pub fn of<R>(call: impl FnOnce() -> Result<R>) -> Result<(R, Self)> {
        let start = Instant::now();
        timing::start();
        let result = call();
        let total = start.elapsed();
        // Digits below a microsecond are noise.
        let ms = |time: Duration| time.as_micros() as f64 / 1e3;
        let timings = match timing::take() {
            Some(runs) => {
                let pre = runs.first_start - start;
                let post = total.saturating_sub(pre).saturating_sub(runs.session);
                Self { pre: ms(pre), session: ms(runs.session), post: ms(post), total: ms(total) }
            }
            None => Self { total: ms(total), ..Self::default() },
        };
        Ok((result?, timings))
    }
}

impl std::fmt::Display for Timings {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { pre, session, post, total } = self;
        write!(f, "pre {pre:.2} ms, session {session:.2} ms, post {post:.2} ms, total {total:.2} ms")
    }
}
