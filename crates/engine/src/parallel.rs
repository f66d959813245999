//! Parallel map with ordered results and bounded memory.

use std::any::Any;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Items in flight per worker: one in work, one queued.
const AHEAD: usize = 2;

/// Maps `items` with `work`, with a thread per worker of `workers`, and passes the results in the order of the items to
/// `each` on the calling thread. A single worker runs on the calling thread itself.
///
/// At most two items per worker are taken from `items` and not yet passed to `each`. Memory is therefore bounded for
/// long sequences and a slow `each`.
///
/// # Errors
/// Returns the first error of `each`; items in flight are finished and dropped.
///
/// # Panics
/// Propagates a panic of `work`.
///
/// ```
/// let mut squares = Vec::new();
/// opendr_engine::map_in_order(&mut [(), ()], 1..=4, |(), n| n * n, |square| {
///     squares.push(square);
///     Ok::<_, ()>(())
/// })
/// .unwrap();
/// assert_eq!(squares, [1, 4, 9, 16]);
/// ```
pub fn map_in_order<W: Send, T: Send, R: Send, E>(
    workers: &mut [W],
    items: impl IntoIterator<Item = T>,
    work: impl Fn(&mut W, T) -> R + Sync,
    mut each: impl FnMut(R) -> Result<(), E>,
) -> Result<(), E> {
    let mut items = items.into_iter();
    if let [worker] = workers {
        return items.try_for_each(|item| each(work(worker, item)));
    }
    let ahead = AHEAD * workers.len();
    let (jobs, queue) = sync_channel::<(u64, T)>(ahead);
    let (queue, work) = (&Mutex::new(queue), &work);
    thread::scope(move |scope| {
        let (results, done) = sync_channel::<(u64, Outcome<R>)>(ahead);
        for worker in workers {
            let results = results.clone();
            scope.spawn(move || {
                while let Some((index, item)) = next_of(queue) {
                    let outcome = catch_unwind(AssertUnwindSafe(|| work(worker, item)));
                    if results.send((index, outcome)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(results);
        let (mut sent, mut handed) = (0, 0);
        let mut early = BTreeMap::new();
        loop {
            while sent - handed < ahead as u64 {
                let Some(item) = items.next() else { break };
                // The workers live as long as `jobs`, and the queue has room for all items in flight.
                jobs.send((sent, item)).ok();
                sent += 1;
            }
            if sent == handed {
                return Ok(());
            }
            let Ok((index, outcome)) = done.recv() else { return Ok(()) };
            early.insert(index, outcome.unwrap_or_else(|panic| resume_unwind(panic)));
            while let Some(result) = early.remove(&handed) {
                handed += 1;
                each(result)?;
            }
        }
    })
}

/// A result, or the payload of a panic of `work`.
type Outcome<R> = Result<R, Box<dyn Any + Send>>;

/// Returns the next job; the lock is held while waiting for it, never while working.
fn next_of<T>(queue: &Mutex<Receiver<T>>) -> Option<T> {
    queue.lock().unwrap_or_else(PoisonError::into_inner).recv().ok()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::Duration;

    use super::*;

    #[test]
    fn results_keep_the_order_and_items_are_taken_late() {
        let taken = AtomicUsize::new(0);
        let items = (0..200_usize).inspect(|_| {
            taken.fetch_add(1, Ordering::Relaxed);
        });
        let mut next = 0;
        let work = |_: &mut (), n: usize| {
            // Later items are ready first.
            thread::sleep(Duration::from_micros(if n.is_multiple_of(3) { 300 } else { 0 }));
            n
        };
        map_in_order(&mut [(); 3], items, work, |n| {
            assert_eq!(n, next);
            next += 1;
            assert!(taken.load(Ordering::Relaxed) <= next + AHEAD * 3);
            Ok::<_, ()>(())
        })
        .unwrap();
        assert_eq!(next, 200);
    }

    #[test]
    fn workers_keep_their_state() {
        let mut counts = [0; 4];
        let work = |count: &mut i32, _: i32| *count += 1;
        map_in_order(&mut counts, 0..100, work, |()| Ok::<_, ()>(())).unwrap();
        assert_eq!(counts.iter().sum::<i32>(), 100);
    }

    #[test]
    fn error_of_the_consumer_ends_an_endless_sequence() {
        for workers in [1, 2] {
            let mut workers = vec![(); workers];
            let each = |n| if n == 5 { Err("enough") } else { Ok(()) };
            assert_eq!(map_in_order(&mut workers, 0.., |(), n: i32| n, each), Err("enough"));
        }
    }

    #[test]
    #[should_panic(expected = "seven")]
    fn panic_of_a_worker_is_propagated() {
        let work = |(): &mut (), n: i32| assert!(n != 7, "seven");
        map_in_order(&mut [(); 2], 0..100, work, |()| Ok::<_, ()>(())).unwrap();
    }
}
