//! Thread pools of the built-in runtime, shared by sessions with the same number of threads.

use std::sync::{Arc, Mutex, PoisonError, Weak};

use rten::ThreadPool;

static POOLS: Mutex<Vec<(usize, Weak<ThreadPool>)>> = Mutex::new(Vec::new());

/// Returns a pool of `count` threads; it ends with the last session that uses it.
pub(super) fn pool(count: usize) -> Arc<ThreadPool> {
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    pools.retain(|(_, pool)| pool.strong_count() > 0);
    let found = pools.iter().find(|(threads, _)| *threads == count).and_then(|(_, pool)| pool.upgrade());
    found.unwrap_or_else(|| {
        let pool = Arc::new(ThreadPool::with_num_threads(count));
        pools.push((count, Arc::downgrade(&pool)));
        pool
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_number_is_the_same_pool_while_it_is_in_use() {
        let three = pool(3);
        assert!(Arc::ptr_eq(&three, &pool(3)));
        assert!(!Arc::ptr_eq(&three, &pool(4)));
        let weak = Arc::downgrade(&three);
        drop(three);
        assert!(weak.upgrade().is_none());
        assert_eq!(pool(3).run(|| 1 + 1), 2);
    }
}
