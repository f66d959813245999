//! What belongs together, in order of time.

use std::collections::VecDeque;

use opendr_bags::{Channel, Messages, Recorded, Selection};
use opendr_engine::{Result, ResultExt, Value, ValueType};
use opendr_messages::Message;

use crate::Recording;
use crate::channels::Known;
use crate::recording::decode;
use crate::stamp::{stamp_of, value_of};

/// How far stamps of what belongs together may lie apart, as in nodes.
const SLOP_NS: i64 = 20_000_000;
/// How much later than the first port's another port's message may have been recorded.
const PATIENCE_NS: i64 = 1_000_000_000;
/// Messages that wait for others take up to this many bytes.
const MOST_BYTES: usize = 256 << 20;
/// Messages of one port that wait.
const MOST_WAITING: usize = 1024;

/// Whether a set needs a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// A set without it is none.
    Required,
    /// Where there is one that fits.
    Optional,
    /// The newest that came since the last set, however old: what begins a stream. Before the first there is no set.
    Init,
}

/// A topic for a port.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PortTopic {
    /// The topic as the recording names it.
    pub topic: String,
    /// What its messages are read as.
    pub value_type: ValueType,
    /// Whether a set needs it; the first port is always needed.
    pub need: Need,
}

impl PortTopic {
    /// A topic that every set needs.
    pub fn new(topic: impl Into<String>, value_type: ValueType) -> Self {
        Self { topic: topic.into(), value_type, need: Need::Required }
    }
}

/// The values of one call, with what they were read from.
#[derive(Debug, Clone)]
pub struct Set {
    /// One for each port, in the order of the ports. A value without a stamp has the log time of its message as stamp.
    pub values: Vec<Option<Value>>,
    /// The messages themselves.
    pub messages: Vec<Option<Recorded>>,
    /// When the first port's message was recorded, nanoseconds.
    pub log_time_ns: i64,
    /// When its datum was taken, else when it was recorded; nanoseconds.
    pub stamp_ns: i64,
}

/// Sets of messages, each around one of the first port's, in order of their log times; others are those with the
/// nearest stamps within 20 ms, recorded up to a second later. What is held meanwhile is bounded.
///
/// A message that cannot be read is an error in its place, and reading goes on.
#[derive(Debug)]
pub struct Sets {
    ports: Vec<PortTopic>,
    channels: Vec<Channel>,
    known: Vec<Known>,
    messages: Option<Messages>,
    queues: Vec<VecDeque<Waiting>>,
    /// Whether each port had a message in a set.
    has_begun: Vec<bool>,
    /// Bytes in the queues.
    held: usize,
    now_ns: i64,
    unmatched: u64,
}

#[derive(Debug)]
struct Waiting {
    message: Message,
    recorded: Recorded,
    stamp_ns: i64,
}

impl Sets {
    /// The sets of `recording` with a topic for each port.
    ///
    /// # Errors
    /// As [`Bag::select`](opendr_bags::Bag::select).
    pub fn open(recording: &Recording, ports: Vec<PortTopic>) -> Result<Self> {
        let bag = recording.bag();
        let topics = ports.iter().map(|port| port.topic.clone());
        let messages = Some(bag.select(&Selection::topics(topics))?);
        let queues = ports.iter().map(|_| VecDeque::new()).collect();
        let has_begun = vec![false; ports.len()];
        let (channels, known) = (bag.channels().to_vec(), recording.known().to_vec());
        let (held, now_ns, unmatched) = (0, i64::MIN, 0);
        Ok(Self { ports, channels, known, messages, queues, has_begun, held, now_ns, unmatched })
    }

    /// Messages of the first port so far for which another port had none.
    pub fn unmatched(&self) -> u64 {
        self.unmatched
    }

    fn take_in(&mut self, recorded: &Recorded) -> Result<()> {
        self.now_ns = recorded.log_time_ns;
        let topic = self.channels.get(recorded.channel).map(|channel| channel.topic.as_str());
        for (port, queue) in self.ports.iter().zip(&mut self.queues) {
            if topic != Some(port.topic.as_str()) {
                continue;
            }
            let message = decode(&self.known, &self.channels, recorded)?;
            let stamp_ns = stamp_of(&message, recorded.log_time_ns);
            self.held += recorded.bytes.len();
            queue.push_back(Waiting { message, recorded: recorded.clone(), stamp_ns });
        }
        for queue in self.queues.iter_mut().skip(1).filter(|queue| queue.len() > MOST_WAITING) {
            self.held -= queue.pop_front().map_or(0, |old| old.recorded.bytes.len());
        }
        // Without a first to match, the oldest of the others are of no use.
        while self.held > MOST_BYTES && self.queues.first().is_none_or(VecDeque::is_empty) {
            let longest = self.queues.iter_mut().max_by_key(|queue| queue.len());
            let Some(old) = longest.and_then(VecDeque::pop_front) else { break };
            self.held -= old.recorded.bytes.len();
        }
        Ok(())
    }

    /// Whether nothing that is still to come can change the set around the first that waits.
    fn is_decided(&self) -> bool {
        let Some((lead, others)) = self.queues.split_first() else { return true };
        let Some(first) = lead.front() else { return false };
        let waited = self.now_ns.saturating_sub(first.recorded.log_time_ns) > PATIENCE_NS;
        let is_full = self.held > MOST_BYTES || lead.len() > MOST_WAITING;
        let came =
            |queue: &VecDeque<Waiting>| queue.back().is_some_and(|last| last.stamp_ns >= first.stamp_ns);
        self.messages.is_none() || waited || is_full || others.iter().all(came)
    }

    /// The set around the first that waits; `None` when a port that it needs has nothing.
    fn take(&mut self) -> Option<Result<Set>> {
        let lead = self.queues.first_mut()?.pop_front()?;
        self.held -= lead.recorded.bytes.len();
        let (stamp_ns, log_time_ns) = (lead.stamp_ns, lead.recorded.log_time_ns);
        let mut waiting = vec![Some(lead)];
        for (port, queue) in self.ports.iter().zip(&mut self.queues).skip(1) {
            let apart = |other: &Waiting| other.stamp_ns.saturating_sub(stamp_ns).saturating_abs();
            let at = match port.need {
                Need::Init => {
                    let limit = stamp_ns.saturating_add(SLOP_NS);
                    queue.iter().rposition(|other| other.stamp_ns <= limit)
                }
                Need::Required | Need::Optional => {
                    let nearest = queue.iter().enumerate().min_by_key(|(_, other)| apart(other));
                    nearest.filter(|(_, other)| apart(other) <= SLOP_NS).map(|(at, _)| at)
                }
            };
            let Some(at) = at else {
                waiting.push(None);
                continue;
            };
            // What is older than what is taken is of no use any more.
            let taken = queue.drain(..=at).inspect(|old| self.held -= old.recorded.bytes.len());
            waiting.push(taken.last());
        }
        let mut is_missing = false;
        for ((port, other), has_begun) in self.ports.iter().zip(&waiting).zip(&mut self.has_begun) {
            *has_begun |= other.is_some();
            is_missing |= match port.need {
                Need::Required => other.is_none(),
                Need::Optional => false,
                Need::Init => !*has_begun,
            };
        }
        if is_missing {
            self.unmatched += 1;
            return None;
        }
        let mut set = Set { values: Vec::new(), messages: Vec::new(), log_time_ns, stamp_ns };
        for (port, waiting) in self.ports.iter().zip(waiting) {
            let Some(Waiting { message, recorded, stamp_ns }) = waiting else {
                set.values.push(None);
                set.messages.push(None);
                continue;
            };
            match value_of(port.value_type, message, stamp_ns).context(|| port.topic.clone()) {
                Ok(value) => set.values.push(Some(value)),
                Err(error) => return Some(Err(error)),
            }
            set.messages.push(Some(recorded));
        }
        Some(Ok(set))
    }
}

impl Iterator for Sets {
    type Item = Result<Set>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let waits = self.queues.first().is_some_and(|lead| !lead.is_empty());
            if waits && self.is_decided() {
                match self.take() {
                    Some(set) => return Some(set),
                    None => continue,
                }
            }
            match self.messages.as_mut()?.next() {
                Some(Ok(recorded)) => {
                    if let Err(error) = self.take_in(&recorded) {
                        return Some(Err(error));
                    }
                }
                // The last that comes; what waits is still answered.
                Some(Err(error)) => {
                    self.messages = None;
                    return Some(Err(error));
                }
                None if waits => self.messages = None,
                None => return None,
            }
        }
    }
}

#[cfg(test)]
mod tests;
