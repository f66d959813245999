//! The item that pages display.

use std::sync::{Arc, Condvar, Mutex, OnceLock, PoisonError};
use std::time::Duration;

use crate::{Shown, body};

/// An item with its number and its bytes for the pages, made once for all of them.
#[derive(Debug)]
pub struct Numbered {
    number: u64,
    item: Shown,
    drawn: OnceLock<Arc<[u8]>>,
    plain: OnceLock<Arc<[u8]>>,
}

impl Numbered {
    /// Returns the bytes of the item, with or without predictions on the image.
    pub fn bytes(&self, is_drawn: bool) -> Arc<[u8]> {
        let cell = if is_drawn { &self.drawn } else { &self.plain };
        cell.get_or_init(|| body::encoded(self.number, &self.item, is_drawn).into()).clone()
    }
}

/// The newest item.
#[derive(Debug, Default)]
pub struct Feed {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    newest: Option<Arc<Numbered>>,
    count: u64,
    is_closed: bool,
}

impl Feed {
    /// Replaces the newest item.
    pub fn put(&self, item: Shown) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.count += 1;
        let number = state.count;
        state.newest =
            Some(Arc::new(Numbered { number, item, drawn: OnceLock::new(), plain: OnceLock::new() }));
        drop(state);
        self.changed.notify_all();
    }

    /// Waits up to `patience` for an item after number `after`.
    pub fn next_after(&self, after: u64, patience: Duration) -> Option<Arc<Numbered>> {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let is_old = |state: &mut State| {
            !state.is_closed && state.newest.as_ref().is_none_or(|newest| newest.number == after)
        };
        let (state, _) =
            self.changed.wait_timeout_while(state, patience, is_old).unwrap_or_else(PoisonError::into_inner);
        state.newest.clone().filter(|newest| newest.number != after)
    }

    /// Ends all waiting.
    pub fn close(&self) {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).is_closed = true;
        self.changed.notify_all();
    }

    /// Returns whether the viewer has ended.
    pub fn is_closed(&self) -> bool {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).is_closed
    }
}
