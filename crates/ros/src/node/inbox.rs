//! Bounded queue of messages for a learner; of images only the newest is kept.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

use opendr_engine::ValueType;
use opendr_engine::learner::Entry;

use super::frame::Frame;

/// Number of messages kept per port while others of the set are missing.
const DEPTH: usize = 32;
/// Number of chunks of a stream kept for a temporarily slow learner.
const STREAM_DEPTH: usize = 512;

/// Returns whether every message of a type is processed, as of audio and signals; of images and point clouds only the newest is.
pub(super) const fn is_streamed(value_type: ValueType) -> bool {
    matches!(value_type, ValueType::Audio | ValueType::Timeseries)
}

/// One frame per port; `None` for a port without one.
pub(crate) type Set = Vec<Option<Arc<Frame>>>;

/// Consumption of messages by a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// The newest message that matches the others.
    Newest,
    /// Every message in order.
    Stream,
    /// A matching message, if there is one.
    Optional,
    /// One message per stream.
    Init,
}

pub(crate) struct Inbox {
    kinds: Vec<Kind>,
    state: Mutex<State>,
    arrived: Condvar,
}

struct State {
    queues: Vec<VecDeque<Arc<Frame>>>,
    counts: Counts,
}

/// Numbers of received messages and of those skipped for newer ones.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) received: u64,
    pub(crate) dropped: u64,
}

impl Inbox {
    pub(crate) fn new(entry: &Entry) -> Self {
        let kind = |port: &opendr_engine::learner::Port| match (
            port.init,
            port.optional,
            is_streamed(port.value_type),
        ) {
            (true, ..) => Kind::Init,
            (_, true, _) => Kind::Optional,
            (.., true) => Kind::Stream,
            _ => Kind::Newest,
        };
        Self::of(entry.ports.iter().map(kind).collect())
    }

    fn of(kinds: Vec<Kind>) -> Self {
        let queues = kinds.iter().map(|_| VecDeque::new()).collect();
        let state = State { queues, counts: Counts::default() };
        Self { kinds, state: Mutex::new(state), arrived: Condvar::new() }
    }

    /// Adds a message for a port.
    pub(crate) fn put(&self, port: usize, frame: Arc<Frame>) {
        let Some(kind) = self.kinds.get(port) else { return };
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let depth = match kind {
            Kind::Stream => STREAM_DEPTH,
            Kind::Init => 1,
            Kind::Newest | Kind::Optional => DEPTH,
        };
        state.counts.received += 1;
        let State { queues, counts } = &mut *state;
        if let Some(queue) = queues.get_mut(port) {
            if queue.len() == depth {
                queue.pop_front();
                counts.dropped += 1;
            }
            queue.push_back(frame);
        }
        drop(state);
        self.arrived.notify_all();
    }

    /// Returns the next set whose stamps differ by at most `slop_ns`; `None` after `timeout`.
    pub(crate) fn take(&self, slop_ns: i64, timeout: Duration) -> Option<Set> {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let mut set = None;
        let missing = |state: &mut State| {
            set = self.next(state, slop_ns);
            set.is_none()
        };
        drop(
            self.arrived.wait_timeout_while(state, timeout, missing).unwrap_or_else(PoisonError::into_inner),
        );
        set
    }

    pub(crate) fn counts(&self) -> Counts {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).counts
    }

    fn next(&self, state: &mut State, slop_ns: i64) -> Option<Set> {
        let lead = self.kinds.iter().position(|kind| matches!(kind, Kind::Newest | Kind::Stream))?;
        let count = state.queues.get(lead)?.len();
        let streamed = self.kinds.get(lead) == Some(&Kind::Stream);
        let order: Vec<usize> =
            if streamed { (0..count.min(1)).collect() } else { (0..count).rev().collect() };
        let found = order.into_iter().find_map(|at| self.set_around(state, lead, at, slop_ns))?;
        let mut set = Set::new();
        for (port, at) in found.into_iter().enumerate() {
            let queue = state.queues.get_mut(port)?;
            let Some(at) = at else {
                set.push(None);
                continue;
            };
            // Messages older than the taken ones are dropped.
            let older = queue.drain(..at).count();
            if !matches!(self.kinds.get(port), Some(Kind::Optional)) {
                state.counts.dropped += older as u64;
            }
            set.push(queue.pop_front());
        }
        Some(set)
    }

    /// Returns the queue positions of a set around one message of the leading port.
    fn set_around(&self, state: &State, lead: usize, at: usize, slop_ns: i64) -> Option<Vec<Option<usize>>> {
        let stamp = state.queues.get(lead)?.get(at)?.stamp_ns;
        let apart = |frame: &Arc<Frame>| frame.stamp_ns.saturating_sub(stamp).saturating_abs();
        let place = |(port, kind): (usize, &Kind)| -> Option<Option<usize>> {
            let queue = state.queues.get(port)?;
            if port == lead {
                return Some(Some(at));
            }
            if *kind == Kind::Init {
                return Some((!queue.is_empty()).then_some(0));
            }
            let closest = (0..queue.len()).rev().min_by_key(|at| queue.get(*at).map(apart));
            let fits = closest.filter(|at| queue.get(*at).is_some_and(|frame| apart(frame) <= slop_ns));
            if *kind == Kind::Optional { Some(fits) } else { fits.map(Some) }
        };
        self.kinds.iter().enumerate().map(place).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLOP: i64 = 5;

    fn frame(stamp_ns: i64) -> Arc<Frame> {
        Arc::new(Frame::new(Err(opendr_engine::Error::format("")), ValueType::Image, stamp_ns))
    }

    fn stamps(inbox: &Inbox) -> Option<Vec<Option<i64>>> {
        let set = inbox.take(SLOP, Duration::ZERO)?;
        Some(set.iter().map(|frame| frame.as_ref().map(|frame| frame.stamp_ns)).collect())
    }

    #[test]
    fn newest_image_is_used() {
        let inbox = Inbox::of(vec![Kind::Newest]);
        assert_eq!(stamps(&inbox), None);
        (1..=100).for_each(|stamp| inbox.put(0, frame(stamp)));
        assert_eq!(stamps(&inbox), Some(vec![Some(100)]));
        assert_eq!(stamps(&inbox), None);
        assert_eq!(inbox.counts(), Counts { received: 100, dropped: 99 });
    }

    #[test]
    fn chunks_are_processed_in_order() {
        let inbox = Inbox::of(vec![Kind::Stream]);
        (1..=3).for_each(|stamp| inbox.put(0, frame(stamp)));
        assert_eq!([stamps(&inbox), stamps(&inbox)], [Some(vec![Some(1)]), Some(vec![Some(2)])]);
    }

    #[test]
    fn sets_are_matched_by_stamp() {
        let inbox = Inbox::of(vec![Kind::Newest, Kind::Newest, Kind::Optional]);
        for stamp in [100, 200, 300] {
            inbox.put(0, frame(stamp));
        }
        assert_eq!(stamps(&inbox), None);
        inbox.put(1, frame(103));
        inbox.put(1, frame(204));
        inbox.put(2, frame(199));
        assert_eq!(stamps(&inbox), Some(vec![Some(200), Some(204), Some(199)]));
        inbox.put(1, frame(310));
        assert_eq!(stamps(&inbox), None, "too far apart");
        inbox.put(1, frame(295));
        assert_eq!(stamps(&inbox), Some(vec![Some(300), Some(295), None]));
    }

    #[test]
    fn an_init_port_is_given_once() {
        let inbox = Inbox::of(vec![Kind::Newest, Kind::Init]);
        inbox.put(1, frame(0));
        inbox.put(0, frame(500));
        assert_eq!(stamps(&inbox), Some(vec![Some(500), Some(0)]));
        inbox.put(0, frame(600));
        assert_eq!(stamps(&inbox), Some(vec![Some(600), None]));
    }
}
