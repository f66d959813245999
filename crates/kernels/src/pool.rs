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

/// Threads that wait for work in pieces.
///
/// How work is cut is the caller's, never the pool's: cut it by its size, let each piece write its own part, and put
/// the parts together in their order, and the result is the same, bit for bit, on any number of threads.
///
/// A thread without work spins for some microseconds, then sleeps. Work that starts from within a piece, or while
/// another thread uses the pool, runs on the thread that asks. Dropping the pool ends its threads.
pub struct WorkerPool {
    shared: Arc<Shared>,
    workers: Vec<JoinHandle<()>>,
    turn: Mutex<()>,
}

struct Shared {
    state: Mutex<State>,
    /// Work came, or the end.
    wake: Condvar,
    /// The last worker has left the work.
    left: Condvar,
    /// Counts works; a copy of it outside of the lock is what spinning threads watch.
    works: AtomicU64,
    inside: AtomicUsize,
}

struct State {
    work: Option<Work>,
    works: u64,
    stop: bool,
}

/// What is to be done. The pointers are good until the last worker has left, which [`WorkerPool::run`] waits for.
#[derive(Clone, Copy)]
struct Work {
    piece: *const (dyn Fn(usize) + Sync),
    progress: *const Progress,
}

// SAFETY: both point at things that are `Sync`.
unsafe impl Send for Work {}

struct Progress {
    next: AtomicUsize,
    pieces: usize,
    failed: AtomicBool,
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

/// How often a thread looks before it sleeps: tens of microseconds.
const SPINS: u32 = 2000;

thread_local! {
    static WORKING: Cell<bool> = const { Cell::new(false) };
}

impl WorkerPool {
    /// A pool in which `threads` work, the caller among them; at least one. Threads that the system refuses are done
    /// without.
    pub fn new(threads: usize) -> Self {
        let shared = Arc::new(Shared {
            state: Mutex::new(State { work: None, works: 0, stop: false }),
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

    /// Threads that work, the caller among them.
    pub fn threads(&self) -> usize {
        self.workers.len() + 1
    }

    /// Calls `piece` once with each number below `pieces`, in any order, and returns when all are done.
    ///
    /// # Panics
    /// Where a piece panics: with what the first one to do so said. Pieces that have not begun by then are left out.
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
        // SAFETY: only the lifetime changes; `close` below returns when nobody holds the pointer any more.
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

    /// Calls both, side by side where there are threads, and returns when both are done.
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

    /// Cuts `data` into pieces of `length`, the last one shorter, and calls `piece` with the number and the content of each.
    ///
    /// # Panics
    /// Where `length` is 0, and as [`WorkerPool::run`].
    pub fn run_on_pieces<T: Send>(
        &self,
        data: &mut [T],
        length: usize,
        piece: impl Fn(usize, &mut [T]) + Sync,
    ) {
        assert!(length > 0, "pieces of no length");
        let pieces = data.len().div_ceil(length);
        let data = Pieces::new(data, length);
        // SAFETY: each number comes once.
        self.run(pieces, |index| piece(index, unsafe { data.get(index) }));
    }
}

/// A slice that threads write in pieces.
pub(crate) struct Pieces<'a, T> {
    start: *mut T,
    total: usize,
    length: usize,
    slice: PhantomData<&'a mut [T]>,
}

// SAFETY: `get` is unsafe, and whoever calls it sees to it that threads do not meet.
unsafe impl<T: Send> Sync for Pieces<'_, T> {}

impl<'a, T> Pieces<'a, T> {
    /// Pieces of `length`, the last one shorter.
    pub(crate) fn new(slice: &'a mut [T], length: usize) -> Self {
        Self { start: slice.as_mut_ptr(), total: slice.len(), length, slice: PhantomData }
    }

    /// Piece number `index`; empty beyond the end.
    ///
    /// # Safety
    /// No piece is taken twice at the same time.
    pub(crate) unsafe fn get(&self, index: usize) -> &'a mut [T] {
        let from = (index * self.length).min(self.total);
        // SAFETY: pieces lie within the slice and apart from each other.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(from), self.length.min(self.total - from)) }
    }
}

impl Shared {
    fn open(&self, work: Work) {
        let mut state = lock(&self.state);
        state.work = Some(work);
        state.works += 1;
        self.works.store(state.works, Ordering::Release);
        drop(state);
        self.wake.notify_all();
    }

    /// Lets nobody begin any more, and waits for those who are at it.
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
            // SAFETY: `inside` was counted up under the lock while the work was open, so `close` waits for us.
            unsafe { (*work.progress).work_on(&*work.piece) };
            if self.inside.fetch_sub(1, Ordering::AcqRel) == 1 {
                drop(lock(&self.state));
                self.left.notify_all();
            }
        }
    }

    /// The next work that is still open; `None` at the end.
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
            state = self.wake.wait(state).unwrap_or_else(PoisonError::into_inner);
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

/// A panic of a piece is caught before it reaches a lock, so what a lock guards is always whole.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Drop for WorkerPool {
    fn drop(&mut self) {
        lock(&self.shared.state).stop = true;
        // Spinning threads look at this number.
        self.shared.works.fetch_add(1, Ordering::Release);
        self.shared.wake.notify_all();
        for worker in self.workers.drain(..) {
            // A worker catches the panics of its work, so there is nothing to hear from it.
            let _ = worker.join();
        }
    }
}

impl fmt::Debug for WorkerPool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("WorkerPool").field("threads", &self.threads()).finish_non_exhaustive()
    }
}
