//! Measurement of the time spent inside all sessions of a thread.
//!
//! A benchmark calls [`start`], runs the learner on the same thread, and [`take`]s the record: the time before
//! [`RunTimes::first_start`] is pre-processing, the time after [`RunTimes::last_end`] post-processing. Nothing is
//! recorded otherwise, and recording does not allocate.

use std::cell::Cell;
use std::time::{Duration, Instant};

/// Session times between [`start`] and [`take`] on one thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RunTimes {
    /// Start of the first run.
    pub first_start: Instant,
    /// Time at which the outputs of the last run were ready.
    pub last_end: Instant,
    /// Total time of all runs, from the call to the outputs being ready.
    pub session: Duration,
    /// Number of runs.
    pub runs: u32,
}

#[derive(Clone, Copy)]
enum Record {
    Off,
    Empty,
    Runs(RunTimes),
}

thread_local! {
    static RECORD: Cell<Record> = const { Cell::new(Record::Off) };
}

/// Starts recording on this thread; an earlier record is dropped.
pub fn start() {
    RECORD.set(Record::Empty);
}

/// Stops recording on this thread and returns the record; `None` when no session ran since [`start`].
pub fn take() -> Option<RunTimes> {
    match RECORD.replace(Record::Off) {
        Record::Runs(times) => Some(times),
        Record::Off | Record::Empty => None,
    }
}

/// Adds a run from `start` until its outputs were ready at `end`.
pub(crate) fn add(start: Instant, end: Instant) {
    let session = end - start;
    RECORD.set(match RECORD.get() {
        Record::Off => return,
        Record::Empty => Record::Runs(RunTimes { first_start: start, last_end: end, session, runs: 1 }),
        Record::Runs(times) => Record::Runs(RunTimes {
            last_end: end,
            session: times.session + session,
            runs: times.runs + 1,
            ..times
        }),
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_lies_between_start_and_take_counts() {
        let begin = Instant::now();
        let at = |ms| begin + Duration::from_millis(ms);
        add(at(0), at(1));
        assert_eq!(take(), None);
        start();
        add(at(2), at(5));
        add(at(9), at(10));
        let times = take().unwrap();
        assert_eq!((times.first_start, times.last_end), (at(2), at(10)));
        assert_eq!((times.session, times.runs), (Duration::from_millis(4), 2));
        add(at(11), at(12));
        assert_eq!(take(), None);
    }
}
