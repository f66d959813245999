//! Buffers that are reused from frame to frame.

use std::ops::{Deref, DerefMut};
use std::sync::{Mutex, PoisonError};

/// A stack of buffers that the threads of one learner share. Each call takes one and returns it, so that nothing is
/// allocated after the first frames.
#[derive(Debug, Default)]
pub struct Pool<T> {
    free: Mutex<Vec<T>>,
}

impl<T: Default> Pool<T> {
    /// Takes a free buffer, or creates a new one.
    pub fn take(&self) -> Pooled<'_, T> {
        let free = self.free.lock().unwrap_or_else(PoisonError::into_inner).pop();
        Pooled { pool: self, value: free.unwrap_or_default() }
    }
}

/// A borrowed buffer; dropping it returns it to the pool.
#[derive(Debug)]
pub struct Pooled<'a, T: Default> {
    pool: &'a Pool<T>,
    value: T,
}

impl<T: Default> Deref for Pooled<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T: Default> DerefMut for Pooled<'_, T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.value
    }
}

impl<T: Default> Drop for Pooled<'_, T> {
    fn drop(&mut self) {
        let value = std::mem::take(&mut self.value);
        self.pool.free.lock().unwrap_or_else(PoisonError::into_inner).push(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buffers_are_reused() {
        let pool = Pool::<Vec<u8>>::default();
        pool.take().reserve(100);
        assert!(pool.take().capacity() >= 100);
        let (first, second) = (pool.take(), pool.take());
        assert!(first.capacity() >= 100 && second.capacity() == 0);
    }
}
