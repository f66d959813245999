//! A few threads that wait for pictures.
//!
//! They live as long as the process, sleep between pictures (nothing spins, so that the inference runtime has the
//! cores to itself) and claim parts one by one, as does the thread that asks: a worker that wakes late costs
//! nothing but its help.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread;

/// More threads than this do not help: resizing is bound by memory.
const MAX_THREADS: usize = 8;

/// Calls `work(part)` once for each `part` in `0..parts`, on at most `threads` threads, this one among them.
pub(crate) fn run(parts: usize, threads: usize, work: &(dyn Fn(usize) + Sync)) {
    let task =
        Task { work, parts, next: AtomicUsize::new(0), active: AtomicUsize::new(0), panic: Mutex::new(None) };
    let helpers = threads.min(parts).min(available()).saturating_sub(1);
    if helpers == 0 {
        return task.drain();
    }
    match Desk::global().post(&task, helpers) {
        Some(posted) => {
            task.drain();
            drop(posted);
        }
        None => task.drain(),
    }
    if let Some(payload) = lock(&task.panic).take() {
        resume_unwind(payload);
    }
}

/// How many threads can help, this one included.
pub(crate) fn available() -> usize {
    static AVAILABLE: OnceLock<usize> = OnceLock::new();
    *AVAILABLE.get_or_init(|| thread::available_parallelism().map_or(1, |count| count.get().min(MAX_THREADS)))
}

struct Task<'a> {
    work: &'a (dyn Fn(usize) + Sync),
    parts: usize,
    /// The next part that nobody has claimed.
    next: AtomicUsize,
    /// Workers inside [`Task::drain`].
    active: AtomicUsize,
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

impl Task<'_> {
    fn drain(&self) {
        loop {
            let part = self.next.fetch_add(1, Ordering::Relaxed);
            if part >= self.parts {
                return;
            }
            (self.work)(part);
        }
    }

    fn has_parts(&self) -> bool {
        self.next.load(Ordering::Relaxed) < self.parts
    }
}

/// Where one task at a time lies for the workers to see; a second caller works alone.
struct Desk {
    slot: Mutex<Slot>,
    posted: Condvar,
}

#[derive(Default)]
struct Slot {
    task: Option<&'static Task<'static>>,
    /// How many workers may still join the task.
    seats: usize,
}

impl Desk {
    fn global() -> &'static Self {
        static DESK: Desk = Desk { slot: Mutex::new(Slot { task: None, seats: 0 }), posted: Condvar::new() };
        static STARTED: OnceLock<()> = OnceLock::new();
        STARTED.get_or_init(|| {
            for _ in 1..available() {
                // Without the thread the caller does all the work itself.
                let _ = thread::Builder::new().name("opendr-vision".to_owned()).spawn(|| DESK.serve());
            }
        });
        &DESK
    }

    fn post<'a>(&'static self, task: &'a Task<'a>, helpers: usize) -> Option<Posted<'a>> {
        let mut slot = lock(&self.slot);
        if slot.task.is_some() {
            return None;
        }
        // SAFETY: only the lifetime changes. `Posted` borrows the task for its true lifetime and its drop, which
        // runs on unwinding too, takes the task off the desk and waits until no worker is inside; `Posted` never
        // leaves `run`, so it is not leaked.
        slot.task = Some(unsafe { std::mem::transmute::<&'a Task<'a>, &'static Task<'static>>(task) });
        slot.seats = helpers;
        drop(slot);
        for _ in 0..helpers {
            self.posted.notify_one();
        }
        Some(Posted { desk: self, task })
    }

    fn serve(&self) {
        let mut slot = lock(&self.slot);
        loop {
            let Some(task) = slot.task.filter(|task| slot.seats > 0 && task.has_parts()) else {
                slot = self.posted.wait(slot).unwrap_or_else(PoisonError::into_inner);
                continue;
            };
            slot.seats -= 1;
            // Under the lock: whoever takes the task off the desk sees this worker.
            task.active.fetch_add(1, Ordering::Relaxed);
            drop(slot);
            if let Err(payload) = catch_unwind(AssertUnwindSafe(|| task.drain())) {
                *lock(&task.panic) = Some(payload);
            }
            // The task may be gone right after this.
            task.active.fetch_sub(1, Ordering::Release);
            slot = lock(&self.slot);
        }
    }
}

/// A task on the desk; dropping it ends the task.
struct Posted<'a> {
    desk: &'static Desk,
    task: &'a Task<'a>,
}

impl Drop for Posted<'_> {
    fn drop(&mut self) {
        lock(&self.desk.slot).task = None;
        let mut waited = 0u32;
        while self.task.active.load(Ordering::Acquire) != 0 {
            // A worker ends its part within microseconds, unless the system took its core away.
            waited += 1;
            if waited < 1000 { std::hint::spin_loop() } else { thread::yield_now() }
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_is_done_once() {
        let callers: Vec<_> = (0..4)
            .map(|_| {
                thread::spawn(|| {
                    for parts in [0, 1, 2, 7, 64] {
                        let counts: Vec<_> = (0..parts).map(|_| AtomicUsize::new(0)).collect();
                        run(parts, 8, &|part| {
                            counts[part].fetch_add(1, Ordering::Relaxed);
                        });
                        assert!(counts.iter().all(|count| count.load(Ordering::Relaxed) == 1));
                    }
                })
            })
            .collect();
        for caller in callers {
            caller.join().unwrap();
        }
    }

    #[test]
    fn a_panic_reaches_the_caller_and_the_workers_live_on() {
        for _ in 0..20 {
            let outcome = catch_unwind(|| run(16, 2, &|part| assert!(part != 7, "part 7")));
            assert!(outcome.is_err());
        }
        let done = AtomicUsize::new(0);
        run(16, 2, &|_| {
            done.fetch_add(1, Ordering::Relaxed);
        });
        assert_eq!(done.into_inner(), 16);
    }
}
