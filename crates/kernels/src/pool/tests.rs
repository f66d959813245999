use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;

#[test]
fn every_piece_runs_once() {
    for threads in [1, 2, 5] {
        let pool = WorkerPool::new(threads);
        for pieces in [0, 1, 2, 7, 1000] {
            let counts: Vec<AtomicUsize> = (0..pieces).map(|_| AtomicUsize::new(0)).collect();
            pool.run(pieces, |index| {
                counts[index].fetch_add(1, Ordering::Relaxed);
            });
            assert!(counts.iter().all(|count| count.load(Ordering::Relaxed) == 1), "{threads} {pieces}");
        }
    }
}

#[test]
fn pieces_of_a_slice_cover_it() {
    let pool = WorkerPool::new(3);
    let mut data = vec![0; 1003];
    pool.run_on_pieces(&mut data, 10, |index, part| {
        for (offset, value) in part.iter_mut().enumerate() {
            *value += index * 10 + offset;
        }
    });
    assert!(data.iter().enumerate().all(|(index, &value)| index == value));
}

#[test]
fn a_panic_reaches_the_caller_and_the_pool_lives_on() {
    let pool = WorkerPool::new(3);
    for _ in 0..20 {
        let result = catch_unwind(AssertUnwindSafe(|| {
            pool.run(50, |index| assert!(index != 13, "piece thirteen"));
        }));
        let payload = result.unwrap_err();
        let text = payload.downcast_ref::<&str>().map(ToString::to_string);
        assert!(text.or(payload.downcast_ref::<String>().cloned()).unwrap().contains("thirteen"));
        let sum = AtomicUsize::new(0);
        pool.run(10, |index| {
            sum.fetch_add(index, Ordering::Relaxed);
        });
        assert_eq!(sum.into_inner(), 45);
    }
}

#[test]
fn nested_and_concurrent_work_finishes() {
    let pool = WorkerPool::new(2);
    let sum = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for _ in 0..100 {
                    pool.run(4, |_| {
                        pool.run(3, |_| {
                            sum.fetch_add(1, Ordering::Relaxed);
                        });
                    });
                }
            });
        }
    });
    assert_eq!(sum.into_inner(), 4 * 100 * 12);
}

#[test]
fn sleeping_workers_wake_up() {
    let pool = WorkerPool::new(2);
    for _ in 0..5 {
        std::thread::sleep(std::time::Duration::from_millis(5));
        let sum = AtomicUsize::new(0);
        pool.run(64, |index| {
            sum.fetch_add(index, Ordering::Relaxed);
        });
        assert_eq!(sum.into_inner(), 64 * 63 / 2);
    }
}

#[test]
fn dropping_joins() {
    let pool = WorkerPool::new(4);
    let shared = Arc::downgrade(&pool.shared);
    drop(pool);
    assert!(shared.upgrade().is_none(), "a thread still uses the pool");
}

#[test]
fn join_runs_both_functions() {
    for threads in 1..3 {
        let (mut a, mut b) = (0, 0);
        WorkerPool::new(threads).join(|| a = 1, || b = 2);
        assert_eq!((a, b), (1, 2));
    }
}
