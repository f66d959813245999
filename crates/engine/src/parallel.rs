//! Work on many items at once whose results come in the items' order.

use std::any::Any;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Items under way for each worker: one in work, one waiting for it.
const AHEAD: usize = 2;

/// Maps `items` with `work`, one thread for each of `workers`, and hands the results in the order of the items to
/// `each`, on the calling thread. A single worker works on the calling thread itself.
///
/// At most two items for each worker are taken from `items` and not yet handed to `each`, so memory is bounded however
/// long the sequence is and however slow `each`.
///
/// # Errors
/// The first error of `each` ends the work; items under way are finished and dropped.
///
/// # Panics
/// Goes on with a panic of `work`.
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
        let (answers, done) = sync_channel::<(u64, Answer<R>)>(ahead);
        for worker in workers {
            let answers = answers.clone();
            scope.spawn(move || {
                while let Some((index, item)) = next_of(queue) {
                    let answer = catch_unwind(AssertUnwindSafe(|| work(worker, item)));
                    if answers.send((index, answer)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(answers);
        let (mut sent, mut handed) = (0, 0);
        let mut early = BTreeMap::new();
        loop {
            while sent - handed < ahead as u64 {
                let Some(item) = items.next() else { break };
                // The workers live as long as `jobs`, and the queue has room for all that are ahead.
                jobs.send((sent, item)).ok();
                sent += 1;
            }
            if sent == handed {
                return Ok(());
            }
            let Ok((index, answer)) = done.recv() else { return Ok(()) };
            early.insert(index, answer.unwrap_or_else(|panic| resume_unwind(panic)));
            while let Some(result) = early.remove(&handed) {
                handed += 1;
                each(result)?;
            }
        }
    })
}

/// A result, or what `work` panicked with.
type Answer<R> = Result<R, Box<dyn Any + Send>>;

/// The next job; the lock is held while waiting for it, never while working.
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
    fn workers_keep_what_is_theirs() {
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
    fn panic_of_a_worker_goes_on() {
        let work = |(): &mut (), n: i32| assert!(n != 7, "seven");
        map_in_order(&mut [(); 2], 0..100, work, |()| Ok::<_, ()>(())).unwrap();
    }
}
