//! The adapter: a controller that learns at every step.

use opendr_engine::environment::{Controller, Space};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result};

use super::step::{bounded_step, norm};
use super::{
    AdaptablePolicy, AdaptationParams, Envelope, EventKind, EventLog, FreezeReason, LearningSignal, Monitor,
    Preconditioner, Verdict,
};
use crate::TrackingLayout;

/// A policy that is adapted while it controls.
///
/// It is deterministic: the same observations give the same commands and the same parameters, bit for bit. After the first step it
/// allocates nothing.
pub struct OnlineAdapter<P> {
    layout: TrackingLayout,
    params: AdaptationParams,
    base: P,
    adapted: P,
    conventional: Box<dyn Controller + Send>,
    envelope: Option<Envelope>,
    preconditioner: Option<Preconditioner>,
    bounds: [Vec<f32>; 2],
    monitor: Monitor,
    log: EventLog,
    /// The last good parameters, where there were any.
    snapshot: Vec<f32>,
    buffers: Buffers,
    recording: Vec<f32>,
    /// -1 for a flipped signal, else 1.
    sign: f32,
    phase: Phase,
}

/// Memory of a step, used again.
struct Buffers {
    /// The last observations, as a ring.
    recent: Vec<f32>,
    /// Filtered sums of error and rate.
    sums: Vec<f32>,
    signals: Vec<f32>,
    /// Velocities of the reference model.
    model: Vec<f32>,
    /// Its feedback behind the lag.
    feedback: Vec<f32>,
    gradients: Vec<f32>,
    /// Preconditioned gradients of the last layer.
    direction: Vec<f32>,
    product: Vec<f32>,
    /// Commands: of now, of the base, of the conventional controller, of the delayed observation.
    adapted: Vec<f32>,
    base: Vec<f32>,
    conventional: Vec<f32>,
    delayed: Vec<f32>,
    /// By how much the guard cut the last command.
    cut: Vec<f32>,
}

/// Where an adaptation stands.
#[derive(Debug, Clone, Copy, Default)]
struct Phase {
    step: u64,
    /// Steps since the last reset.
    of_episode: u64,
    updates: u64,
    frozen: Option<FreezeReason>,
    guarded: bool,
    /// Step until which learning pauses after a rollback.
    paused_until: u64,
    paused: bool,
    strikes: u32,
    disarmed: bool,
    has_snapshot: bool,
}

/// Events that are kept.
const EVENTS: usize = 4096;

impl<P: AdaptablePolicy> OnlineAdapter<P> {
    /// An adapter around `base`, whose commands are held near those of `conventional`. `action` is the environment's action space;
    /// outside `envelope`, where one is given, nothing is learned.
    ///
    /// # Errors
    /// `InvalidParam` for parameters out of range and a layout that does not fit the action space, else those of the policy.
    pub fn new(
        base: P,
        conventional: impl Controller + Send + 'static,
        layout: TrackingLayout,
        action: &Space,
        envelope: Option<Envelope>,
        params: AdaptationParams,
    ) -> Result<Self> {
        layout.check()?;
        params.check()?;
        let Space::Box { low, high, .. } = action else {
            return Err(Error::invalid_param(format!(
                "actions are {action}; online adaptation needs a box of numbers"
            )));
        };
        if low.len() != layout.axes {
            return Err(Error::invalid_param(format!(
                "the layout has {} axes and an action {} numbers; make them equal",
                layout.axes,
                low.len()
            )));
        }
        let delay = (params.delay / params.period).round() as usize;
        let (axes, count) = (layout.axes, base.parameters().len());
        let buffers = Buffers {
            recent: vec![0.0; (delay + 1) * layout.len],
            sums: vec![0.0; axes],
            signals: vec![0.0; axes],
            model: vec![0.0; axes],
            feedback: vec![0.0; axes],
            gradients: vec![0.0; count],
            direction: Vec::new(),
            product: Vec::new(),
            adapted: vec![0.0; axes],
            base: vec![0.0; axes],
            conventional: vec![0.0; axes],
            delayed: vec![0.0; axes],
            cut: vec![0.0; axes],
        };
        let mut adapted = base.clone();
        // The policy makes its buffers here, so that the first update allocates nothing either.
        let (zeros, mut action) = (vec![0.0; layout.len], vec![0.0; axes]);
        adapted.act(&zeros, &mut action)?;
        for last_layer_only in [true, false] {
            adapted.backward(&vec![0.0; axes], last_layer_only, &mut vec![0.0; count])?;
        }
        Ok(Self {
            layout,
            monitor: Monitor::new(params.monitor, axes, f64::from(params.period)),
            adapted,
            conventional: Box::new(conventional),
            envelope,
            preconditioner: None,
            bounds: [low.clone(), high.clone()],
            log: EventLog::new(EVENTS),
            snapshot: base.parameters().to_vec(),
            buffers,
            recording: Vec::new(),
            sign: 1.0,
            phase: Phase::default(),
            base,
            params,
        })
    }

    /// Adapts the last layer alone, along gradients times this matrix.
    ///
    /// # Errors
    /// `InvalidParam` where it belongs to another network.
    pub fn with_preconditioner(mut self, preconditioner: Preconditioner) -> Result<Self> {
        let count = self.base.last_layer().len();
        if !preconditioner.fits(count, self.layout.axes) {
            return Err(Error::invalid_param("a preconditioner of another network; make one from this base"));
        }
        self.buffers.direction = vec![0.0; count];
        self.buffers.product = vec![0.0; count / self.layout.axes];
        self.preconditioner = Some(preconditioner);
        Ok(self)
    }

    /// The frozen policy.
    pub fn base(&self) -> &P {
        &self.base
    }

    /// The policy with the present parameters.
    pub fn adapted(&self) -> &P {
        &self.adapted
    }

    /// The parameters of the adaptation.
    pub fn params(&self) -> &AdaptationParams {
        &self.params
    }

    /// What happened so far.
    pub fn log(&self) -> &EventLog {
        &self.log
    }

    /// The monitor.
    pub fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    /// Steps so far, and in how many of them the parameters learned.
    pub fn steps(&self) -> [u64; 2] {
        [self.phase.step, self.phase.updates]
    }

    /// Distance of the parameters from the base (Euclidean norm).
    pub fn distance(&self) -> f32 {
        let pairs = self.adapted.parameters().iter().zip(self.base.parameters());
        norm(pairs.map(|(adapted, base)| adapted - base))
    }

    /// Whether learning was switched off after repeated rollbacks.
    pub fn is_disarmed(&self) -> bool {
        self.phase.disarmed
    }

    /// Switches learning on again.
    pub fn rearm(&mut self) {
        (self.phase.disarmed, self.phase.strikes) = (false, 0);
        self.monitor.restart();
    }

    /// Restores the base and forgets snapshots.
    pub fn restore_base(&mut self) {
        self.adapted.parameters_mut().copy_from_slice(self.base.parameters());
        self.phase.has_snapshot = false;
        self.monitor.restart();
    }

    /// Sets the parameters, drawn to within the radius around the base.
    pub(super) fn restore_parameters(&mut self, parameters: &[f32]) -> Result<()> {
        if parameters.len() != self.base.parameters().len() {
            return Err(Error::invalid_input(format!(
                "{} parameters for a network of {}; load a model of this network",
                parameters.len(),
                self.base.parameters().len()
            )));
        }
        let own = self.adapted.parameters_mut();
        own.copy_from_slice(parameters);
        bounded_step(
            own,
            self.base.parameters(),
            &self.buffers.gradients,
            0.0,
            [0.0, 0.0, self.params.radius],
        );
        self.monitor.restart();
        Ok(())
    }

    /// Turns the learning signal around: a fault to test guard and monitor with.
    #[must_use]
    pub fn with_flipped_signal(mut self) -> Self {
        self.sign = -self.sign;
        self
    }

    /// Keeps the observations of the next `steps` steps for [`Self::recording`].
    pub fn record(&mut self, steps: usize) {
        self.recording = Vec::with_capacity(steps.saturating_mul(self.layout.len));
    }

    /// The observations of the recorded steps, row after row. A fresh adapter that acts on them learns the same, bit for bit, and
    /// writes the same log.
    pub fn recording(&self) -> &[f32] {
        &self.recording
    }

    /// Learns from a recording, as in flight.
    ///
    /// # Errors
    /// Those of [`Controller::act`].
    pub fn replay(&mut self, recording: &[f32]) -> Result<()> {
        let mut action = vec![0.0; self.layout.axes];
        recording.chunks_exact(self.layout.len).try_for_each(|observation| self.act(observation, &mut action))
    }

    /// Why nothing may be learned from an observation, if so.
    fn freeze_reason(&self, observation: &[f32]) -> Option<FreezeReason> {
        if self.layout.age(observation) > self.params.max_age {
            Some(FreezeReason::Stale)
        } else if self.layout.saturated(observation) {
            Some(FreezeReason::Saturated)
        } else if self.envelope.as_ref().is_some_and(|envelope| !envelope.contains(observation)) {
            Some(FreezeReason::OutsideEnvelope)
        } else {
            None
        }
    }

    /// Whether this step may learn; freezes and resumptions go to the log.
    fn may_learn(&mut self, observation: &[f32]) -> bool {
        let reason = self.freeze_reason(observation);
        let Phase { step, frozen, paused_until, paused, .. } = self.phase;
        let pauses = step < paused_until;
        match (frozen, reason) {
            (None, Some(reason)) => self.log.push(step, EventKind::Frozen(reason)),
            (Some(_), None) => self.log.push(step, EventKind::Resumed),
            _ if paused && !pauses && !self.phase.disarmed => self.log.push(step, EventKind::Resumed),
            _ => (),
        }
        (self.phase.frozen, self.phase.paused) = (reason, pauses);
        let delay = (self.buffers.recent.len() / self.layout.len) as u64;
        reason.is_none() && !pauses && !self.phase.disarmed && self.phase.of_episode >= delay
    }

    /// Keeps good parameters, restores them when the monitor finds the present ones worse.
    fn supervise(&mut self, observation: &[f32]) -> Result<()> {
        let errors = self.layout.errors(observation);
        let verdict = self.monitor.observe(errors, &self.buffers.adapted, &self.buffers.base);
        let (step, kind) = match verdict {
            Verdict::Undecided => return Ok(()),
            Verdict::Good => {
                self.snapshot.copy_from_slice(self.adapted.parameters());
                self.monitor.count_good_again();
                (self.phase.strikes, self.phase.has_snapshot) = (0, true);
                (self.phase.step, EventKind::Snapshot)
            }
            Verdict::Worse => {
                // Restored once: where it is worse, too, the base follows.
                let (parameters, kind) = match std::mem::take(&mut self.phase.has_snapshot) {
                    true => (&self.snapshot[..], EventKind::RolledBackToSnapshot),
                    false => (self.base.parameters(), EventKind::RolledBackToBase),
                };
                self.adapted.parameters_mut().copy_from_slice(parameters);
                let pause = self.params.monitor.pause / f64::from(self.params.period);
                let pause = pause * f64::from(1u32 << self.phase.strikes.min(16));
                self.phase.paused_until = self.phase.step + pause as u64;
                self.phase.strikes += 1;
                self.monitor.restart();
                (self.phase.step, kind)
            }
        };
        self.log.push(step, kind);
        if self.phase.strikes >= self.params.monitor.strikes && !self.phase.disarmed {
            self.phase.disarmed = true;
            self.adapted.parameters_mut().copy_from_slice(self.base.parameters());
            self.log.push(step, EventKind::Disarmed);
        }
        Ok(())
    }

    /// Writes the learning signals; whether there is one.
    fn signals(&mut self, observation: &[f32]) -> bool {
        let AdaptationParams { signal, rate_weight, observer, scale, dead_zone, filter, period, .. } =
            self.params;
        let (errors, rates) = (self.layout.errors(observation), self.layout.rates(observation));
        let first = self.phase.of_episode == 0;
        let lag = self.params.monitor.lag as f32;
        let Buffers { sums, signals, model, feedback, base, cut, .. } = &mut self.buffers;
        let mut any = false;
        for axis in 0..self.layout.axes {
            let sum = match signal {
                LearningSignal::ReferenceModel => {
                    let velocity = self.layout.velocity(observation, axis);
                    // The feedback reaches the plant late, as it does without a disturbance.
                    let feedforward = self.layout.feedforward(observation, axis);
                    feedback[axis] += (base[axis] - feedforward - feedback[axis]) * (period / (lag + period));
                    let moved = model[axis] + (feedforward + feedback[axis]) * period;
                    let lacking = if first { 0.0 } else { moved - velocity };
                    model[axis] = velocity + lacking * (1.0 - observer * period).max(0.0);
                    lacking
                }
                LearningSignal::ExpertRule | LearningSignal::FeedbackError => {
                    errors[axis] + rate_weight * rates[axis]
                }
            };
            sums[axis] += (sum - sums[axis]) * (period / (filter + period));
            let value = self.sign * signal.value(sums[axis], scale, dead_zone);
            // What the guard cuts off must not be asked for more and more.
            signals[axis] = if cut[axis] * value > 0.0 { 0.0 } else { value };
            any |= signals[axis] != 0.0;
        }
        any
    }

    /// Moves the parameters so that the command of a delay ago would have been different by the signal.
    fn learn(&mut self) -> Result<()> {
        let Self { adapted, base, buffers, params, layout, phase, preconditioner, .. } = self;
        let Buffers { recent, signals, gradients, direction, product, delayed, .. } = buffers;
        let slots = (recent.len() / layout.len) as u64;
        // The slot that this step's observation will overwrite is the oldest.
        let oldest = (phase.of_episode % slots) as usize * layout.len;
        let observation = &mut recent[oldest..oldest + layout.len];
        if params.reference_only {
            layout.clear_errors(observation);
        }
        adapted.act(observation, delayed)?;
        let last_only = params.last_layer_only || preconditioner.is_some();
        let range = if last_only { adapted.last_layer() } else { 0..gradients.len() };
        gradients[range.clone()].fill(0.0);
        adapted.backward(signals, last_only, gradients)?;
        let gradients = &gradients[range.clone()];
        let along = match preconditioner {
            None => gradients,
            Some(preconditioner) => {
                preconditioner.apply(gradients, direction, product);
                direction
            }
        };
        let change: f32 = gradients.iter().zip(along).map(|(gradient, along)| gradient * along).sum();
        let wanted: f32 = signals.iter().map(|signal| signal * signal).sum();
        if change <= 1e-12 * wanted || !change.is_finite() {
            return Ok(());
        }
        // The command then changes by about rate x signal x period.
        let factor = params.rate * params.period * wanted / change;
        let limits = [params.step_limit, params.leak * params.period, params.radius];
        let parameters = &mut adapted.parameters_mut()[range.clone()];
        bounded_step(parameters, &base.parameters()[range], along, factor, limits);
        phase.updates += 1;
        Ok(())
    }

    /// Writes the command of the adapted policy, held near the conventional one and within the action space.
    fn command(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let Buffers { adapted, base, conventional, cut, .. } = &mut self.buffers;
        self.conventional.act(observation, conventional)?;
        self.base.act(observation, base)?;
        self.adapted.act(observation, adapted)?;
        let band = self.params.band;
        let mut guarded = false;
        for axis in 0..adapted.len() {
            let held = adapted[axis].clamp(conventional[axis] - band, conventional[axis] + band);
            let held = held.clamp(self.bounds[0][axis], self.bounds[1][axis]);
            cut[axis] = adapted[axis] - held;
            guarded |= cut[axis] != 0.0;
            (adapted[axis], action[axis]) = (held, held);
        }
        if guarded && !self.phase.guarded {
            self.log.push(self.phase.step, EventKind::Guarded);
        }
        self.phase.guarded = guarded;
        Ok(())
    }
}

impl<P: AdaptablePolicy> Controller for OnlineAdapter<P> {
    /// Another episode: what was learned stays, the past of the last one is forgotten.
    fn reset(&mut self) {
        self.conventional.reset();
        self.buffers.sums.fill(0.0);
        self.buffers.feedback.fill(0.0);
        self.buffers.cut.fill(0.0);
        self.buffers.adapted.fill(0.0);
        self.buffers.base.fill(0.0);
        self.monitor = Monitor::new(self.params.monitor, self.layout.axes, f64::from(self.params.period));
        self.phase.of_episode = 0;
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.layout.check_lengths(observation, action)?;
        if self.recording.len() + observation.len() <= self.recording.capacity() {
            self.recording.extend_from_slice(observation);
        }
        self.supervise(observation)?;
        let signalled = self.signals(observation);
        if self.may_learn(observation) && signalled {
            self.learn()?;
        }
        self.command(observation, action)?;
        let slots = (self.buffers.recent.len() / self.layout.len) as u64;
        let slot = (self.phase.of_episode % slots) as usize * self.layout.len;
        self.buffers.recent[slot..slot + self.layout.len].copy_from_slice(observation);
        self.phase.step += 1;
        self.phase.of_episode += 1;
        Ok(())
    }
}
