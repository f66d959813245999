use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use opendr_engine::Result;

/// Time budget of an image.
#[derive(Debug, Clone, Copy)]
pub struct TimeBudget {
    begun: Instant,
    limit: Option<Duration>,
}

impl TimeBudget {
    /// Starts a budget of so many milliseconds; without a limit for 0 and NaN.
    pub fn from_milliseconds(milliseconds: f32) -> Self {
        let limit = (milliseconds > 0.0).then(|| Duration::from_secs_f32(milliseconds.min(1e9) / 1000.0));
        Self { begun: Instant::now(), limit }
    }

    /// Returns whether the budget has `long` left.
    fn has(&self, long: Duration) -> bool {
        self.limit.is_none_or(|limit| self.begun.elapsed() + long <= limit)
    }
}

/// Runs `jobs` in their order, at most `workers` in parallel, while the budget has time for one more that takes as long as
/// the longest so far; the first is always run. `work` receives the index of its worker and the job. The results are in the
/// order of the jobs.
///
/// # Errors
/// The first error of `work`; jobs in progress are finished.
///
/// # Panics
/// When `work` panics.
pub fn run_within_budget<R: Send>(
    workers: usize,
    jobs: &[usize],
    allowance: TimeBudget,
    work: impl Fn(usize, usize) -> Result<R> + Sync,
) -> Result<Vec<(usize, R)>> {
    let (next, longest) = (AtomicUsize::new(0), AtomicU64::new(0));
    let done = Mutex::new(Vec::new());
    let run = |worker: usize| {
        loop {
            let at = next.load(Ordering::Relaxed);
            let Some(job) = jobs.get(at) else { return };
            if at > 0 && !allowance.has(Duration::from_nanos(longest.load(Ordering::Relaxed))) {
                return;
            }
            if next.compare_exchange(at, at + 1, Ordering::Relaxed, Ordering::Relaxed).is_err() {
                continue;
            }
            let begun = Instant::now();
            let result = work(worker, *job);
            longest.fetch_max(begun.elapsed().as_nanos() as u64, Ordering::Relaxed);
            if result.is_err() {
                next.store(jobs.len(), Ordering::Relaxed);
            }
            done.lock().unwrap_or_else(PoisonError::into_inner).push((at, *job, result));
        }
    };
    thread::scope(|scope| {
        for worker in 1..workers.min(jobs.len()) {
            let run = &run;
            scope.spawn(move || run(worker));
        }
        run(0);
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_unstable_by_key(|(at, ..)| *at);
    done.into_iter().map(|(_, job, result)| result.map(|result| (job, result))).collect()
}

#[cfg(test)]
mod tests {
    use opendr_engine::Error;

    use super::*;

    #[test]
    fn all_jobs_run_in_order_without_a_limit() {
        for workers in [0, 1, 3] {
            let jobs: Vec<usize> = (0..50).rev().collect();
            let done =
                run_within_budget(workers, &jobs, TimeBudget::from_milliseconds(0.0), |_, job| Ok(job * 2));
            let expected: Vec<_> = jobs.iter().map(|job| (*job, job * 2)).collect();
            assert_eq!(done.unwrap(), expected);
        }
    }

    #[test]
    fn one_job_runs_when_the_time_is_over() {
        let allowance = TimeBudget::from_milliseconds(1e-6);
        thread::sleep(Duration::from_millis(1));
        let done = run_within_budget(1, &[7, 8, 9], allowance, |_, job| Ok(job)).unwrap();
        assert_eq!(done, [(7, 7)]);
        assert!(run_within_budget(2, &[], allowance, |_, job| Ok(job)).unwrap().is_empty());
    }

    #[test]
    fn jobs_beyond_the_budget_are_not_started() {
        let begun = Instant::now();
        let (long, limit) = (Duration::from_millis(30), Duration::from_millis(75));
        let allowance = TimeBudget { begun, limit: Some(limit) };
        let done = run_within_budget(1, &[1, 2, 3, 4, 5], allowance, |_, job| {
            thread::sleep(long);
            Ok(job)
        });
        // Two fit; on a slow machine there may be fewer, never more.
        assert!((1..=2).contains(&done.unwrap().len()));
    }

    #[test]
    fn an_error_ends_the_run() {
        let work = |_: usize, job: usize| {
            if job == 3 { Err(Error::invalid_input("three")) } else { Ok(job) }
        };
        for workers in [1, 2] {
            let jobs: Vec<usize> = (0..1000).collect();
            let error =
                run_within_budget(workers, &jobs, TimeBudget::from_milliseconds(0.0), work).unwrap_err();
            assert!(error.to_string().contains("three"));
        }
    }
}
