use std::any::Any;
use std::cell::Cell;
use std::fmt;
use std::hint::spin_loop;
use std::marker::PhantomData;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};

#[cfg(test)]
mod tests;

/// A pool of threads that process work in pieces.
///
/// The caller divides the work, never the pool: with pieces that depend on the size only, each writing its own part,
/// and the parts combined in order, the result is bit-identical on any number of threads.
///
/// An idle thread spins for some microseconds, then sleeps. Work that starts from within a piece, or while another
/// thread uses the pool, runs on the calling thread. Dropping the pool ends its threads.
pub struct WorkerPool {
    shared: Arc<Shared>,
    workers: Vec<JoinHandle<()>>,
    turn: Mutex<()>,
}

struct Shared {
    state: Mutex<State>,
    /// Signals new work, or the end.
    wake: Condvar,
    /// Signals that the last worker has finished.
    left: Condvar,
    /// Number of works so far; spinning threads watch it without the lock.
    works: AtomicU64,
    inside: AtomicUsize,
}

struct State {
    work: Option<Work>,
    works: u64,
    stop: bool,
    /// Number of workers that wait for the signal.
    sleeping: usize,
}

/// The current work. The pointers are valid until the last worker has finished, which [`WorkerPool::run`] waits for.
#[derive(Clone, Copy)]
struct Work {
    piece: *const (dyn Fn(usize) + Sync),
    progress: *const Progress,
}

// SAFETY: both pointers are to values that are `Sync`.
unsafe impl Send for Work {}

struct Progress {
    next: AtomicUsize,
    pieces: usize,
    failed: AtomicBool,
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

/// Iterations that a thread spins before it sleeps: tens of microseconds.
const SPINS: u32 = 2000;

thread_local! {
    static WORKING: Cell<bool> = const { Cell::new(false) };
}

impl WorkerPool {
    /// Creates a pool in which `threads` threads work, the calling one included; at least one. If the system cannot
    /// create a thread, the pool has fewer.
    pub fn new(threads: usize) -> Self {
        let shared = Arc::new(Shared {
            state: Mutex::new(State { work: None, works: 0, stop: false, sleeping: 0 }),
            wake: Condvar::new(),
            left: Condvar::new(),
            works: AtomicU64::new(0),
            inside: AtomicUsize::new(0),
        });
        let spawn = |index| {
            let shared = Arc::clone(&shared);
            Builder::new().name(format!("opendr-kernels-{index}")).spawn(move || shared.serve()).ok()
        };
        let workers = (1..threads).map_while(spawn).collect();
        Self { shared, workers, turn: Mutex::new(()) }
    }

    /// Returns the number of threads that work, the calling one included.
    pub fn threads(&self) -> usize {
        self.workers.len() + 1
    }

    /// Calls `piece` once with each index below `pieces`, in any order, and returns when all are finished.
    ///
    /// # Panics
    /// When a piece panics, with the payload of the first panic. Pieces that have not started by then are skipped.
    pub fn run(&self, pieces: usize, piece: impl Fn(usize) + Sync) {
        if pieces <= 1 || self.workers.is_empty() || WORKING.get() {
            return (0..pieces).for_each(piece);
        }
        let Ok(turn) = self.turn.try_lock() else { return (0..pieces).for_each(piece) };
        let progress = Progress {
            next: AtomicUsize::new(0),
            pieces,
            failed: AtomicBool::new(false),
            panic: Mutex::new(None),
        };
        let erased: &(dyn Fn(usize) + Sync) = &piece;
        // SAFETY: only the lifetime changes; `close` below returns when no worker holds the pointer any more.
        let erased: &'static (dyn Fn(usize) + Sync) = unsafe { std::mem::transmute(erased) };
        self.shared.open(Work { piece: erased, progress: &progress });
        WORKING.set(true);
        progress.work_on(&piece);
        WORKING.set(false);
        self.shared.close();
        drop(turn);
        let panic = lock(&progress.panic).take();
        if let Some(panic) = panic {
            resume_unwind(panic);
        }
    }

    /// Calls both functions, in parallel where there are threads, and returns when both have finished.
    ///
    /// # Panics
    /// As [`WorkerPool::run`].
    pub fn join(&self, first: impl FnOnce() + Send, second: impl FnOnce() + Send) {
        let (first, second) = (Mutex::new(Some(first)), Mutex::new(Some(second)));
        self.run(2, |piece| match piece {
            0 => lock(&first).take().map_or((), |first| first()),
            _ => lock(&second).take().map_or((), |second| second()),
        });
    }

    /// Divides `data` into pieces of `length`, the last one shorter, and calls `piece` with the index and the content
    /// of each.
    ///
    /// # Panics
    /// Where `length` is 0, and as [`WorkerPool::run`].
    pub fn run_on_pieces<T: Send>(
        &self,
        data: &mut [T],
        length: usize,
        piece: impl Fn(usize, &mut [T]) + Sync,
    ) {
        assert!(length > 0, "the length of pieces must be at least 1");
        let pieces = data.len().div_ceil(length);
        let data = Pieces::new(data, length);
        // SAFETY: each index is used once.
        self.run(pieces, |index| piece(index, unsafe { data.get(index) }));
    }
}

/// A slice that several threads write in pieces.
pub(crate) struct Pieces<'a, T> {
    start: *mut T,
    total: usize,
    length: usize,
    slice: PhantomData<&'a mut [T]>,
}

// SAFETY: `get` is unsafe; its callers guarantee that threads use different pieces.
unsafe impl<T: Send> Sync for Pieces<'_, T> {}

impl<'a, T> Pieces<'a, T> {
    /// Divides into pieces of `length`, the last one shorter.
    pub(crate) fn new(slice: &'a mut [T], length: usize) -> Self {
        Self { start: slice.as_mut_ptr(), total: slice.len(), length, slice: PhantomData }
    }

    /// Returns piece `index`; empty beyond the end.
    ///
    /// # Safety
    /// No piece is taken twice at the same time.
    pub(crate) unsafe fn get(&self, index: usize) -> &'a mut [T] {
        // SAFETY: passed on.
        unsafe { self.span(index, 1) }
    }

    /// Returns `count` pieces from `first` on as one; fewer at the end.
    ///
    /// # Safety
    /// As [`Pieces::get`].
    pub(crate) unsafe fn span(&self, first: usize, count: usize) -> &'a mut [T] {
        let from = (first * self.length).min(self.total);
        let length = (count * self.length).min(self.total - from);
        // SAFETY: pieces lie within the slice and do not overlap.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(from), length) }
    }
}

impl Shared {
    fn open(&self, work: Work) {
        let mut state = lock(&self.state);
        state.work = Some(work);
        state.works += 1;
        self.works.store(state.works, Ordering::Release);
        let is_awaited = state.sleeping > 0;
        drop(state);
        if is_awaited {
            self.wake.notify_all();
        }
    }

    /// Prevents workers from starting, and waits for those at work.
    fn close(&self) {
        lock(&self.state).work = None;
        for _ in 0..SPINS {
            if self.inside.load(Ordering::Acquire) == 0 {
                return;
            }
            spin_loop();
        }
        let mut state = lock(&self.state);
        while self.inside.load(Ordering::Acquire) > 0 {
            state = self.left.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn serve(&self) {
        WORKING.set(true);
        let mut seen = 0;
        while let Some(work) = self.next(&mut seen) {
            // SAFETY: `inside` was incremented under the lock while the work was open, so `close` waits for this
            // worker.
            unsafe { (*work.progress).work_on(&*work.piece) };
            if self.inside.fetch_sub(1, Ordering::AcqRel) == 1 {
                drop(lock(&self.state));
                self.left.notify_all();
            }
        }
    }

    /// Returns the next open work; `None` at the end.
    fn next(&self, seen: &mut u64) -> Option<Work> {
        for _ in 0..SPINS {
            if self.works.load(Ordering::Acquire) != *seen {
                break;
            }
            spin_loop();
        }
        let mut state = lock(&self.state);
        loop {
            if state.stop {
                return None;
            }
            if state.works != *seen {
                *seen = state.works;
                if let Some(work) = state.work {
                    self.inside.fetch_add(1, Ordering::AcqRel);
                    return Some(work);
                }
            }
            state.sleeping += 1;
            state = self.wake.wait(state).unwrap_or_else(PoisonError::into_inner);
            state.sleeping -= 1;
        }
    }
}

impl Progress {
    fn work_on(&self, piece: &(dyn Fn(usize) + Sync)) {
        while !self.failed.load(Ordering::Relaxed) {
            let index = self.next.fetch_add(1, Ordering::Relaxed);
            if index >= self.pieces {
                break;
            }
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| piece(index))) {
                self.failed.store(true, Ordering::Relaxed);
                lock(&self.panic).get_or_insert(panic);
            }
        }
    }
}

/// Panics of pieces are caught before they reach a lock, so the guarded values are always consistent.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Drop for WorkerPool {
    fn drop(&mut self) {
        lock(&self.shared.state).stop = true;
        // Spinning threads watch this counter.
        self.shared.works.fetch_add(1, Ordering::Release);
        self.shared.wake.notify_all();
        for worker in self.workers.drain(..) {
            // A worker catches the panics of its work, so `join` reports nothing.
            let _ = worker.join();
        }
    }
}

impl fmt::Debug for WorkerPool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("WorkerPool").field("threads", &self.threads()).finish_non_exhaustive()
    }
}
