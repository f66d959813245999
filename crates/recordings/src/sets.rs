//! Messages of several topics, synchronised by stamp.

use std::collections::VecDeque;

use opendr_bags::{Channel, Messages, RecordedMessage, Selection};
use opendr_engine::{Result, ResultExt, Value, ValueType};
use opendr_messages::Message;

use crate::Recording;
use crate::channels::Known;
use crate::recording::decode;
use crate::stamp::{stamp_of, value_of};

/// Largest difference of stamps within a set, in nanoseconds; the value of the ROS node.
const SLOP_NS: i64 = 20_000_000;
/// How much later than the first port's message another port's message may be recorded, in nanoseconds.
const MAX_DELAY_NS: i64 = 1_000_000_000;
/// Most bytes of queued messages.
const MAX_QUEUED_BYTES: usize = 256 << 20;
/// Most queued messages of one port.
const MAX_QUEUED: usize = 1024;

/// Whether a set needs a message of a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// The set is dropped without it.
    Required,
    /// It is used if a message with a close stamp exists.
    Optional,
    /// The newest message since the last set, of any age, which starts a stream. There is no set before the first
    /// one.
    Init,
}

/// The topic of a port.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PortTopic {
    /// Name of the topic in the recording.
    pub topic: String,
    /// Type as which the messages are read.
    pub value_type: ValueType,
    /// Whether a set needs a message; the first port is always needed.
    pub need: Need,
}

impl PortTopic {
    /// Creates a required port.
    pub fn new(topic: impl Into<String>, value_type: ValueType) -> Self {
        Self { topic: topic.into(), value_type, need: Need::Required }
    }
}

/// The inputs of one inference, with their messages.
#[derive(Debug, Clone)]
pub struct SyncedSet {
    /// One value for each port, in the order of the ports. A value without a stamp gets the log time of its
    /// message.
    pub values: Vec<Option<Value>>,
    /// The messages of the values.
    pub messages: Vec<Option<RecordedMessage>>,
    /// Log time of the first port's message, in nanoseconds.
    pub log_time_ns: i64,
    /// Stamp of the first port's message, or its log time without a stamp; in nanoseconds.
    pub stamp_ns: i64,
}

/// Iterator over synchronised sets of messages, in order of the log times of the first port.
///
/// Each message of the first port is matched with the messages of the other ports whose stamps are nearest, within
/// 20 ms, recorded up to one second later. The queues are bounded. A message that cannot be read yields an error,
/// and reading continues.
#[derive(Debug)]
pub struct SyncedSets {
    ports: Vec<PortTopic>,
    channels: Vec<Channel>,
    known: Vec<Known>,
    messages: Option<Messages>,
    queues: Vec<VecDeque<Waiting>>,
    /// Whether each port had a message in any set.
    has_begun: Vec<bool>,
    /// Bytes in the queues.
    held: usize,
    now_ns: i64,
    unmatched: u64,
}

#[derive(Debug)]
struct Waiting {
    message: Message,
    recorded: RecordedMessage,
    stamp_ns: i64,
}

impl SyncedSets {
    /// Opens the sets of `recording`, with a topic for each port.
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

    /// Returns the number of messages of the first port without a match of another port so far.
    pub fn unmatched(&self) -> u64 {
        self.unmatched
    }

    fn enqueue(&mut self, recorded: &RecordedMessage) -> Result<()> {
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
        for queue in self.queues.iter_mut().skip(1).filter(|queue| queue.len() > MAX_QUEUED) {
            self.held -= queue.pop_front().map_or(0, |old| old.recorded.bytes.len());
        }
        // Without a message of the first port to match, the oldest messages of the others are dropped.
        while self.held > MAX_QUEUED_BYTES && self.queues.first().is_none_or(VecDeque::is_empty) {
            let longest = self.queues.iter_mut().max_by_key(|queue| queue.len());
            let Some(old) = longest.and_then(VecDeque::pop_front) else { break };
            self.held -= old.recorded.bytes.len();
        }
        Ok(())
    }

    /// Returns whether later messages cannot change the set of the first queued message.
    fn is_decided(&self) -> bool {
        let Some((lead, others)) = self.queues.split_first() else { return true };
        let Some(first) = lead.front() else { return false };
        let waited = self.now_ns.saturating_sub(first.recorded.log_time_ns) > MAX_DELAY_NS;
        let is_full = self.held > MAX_QUEUED_BYTES || lead.len() > MAX_QUEUED;
        let came =
            |queue: &VecDeque<Waiting>| queue.back().is_some_and(|last| last.stamp_ns >= first.stamp_ns);
        self.messages.is_none() || waited || is_full || others.iter().all(came)
    }

    /// Takes the set of the first queued message; `None` if a required port has no match.
    fn take(&mut self) -> Option<Result<SyncedSet>> {
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
            // Messages older than the match are dropped.
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
        let mut set = SyncedSet { values: Vec::new(), messages: Vec::new(), log_time_ns, stamp_ns };
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

impl Iterator for SyncedSets {
    type Item = Result<SyncedSet>;

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
                    if let Err(error) = self.enqueue(&recorded) {
                        return Some(Err(error));
                    }
                }
                // The last item of the iterator; queued messages are still matched.
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
