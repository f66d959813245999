//! A pipeline of stages, each on its own thread, that keeps the order of the items.

use std::panic::resume_unwind;
use std::sync::mpsc::sync_channel;
use std::thread;

/// Items in flight per stage: one in work, one queued.
const AHEAD: usize = 2;

/// Passes each item through all `stages` in turn with `work`, and then to `each` on the calling thread.
///
/// Every stage has a thread and receives the items in order. It works on one item while the stage before works on the
/// next, so the slowest stage sets the pace. A single stage runs on the calling thread.
///
/// At most two items per stage are taken from `items` and not yet passed to `each`. Memory is therefore bounded for
/// long sequences and a slow `each`.
///
/// # Errors
/// Returns the first error of `each`; items in flight are dropped.
///
/// # Panics
/// Propagates a panic of `work`.
///
/// ```
/// let mut lines = Vec::new();
/// let items = (1..=3).map(|n| n.to_string());
/// opendr_engine::map_in_stages(&mut ["a", "b"], items, |stage, item| item.push_str(stage), |item| {
///     lines.push(item);
///     Ok::<_, ()>(())
/// })
/// .unwrap();
/// assert_eq!(lines, ["1ab", "2ab", "3ab"]);
/// ```
pub fn map_in_stages<S: Send, T: Send, E>(
    stages: &mut [S],
    items: impl IntoIterator<Item = T>,
    work: impl Fn(&mut S, &mut T) + Sync,
    mut each: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let mut items = items.into_iter();
    if let [] | [_] = stages {
        return items.try_for_each(|mut item| {
            stages.iter_mut().for_each(|stage| work(stage, &mut item));
            each(item)
        });
    }
    let (ahead, work) = (AHEAD * stages.len(), &work);
    thread::scope(|scope| {
        let (first, mut last) = sync_channel(ahead);
        let mut threads = Vec::with_capacity(stages.len());
        for stage in stages {
            // The channel has room for all items in flight, so that no stage waits for the next one.
            let (to, next) = sync_channel(ahead);
            let from = std::mem::replace(&mut last, next);
            threads.push(scope.spawn(move || {
                for mut item in from {
                    work(stage, &mut item);
                    if to.send(item).is_err() {
                        return;
                    }
                }
            }));
        }
        let mut in_flight = 0;
        let done = loop {
            while in_flight < ahead {
                let Some(item) = items.next() else { break };
                if first.send(item).is_err() {
                    break;
                }
                in_flight += 1;
            }
            if in_flight == 0 {
                break Ok(());
            }
            // The channel closes when a stage panics.
            let Ok(item) = last.recv() else { break Ok(()) };
            in_flight -= 1;
            if let Err(error) = each(item) {
                break Err(error);
            }
        };
        drop((first, last));
        for thread in threads {
            if let Err(panic) = thread.join() {
                resume_unwind(panic);
            }
        }
        done
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Barrier;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn stages_receive_items_in_order_and_keep_their_state() {
        let mut stages = [(0, 1), (0, 10), (0, 100)];
        let mut next = 0;
        let work = |(count, weight): &mut (usize, usize), (n, sum): &mut (usize, usize)| {
            assert_eq!(count, n);
            *count += 1;
            *sum += *weight;
        };
        map_in_stages(&mut stages, (0..50).map(|n| (n, 0)), work, |(n, sum)| {
            assert_eq!((n, sum), (next, 111));
            next += 1;
            Ok::<_, ()>(())
        })
        .unwrap();
        assert_eq!(next, 50);
    }

    #[test]
    fn stages_work_at_the_same_time() {
        // Two items meet in two stages, or this never ends.
        let meeting = Barrier::new(2);
        let mut stages = [0, 1];
        let work = |stage: &mut usize, n: &mut usize| {
            if *stage + *n == 1 {
                meeting.wait();
            }
        };
        map_in_stages(&mut stages, 0..2, work, |_| Ok::<_, ()>(())).unwrap();
    }

    #[test]
    fn items_are_taken_late_and_an_error_ends_an_endless_sequence() {
        for count in 1..4 {
            let taken = AtomicUsize::new(0);
            let items = (0..).inspect(|_| {
                taken.fetch_add(1, Ordering::Relaxed);
            });
            let each = |n| {
                assert!(taken.load(Ordering::Relaxed) <= n + AHEAD * count);
                if n == 5 { Err("enough") } else { Ok(()) }
            };
            assert_eq!(map_in_stages(&mut vec![(); count], items, |(), _| (), each), Err("enough"));
        }
    }

    #[test]
    #[should_panic(expected = "seven")]
    fn panic_of_a_stage_is_propagated() {
        let work = |(): &mut (), n: &mut i32| assert!(*n != 7, "seven");
        map_in_stages(&mut [(); 2], 0.., work, |_| Ok::<_, ()>(())).ok();
    }
}
