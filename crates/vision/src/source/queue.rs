//! A bounded queue between one producer and one consumer.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Behaviour of a full queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum WhenFull {
    /// The producer waits.
    Wait,
    /// The oldest entry is dropped.
    DropOldest,
}

/// A bounded queue that either side can close.
#[derive(Debug)]
pub(super) struct Queue<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
    capacity: usize,
    when_full: WhenFull,
}

#[derive(Debug)]
struct State<T> {
    entries: VecDeque<T>,
    closed: bool,
    dropped: u64,
}

impl<T> Queue<T> {
    /// Creates a queue of at most `capacity` entries (at least 1).
    pub(super) fn new(capacity: usize, when_full: WhenFull) -> Self {
        let state = State { entries: VecDeque::new(), closed: false, dropped: 0 };
        Self { state: Mutex::new(state), changed: Condvar::new(), capacity: capacity.max(1), when_full }
    }

    /// Adds an entry; returns `false` when the queue is closed and the producer can stop.
    pub(super) fn push(&self, entry: T) -> bool {
        let mut state = self.lock();
        while !state.closed && state.entries.len() >= self.capacity {
            match self.when_full {
                WhenFull::Wait => state = self.wait(state),
                WhenFull::DropOldest => {
                    state.entries.pop_front();
                    state.dropped += 1;
                }
            }
        }
        if state.closed {
            return false;
        }
        state.entries.push_back(entry);
        self.changed.notify_all();
        true
    }

    /// Waits for the next entry; `None` when the queue is closed and empty.
    pub(super) fn pop(&self) -> Option<T> {
        let mut state = self.lock();
        loop {
            if let Some(entry) = state.entries.pop_front() {
                self.changed.notify_all();
                return Some(entry);
            }
            if state.closed {
                return None;
            }
            state = self.wait(state);
        }
    }

    /// Closes the queue: further entries are rejected, queued ones remain available.
    pub(super) fn close(&self) {
        self.lock().closed = true;
        self.changed.notify_all();
    }

    /// Returns the number of dropped entries.
    pub(super) fn dropped(&self) -> u64 {
        self.lock().dropped
    }

    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, state: MutexGuard<'a, State<T>>) -> MutexGuard<'a, State<T>> {
        self.changed.wait(state).unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    #[test]
    fn newest_is_kept() {
        let queue = Queue::new(1, WhenFull::DropOldest);
        assert!((0..5).all(|entry| queue.push(entry)));
        queue.close();
        assert!(!queue.push(9));
        assert_eq!((queue.pop(), queue.pop(), queue.dropped()), (Some(4), None, 4));
    }

    #[test]
    fn waiting_loses_nothing() {
        let queue = Arc::new(Queue::new(2, WhenFull::Wait));
        let producer = Arc::clone(&queue);
        let thread = std::thread::spawn(move || {
            (0..100).for_each(|entry| assert!(producer.push(entry)));
            producer.close();
        });
        let got: Vec<i32> = std::iter::from_fn(|| queue.pop()).collect();
        thread.join().unwrap();
        assert_eq!(got, (0..100).collect::<Vec<_>>());
        assert_eq!(queue.dropped(), 0);
    }

    #[test]
    fn closing_frees_a_waiting_producer() {
        let queue = Arc::new(Queue::new(1, WhenFull::Wait));
        assert!(queue.push(0));
        let producer = Arc::clone(&queue);
        let thread = std::thread::spawn(move || producer.push(1));
        queue.close();
        assert!(!thread.join().unwrap());
    }
}
