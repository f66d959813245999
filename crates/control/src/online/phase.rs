//! Where an adaptation stands.

use super::{EventKind, EventLog, FreezeReason, MonitorParams};

/// Counters and flags of an adapter.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Phase {
    pub step: u64,
    /// Steps since the last reset.
    pub of_episode: u64,
    pub updates: u64,
    frozen: Option<FreezeReason>,
    /// Whether this estimate and the one before were not renewed, and the age of this one.
    pub stale: bool,
    pub was_stale: bool,
    pub age: f32,
    pub guarded: bool,
    /// Step until which learning pauses after a rollback.
    paused_until: u64,
    paused: bool,
    /// Step until which the effects of a freeze last.
    settled_at: u64,
    pub strikes: u32,
    pub disarmed: bool,
    pub has_snapshot: bool,
}

impl Phase {
    /// Begins a pause after a rollback, twice as long as the last.
    pub fn pause(&mut self, params: &MonitorParams, period: f64) {
        let pause = params.pause / period * f64::from(1u32 << self.strikes.min(16));
        self.paused_until = self.step.saturating_add(pause as u64);
        self.strikes += 1;
    }

    pub fn begin_episode(&mut self) {
        (self.of_episode, self.settled_at) = (0, 0);
        (self.stale, self.was_stale, self.age) = (false, false, 0.0);
    }

    pub fn advance(&mut self) {
        self.step += 1;
        self.of_episode += 1;
    }

    /// Returns whether this step may learn; freezes and resumptions go to the log.
    pub fn may_learn(
        &mut self,
        reason: Option<FreezeReason>,
        settle: f32,
        period: f64,
        log: &mut EventLog,
    ) -> bool {
        let pauses = self.step < self.paused_until;
        match (self.frozen, reason) {
            (None, Some(reason)) => log.push(self.step, EventKind::Frozen(reason)),
            (Some(_), None) => log.push(self.step, EventKind::Resumed),
            _ if self.paused && !pauses && !self.disarmed => log.push(self.step, EventKind::Resumed),
            _ => (),
        }
        (self.frozen, self.paused) = (reason, pauses);
        if self.of_episode == 0 || matches!(reason, Some(reason) if reason != FreezeReason::Stale) {
            self.settled_at = self.step + (f64::from(settle) / period) as u64;
        }
        reason.is_none() && !pauses && !self.disarmed && self.step >= self.settled_at
    }
}
