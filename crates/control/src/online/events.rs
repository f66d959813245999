//! What happened during an adaptation.

use serde::Serialize;

/// Why learning stands still.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FreezeReason {
    /// The state estimate is too old.
    Stale,
    /// The last command was cut to the actuators' limits.
    Saturated,
    /// The observation is unlike those of the training.
    OutsideEnvelope,
}

/// A kind of [`Event`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EventKind {
    /// Learning was frozen.
    Frozen(FreezeReason),
    /// Learning was resumed after a freeze or a pause.
    Resumed,
    /// The parameters were kept as the last good ones.
    Snapshot,
    /// The monitor found the adaptation worse than the base; the last good parameters were restored.
    RolledBackToSnapshot,
    /// The same, and the base was restored.
    RolledBackToBase,
    /// After repeated rollbacks learning was switched off until [`OnlineAdapter::rearm`](super::OnlineAdapter::rearm).
    Disarmed,
    /// A command was cut to the band around the conventional controller, for the first time since it was last inside.
    Guarded,
}

/// Something that happened at a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Event {
    /// Step since the adapter was made.
    pub step: u64,
    /// What happened.
    pub kind: EventKind,
}

/// Events in the order in which they happened, in memory of a fixed size: the first ones are kept, later ones are counted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EventLog {
    events: Vec<Event>,
    #[serde(skip)]
    capacity: usize,
    dropped: u64,
}

impl EventLog {
    /// A log of at most `capacity` events.
    pub(super) fn new(capacity: usize) -> Self {
        Self { events: Vec::with_capacity(capacity), capacity, dropped: 0 }
    }

    pub(super) fn push(&mut self, step: u64, kind: EventKind) {
        if self.events.len() < self.capacity {
            self.events.push(Event { step, kind });
        } else {
            self.dropped += 1;
        }
    }

    /// Returns the events.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Returns the number of events that were dropped after the memory was full.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Returns the number of events of a kind that are kept.
    pub fn count(&self, kind: EventKind) -> usize {
        self.events.iter().filter(|event| event.kind == kind).count()
    }
}
