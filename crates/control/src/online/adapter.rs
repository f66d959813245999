//! The adapter: a controller that learns at every step.

use opendr_engine::environment::{Controller, EnvironmentSpec, TrackingTask};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result};

use super::estimator::AxisEstimator;
use super::features::Inputs;
use super::phase::Phase;
use super::requirements::{tracking_bounds, tracking_task};
use super::{
    AdaptablePolicy, AdaptationParams, Envelope, EventKind, EventLog, FreezeReason, Monitor,
    ReferenceFeatures, Verdict,
};
use crate::TrackingPid;

/// A policy that is adapted while it controls.
///
/// It is deterministic: the same observations give the same commands and the same parameters, bit for bit. After the first step it
/// allocates nothing.
pub struct OnlineAdapter<P> {
    pub(super) task: TrackingTask,
    pub(super) params: AdaptationParams,
    pub(super) base: P,
    pub(super) adapted: P,
    conventional: TrackingPid,
    envelope: Option<Envelope>,
    features: ReferenceFeatures,
    estimators: Vec<AxisEstimator>,
    bounds: [Vec<f32>; 2],
    monitor: Monitor,
    pub(super) log: EventLog,
    /// The last good weights, where there were any.
    snapshot: Vec<f32>,
    buffers: Buffers,
    recording: Vec<f32>,
    /// -1 for a flipped signal, else 1.
    sign: f32,
    pub(super) phase: Phase,
}

/// Memory of a step, used again.
struct Buffers {
    inputs: Inputs,
    last_inputs: Vec<f32>,
    features: Vec<f32>,
    /// Weights of all axes, `[axes, features]`.
    weights: Vec<f32>,
    /// The observation, with the errors of the last measurement where the estimate was not renewed.
    held: Vec<f32>,
    /// The observation without its errors.
    reference: Vec<f32>,
    /// Commands: of now, of the base, of the base without errors, of the conventional controller.
    adapted: Vec<f32>,
    base: Vec<f32>,
    without_errors: Vec<f32>,
    conventional: Vec<f32>,
    /// By how much the guard cut the last command.
    cut: Vec<f32>,
    /// Feed-forward commands, as old as the observed velocity.
    feedforward: Vec<f32>,
}

/// Events that are kept.
const EVENTS: usize = 4096;

impl<P: AdaptablePolicy> OnlineAdapter<P> {
    /// Creates an adapter around `base` for the tracking task of an environment. Outside `envelope`, where one is given, nothing is
    /// learned and the conventional law of the task acts.
    ///
    /// # Errors
    /// `Unsupported` for an environment without a tracking task or a box of actions and for a policy that cannot be adapted,
    /// `InvalidParam` for parameters out of range, else those of the policy.
    pub fn new(
        base: P,
        spec: &EnvironmentSpec,
        envelope: Option<Envelope>,
        params: AdaptationParams,
    ) -> Result<Self> {
        let task = tracking_task(spec)?.clone();
        task.check()?;
        params.check()?;
        let (low, high) = tracking_bounds(spec, &task)?;
        let (layout, axes) = (task.layout, task.axes.len());
        let mut adapted = base.clone();
        let features = ReferenceFeatures::constant(&mut adapted, &layout)?;
        let mut adapter = Self {
            conventional: TrackingPid::conventional(&task, low, high)?,
            monitor: Monitor::new(params.monitor, &task),
            buffers: Buffers {
                inputs: Inputs::new(&adapted, &layout),
                last_inputs: vec![0.0; base.last_layer().len() / base.outputs().max(1)],
                features: Vec::new(),
                weights: Vec::new(),
                held: vec![0.0; layout.len],
                reference: vec![0.0; layout.len],
                adapted: vec![0.0; axes],
                base: vec![0.0; axes],
                without_errors: vec![0.0; axes],
                conventional: vec![0.0; axes],
                cut: vec![0.0; axes],
                feedforward: vec![0.0; axes],
            },
            envelope,
            estimators: Vec::new(),
            bounds: [low.to_vec(), high.to_vec()],
            log: EventLog::new(EVENTS),
            snapshot: Vec::new(),
            recording: Vec::new(),
            sign: 1.0,
            phase: Phase::default(),
            features: features.clone(),
            task,
            adapted,
            base,
            params,
        };
        adapter.set_features(features);
        Ok(adapter)
    }

    /// Adapts these features of the reference beside constant loads.
    ///
    /// # Errors
    /// `InvalidParam` where they belong to another network.
    pub fn with_features(mut self, features: ReferenceFeatures) -> Result<Self> {
        if !features.fits(self.base.last_layer().len(), self.base.outputs()) {
            return Err(Error::invalid_param("features of another network; make them from this base"));
        }
        self.set_features(features);
        Ok(self)
    }

    fn set_features(&mut self, features: ReferenceFeatures) {
        let (count, period) = (features.count(), self.task.period as f32);
        let axis = |response: f64| AxisEstimator::new(&self.params, count, response as f32, period);
        self.estimators = self.task.axes.iter().map(|own| axis(own.response)).collect();
        self.buffers.features = vec![0.0; count];
        self.buffers.weights = vec![0.0; count * self.task.axes.len()];
        self.snapshot = self.buffers.weights.clone();
        self.features = features;
    }

    /// Returns the frozen policy.
    pub fn base(&self) -> &P {
        &self.base
    }

    /// Returns the policy with the present parameters.
    pub fn adapted(&self) -> &P {
        &self.adapted
    }

    /// Returns the parameters of the adaptation.
    pub fn params(&self) -> &AdaptationParams {
        &self.params
    }

    /// Numbers of an action.
    pub fn axes(&self) -> usize {
        self.task.axes.len()
    }

    /// Returns the log of events so far.
    pub fn log(&self) -> &EventLog {
        &self.log
    }

    /// Returns the monitor.
    pub fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    /// Returns the number of steps so far, and of those in which the parameters learned.
    pub fn steps(&self) -> [u64; 2] {
        [self.phase.step, self.phase.updates]
    }

    /// Weights of the features, `[axes, features]`; 0 for the base.
    pub fn weights(&self) -> &[f32] {
        &self.buffers.weights
    }

    /// Returns the norm of the weights: about by how much the commands were changed.
    pub fn distance(&self) -> f32 {
        norm(&self.buffers.weights)
    }

    /// Returns whether learning was switched off after repeated rollbacks.
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
        self.buffers.weights.fill(0.0);
        self.spread_weights();
        self.phase.has_snapshot = false;
        self.monitor.restart();
    }

    /// Sets the weights, drawn to within the radius.
    pub(super) fn restore_weights(&mut self, weights: &[f32]) -> Result<()> {
        if weights.len() != self.buffers.weights.len() || weights.iter().any(|weight| !weight.is_finite()) {
            return Err(Error::invalid_input(format!(
                "{} weights for an adapter of {}; load a model that was adapted with the same features",
                weights.len(),
                self.buffers.weights.len()
            )));
        }
        let kept = (self.params.radius / norm(weights)).min(1.0);
        self.buffers.weights.iter_mut().zip(weights).for_each(|(own, weight)| *own = kept * weight);
        self.spread_weights();
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
        self.recording = Vec::with_capacity(steps.saturating_mul(self.task.layout.len));
    }

    /// Returns the observations of the recorded steps, row after row. A fresh adapter that acts on them learns the same, bit for
    /// bit, and writes the same log.
    pub fn recording(&self) -> &[f32] {
        &self.recording
    }

    /// Learns from a recording, as in flight.
    ///
    /// # Errors
    /// Those of [`Controller::act`].
    pub fn replay(&mut self, recording: &[f32]) -> Result<()> {
        let mut action = vec![0.0; self.task.axes.len()];
        let rows = recording.chunks_exact(self.task.layout.len);
        rows.into_iter().try_for_each(|observation| self.act(observation, &mut action))
    }

    /// Why nothing may be learned from an observation, if so.
    fn freeze_reason(&self, observation: &[f32]) -> Option<FreezeReason> {
        let layout = &self.task.layout;
        if layout.age(observation) > self.params.max_age {
            Some(FreezeReason::Stale)
        } else if layout.saturated(observation) {
            Some(FreezeReason::Saturated)
        } else if self.envelope.as_ref().is_some_and(|envelope| !envelope.contains(observation)) {
            Some(FreezeReason::OutsideEnvelope)
        } else {
            None
        }
    }

    /// Keeps good weights, restores them when the monitor finds the present ones worse.
    fn supervise(&mut self, observation: &[f32]) {
        let errors = self.task.layout.errors(observation);
        let step = self.phase.step;
        match self.monitor.observe(errors, &self.buffers.adapted, &self.buffers.base) {
            Verdict::Undecided => (),
            Verdict::Good => {
                self.snapshot.copy_from_slice(&self.buffers.weights);
                self.monitor.count_good_again();
                (self.phase.strikes, self.phase.has_snapshot) = (0, true);
                self.log.push(step, EventKind::Snapshot);
            }
            Verdict::Worse => self.roll_back(),
        }
    }

    /// Restores the last good weights, once: where these are worse, too, the base follows.
    fn roll_back(&mut self) {
        let step = self.phase.step;
        let kind = if std::mem::take(&mut self.phase.has_snapshot) {
            self.buffers.weights.copy_from_slice(&self.snapshot);
            EventKind::RolledBackToSnapshot
        } else {
            self.buffers.weights.fill(0.0);
            EventKind::RolledBackToBase
        };
        self.log.push(step, kind);
        self.phase.pause(&self.params.monitor, self.task.period);
        if self.phase.strikes >= self.params.monitor.strikes && !self.phase.disarmed {
            self.phase.disarmed = true;
            self.buffers.weights.fill(0.0);
            self.log.push(step, EventKind::Disarmed);
        }
        self.spread_weights();
        self.monitor.restart();
    }

    /// Writes the weights into estimators and network.
    fn spread_weights(&mut self) {
        let count = self.features.count();
        for (axis, weights) in self.estimators.iter_mut().zip(self.buffers.weights.chunks_exact(count)) {
            axis.weights.copy_from_slice(weights);
        }
        let range = self.base.last_layer();
        let base = &self.base.parameters()[range.clone()];
        self.features.apply(base, &self.buffers.weights, &mut self.adapted.parameters_mut()[range]);
    }

    /// Takes in the observed velocities.
    fn observe(&mut self, observation: &[f32], fresh: bool) {
        let (layout, period) = (self.task.layout, self.task.period as f32);
        for (at, axis) in self.estimators.iter_mut().enumerate() {
            let velocity = layout.velocity(observation, at);
            axis.observe(velocity, self.params.observer, period, fresh);
        }
    }

    /// Starts the lag of the feedforward commands.
    fn start(&mut self, observation: &[f32]) {
        for (at, feedforward) in self.buffers.feedforward.iter_mut().enumerate() {
            *feedforward = self.task.layout.feedforward(observation, at);
        }
    }

    /// Moves the weights, within the limits of a step and of the distance.
    fn learn(&mut self) {
        let (params, count) = (&self.params, self.features.count());
        let weights = &mut self.buffers.weights;
        for (axis, cut) in self.estimators.iter_mut().zip(&self.buffers.cut) {
            // What the guard cuts off must not be asked for more and more.
            if *cut == 0.0 {
                axis.learn(params, self.task.period as f32, self.sign);
            }
        }
        let estimated = || self.estimators.iter().flat_map(|axis| &axis.weights);
        let step: f32 = estimated().zip(&*weights).map(|(new, old)| (new - old) * (new - old)).sum();
        let share = (params.step_limit / step.sqrt()).min(1.0);
        if !step.is_finite() || !share.is_finite() {
            // No distance, or numbers that overflowed: the weights stay.
            return self.spread_weights();
        }
        estimated().zip(&mut *weights).for_each(|(new, old)| *old += share * (new - *old));
        let kept = (params.radius / norm(weights)).min(1.0);
        weights.iter_mut().for_each(|weight| *weight *= kept);
        debug_assert_eq!(weights.len(), count * self.estimators.len());
        self.spread_weights();
        self.phase.updates += 1;
    }

    /// Writes the command of the adapted policy, held near the conventional one and within the action space; outside the envelope
    /// the conventional one, shifted by the load.
    fn command(&mut self, observation: &[f32], outside: bool, action: &mut [f32]) -> Result<()> {
        let Buffers { adapted, base, conventional, cut, .. } = &mut self.buffers;
        self.conventional.act(observation, conventional)?;
        self.base.act(observation, base)?;
        self.adapted.act(observation, adapted)?;
        let band = self.params.band;
        let mut guarded = false;
        for axis in 0..adapted.len() {
            if outside {
                base[axis] = conventional[axis];
                adapted[axis] = conventional[axis] + self.estimators[axis].weights[0];
            }
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

    /// Takes in what the command of this step consists of.
    fn keep_command(&mut self, observation: &[f32]) -> Result<()> {
        let layout = self.task.layout;
        let Buffers { inputs, last_inputs, features, reference, base, without_errors, feedforward, .. } =
            &mut self.buffers;
        inputs.of_last_act(&mut self.adapted)?;
        inputs.write(last_inputs);
        self.features.write(last_inputs, features);
        reference.copy_from_slice(observation);
        layout.clear_errors(reference);
        self.base.act(reference, without_errors)?;
        let period = self.task.period as f32;
        let share = period / (layout.age(observation).min(self.params.max_age) + period);
        for (at, axis) in self.estimators.iter_mut().enumerate() {
            feedforward[at] += share * (layout.feedforward(observation, at) - feedforward[at]);
            let feedback = base[at] - without_errors[at];
            axis.command(feedforward[at], feedback, features, inputs.slopes()[at], period);
        }
        Ok(())
    }
}

fn norm(numbers: &[f32]) -> f32 {
    numbers.iter().map(|number| number * number).sum::<f32>().sqrt()
}

impl<P: AdaptablePolicy> OnlineAdapter<P> {
    /// Takes over an observation. While the estimate is not renewed it keeps the last errors: an extrapolated velocity drifts from
    /// the reference's, and the feedback would answer to that.
    fn hold(&mut self, observation: &[f32], held: &mut [f32]) {
        let layout = &self.task.layout;
        let age = layout.age(observation);
        let grown = f64::from(age - self.phase.age) > 0.5 * self.task.period;
        let renewed = !grown || self.phase.of_episode == 0;
        let kept = [layout.error..layout.error + layout.axes, layout.rate..layout.rate + layout.axes];
        for (at, (held, number)) in held.iter_mut().zip(observation).enumerate() {
            if renewed || !kept.iter().any(|range| range.contains(&at)) {
                *held = *number;
            }
        }
        (self.phase.age, self.phase.stale) = (age, !renewed);
    }

    /// Learns from an observation and writes the command for it.
    fn act_on(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.supervise(observation);
        let reason = self.freeze_reason(observation);
        let (stale, first) = (self.phase.stale, self.phase.of_episode == 0);
        self.observe(observation, !stale && !self.phase.was_stale && !first);
        self.phase.was_stale = stale;
        if first {
            self.start(observation);
        }
        if self.phase.may_learn(reason, self.params.settle, self.task.period, &mut self.log) && !stale {
            self.learn();
        }
        self.command(observation, reason == Some(FreezeReason::OutsideEnvelope), action)?;
        self.keep_command(observation)?;
        self.phase.advance();
        Ok(())
    }
}

impl<P: AdaptablePolicy> Controller for OnlineAdapter<P> {
    /// Another episode: what was learned stays, the past of the last one is forgotten.
    fn reset(&mut self) {
        self.conventional.reset();
        self.estimators.iter_mut().for_each(AxisEstimator::reset);
        self.buffers.cut.fill(0.0);
        self.buffers.adapted.fill(0.0);
        self.buffers.base.fill(0.0);
        self.monitor.reset();
        self.phase.begin_episode();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.task.layout.check_lengths(observation, action)?;
        if let Some(place) = observation.iter().position(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "number {place} of the observation is {}; nothing is learned from it and no command follows from it",
                observation[place]
            )));
        }
        if self.recording.len() + observation.len() <= self.recording.capacity() {
            self.recording.extend_from_slice(observation);
        }
        let mut held = std::mem::take(&mut self.buffers.held);
        self.hold(observation, &mut held);
        let acted = self.act_on(&held, action);
        self.buffers.held = held;
        acted
    }
}
