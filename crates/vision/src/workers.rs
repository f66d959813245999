//! A pool of threads that share the rows of an image.
//!
//! The threads live as long as the process, sleep between images (no spinning, which would take cores from the
//! inference runtime) and claim parts one by one, as the calling thread does. A worker that wakes late therefore
//! delays nothing.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread;

/// More threads do not help: resizing is bound by memory bandwidth.
const MAX_THREADS: usize = 8;

/// Calls `work(part)` once for each `part` in `0..parts`, on at most `threads` threads, the calling one included.
pub(crate) fn run(parts: usize, threads: usize, work: &(dyn Fn(usize) + Sync)) {
    let task =
        Task { work, parts, next: AtomicUsize::new(0), active: AtomicUsize::new(0), panic: Mutex::new(None) };
    let helpers = threads.min(parts).min(available()).saturating_sub(1);
    if helpers == 0 {
        return task.drain();
    }
    match TaskSlot::global().post(&task, helpers) {
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

/// Returns the number of threads that can work, the calling one included.
pub(crate) fn available() -> usize {
    static AVAILABLE: OnceLock<usize> = OnceLock::new();
    *AVAILABLE.get_or_init(|| thread::available_parallelism().map_or(1, |count| count.get().min(MAX_THREADS)))
}

struct Task<'a> {
    work: &'a (dyn Fn(usize) + Sync),
    parts: usize,
    /// Next part that no thread has claimed.
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

/// Slot for one task that the workers watch; a second caller works alone.
struct TaskSlot {
    slot: Mutex<Slot>,
    posted: Condvar,
}

#[derive(Default)]
struct Slot {
    task: Option<&'static Task<'static>>,
    /// Number of workers that may still join the task.
    seats: usize,
}

impl TaskSlot {
    fn global() -> &'static Self {
        static TASK_SLOT: TaskSlot =
            TaskSlot { slot: Mutex::new(Slot { task: None, seats: 0 }), posted: Condvar::new() };
        static STARTED: OnceLock<()> = OnceLock::new();
        STARTED.get_or_init(|| {
            for _ in 1..available() {
                // Without the thread the caller does all the work itself.
                let _ = thread::Builder::new().name("opendr-vision".to_owned()).spawn(|| TASK_SLOT.serve());
            }
        });
        &TASK_SLOT
    }

    fn post<'a>(&'static self, task: &'a Task<'a>, helpers: usize) -> Option<Posted<'a>> {
        let mut slot = lock(&self.slot);
        if slot.task.is_some() {
            return None;
        }
        // SAFETY: only the lifetime changes. `Posted` borrows the task for its true lifetime; its drop, which runs on
        // unwinding too, removes the task from the slot and waits until no worker uses it. `Posted` never leaves
        // `run`, so it is not leaked.
        slot.task = Some(unsafe { std::mem::transmute::<&'a Task<'a>, &'static Task<'static>>(task) });
        slot.seats = helpers;
        drop(slot);
        for _ in 0..helpers {
            self.posted.notify_one();
        }
        Some(Posted { task_slot: self, task })
    }

    fn serve(&self) {
        let mut slot = lock(&self.slot);
        loop {
            let Some(task) = slot.task.filter(|task| slot.seats > 0 && task.has_parts()) else {
                slot = self.posted.wait(slot).unwrap_or_else(PoisonError::into_inner);
                continue;
            };
            slot.seats -= 1;
            // Incremented under the lock, so that the thread that removes the task counts this worker.
            task.active.fetch_add(1, Ordering::Relaxed);
            drop(slot);
            if let Err(payload) = catch_unwind(AssertUnwindSafe(|| task.drain())) {
                *lock(&task.panic) = Some(payload);
            }
            // The task may be freed right after this.
            task.active.fetch_sub(1, Ordering::Release);
            slot = lock(&self.slot);
        }
    }
}

/// A posted task; dropping it ends the task.
struct Posted<'a> {
    task_slot: &'static TaskSlot,
    task: &'a Task<'a>,
}

impl Drop for Posted<'_> {
    fn drop(&mut self) {
        lock(&self.task_slot.slot).task = None;
        let mut waited = 0u32;
        while self.task.active.load(Ordering::Acquire) != 0 {
            // A worker finishes its part within microseconds, unless the system preempts it.
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
