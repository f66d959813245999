//! Policies that correct a controller.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::{Error, Result};

use super::{AlphaSchedule, BoxedController};
use crate::algorithm::Algorithm;
use crate::policy::Bounds;

/// An environment whose actions correct those of a prior controller: `clip(prior(o) + alpha * correction)` is executed
/// (residual policy learning; Silver et al., 2018, Johannink et al., 2019).
///
/// Observations are pairs of the observation and the prior's action. A correction of 1 in the middle of the bounds reaches a bound
/// where alpha is 1. The correction of zeros is the prior.
pub struct Residual<E> {
    inner: E,
    prior: BoxedController,
    correction: Correction,
    alpha: AlphaSchedule,
    spec: EnvironmentSpec,
    steps: u64,
    proposal: Vec<f32>,
    action: Vec<f32>,
}

/// Adds corrections to proposals within bounds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Correction {
    bounds: Bounds,
}

impl Correction {
    /// Creates the sum of prior and correction for actions of `space`.
    pub fn new(space: &Space) -> Result<Self> {
        Ok(Self { bounds: Bounds::of(space, true)? })
    }

    /// Returns the space of corrections: half as wide as that of actions, around zero.
    pub fn space(&self) -> Space {
        let widths = self.bounds.low.iter().zip(&self.bounds.high).map(|(low, high)| 0.5 * (high - low));
        Space::symmetric(&widths.collect::<Vec<_>>())
    }

    /// Writes `clip(proposal + alpha * correction)`.
    pub fn add(&self, proposal: &[f32], correction: &[f32], alpha: f32, action: &mut [f32]) {
        let bounds = self.bounds.low.iter().zip(&self.bounds.high);
        for (action, ((proposal, correction), (low, high))) in
            action.iter_mut().zip(proposal.iter().zip(correction).zip(bounds))
        {
            *action = (proposal + alpha * correction).clamp(*low, *high);
        }
    }
}

/// Returns observation and action space of the environment inside, from the observations of a [`Residual`] one.
pub(super) fn residual_spaces(space: &Space) -> Result<(&Space, &Space)> {
    match space {
        Space::Tuple(parts) if parts.len() == 2 => Ok((&parts[0], &parts[1])),
        other => Err(Error::format(format!(
            "observations {other} contain no action of a prior: they are not those of a Residual environment"
        ))),
    }
}

impl Correction {
    /// Writes `clip(middle + alpha * correction)`.
    pub fn add_to_middle(&self, correction: &[f32], alpha: f32, action: &mut [f32]) {
        let bounds = self.bounds.low.iter().zip(&self.bounds.high);
        for (action, (correction, (low, high))) in action.iter_mut().zip(correction.iter().zip(bounds)) {
            *action = (0.5 * (low + high) + alpha * correction).clamp(*low, *high);
        }
    }
}

impl<E: Environment> Residual<E> {
    /// Wraps `inner` so that actions are corrections of `prior`.
    ///
    /// # Errors
    /// `Unsupported` for actions that are no bounded box.
    pub fn new(inner: E, prior: BoxedController, alpha: AlphaSchedule) -> Result<Self> {
        let mut spec = inner.spec().clone();
        let correction = Correction::new(&spec.action)?;
        let numbers = vec![0.0; spec.action.len()];
        spec.observation = Space::Tuple(vec![spec.observation, spec.action]);
        spec.action = correction.space();
        let (proposal, action) = (numbers.clone(), numbers);
        Ok(Self { inner, prior, correction, alpha, spec, steps: 0, proposal, action })
    }

    /// Returns the environment inside.
    pub fn inner(&self) -> &E {
        &self.inner
    }

    /// Observation of the environment, and room for the prior's action.
    fn split<'o>(&self, observation: &'o mut [f32]) -> Result<(&'o mut [f32], &'o mut [f32])> {
        let (len, own) = (observation.len(), self.spec.observation.len());
        let at = own - self.proposal.len();
        observation.split_at_mut_checked(at).filter(|_| len == own).ok_or_else(|| {
            Error::invalid_input(format!(
                "room for {len} numbers; observations of {} have {own}",
                self.spec.id
            ))
        })
    }

    fn propose(&mut self, seen: &[f32], proposal: &mut [f32]) -> Result<()> {
        self.prior.act(seen, &mut self.proposal)?;
        proposal.copy_from_slice(&self.proposal);
        Ok(())
    }
}

impl<E: Environment> Environment for Residual<E> {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let (seen, proposal) = self.split(observation)?;
        let info = self.inner.reset(seed, options, seen)?;
        self.prior.reset();
        self.propose(seen, proposal)?;
        Ok(info)
    }

    fn step(&mut self, correction: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.spec.action.check(correction)?;
        let (seen, proposal) = self.split(observation)?;
        let alpha = self.alpha.at(self.steps);
        self.steps += 1;
        self.correction.add(&self.proposal, correction, alpha, &mut self.action);
        let step = self.inner.step(&self.action, seen)?;
        self.prior.executed(&self.action);
        self.propose(seen, proposal)?;
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.push(self.steps);
        snapshot.extend_numbers(self.proposal.iter().map(|number| f64::from(*number)));
        self.prior.save_state(snapshot)?;
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.steps = state.word()?;
        for number in &mut self.proposal {
            *number = state.finite()? as f32;
        }
        self.prior.load_state(state)?;
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}

/// Makes the policy of `algorithm` answer zero corrections, with `log_std` as the logarithm of the deviation of its noise where it
/// samples: the first actions in a [`Residual`] environment are those of the prior.
///
/// # Errors
/// As [`Algorithm::set_policy`].
pub fn begin_as_prior<A: Algorithm + ?Sized>(algorithm: &mut A, log_std: f32) -> Result<()> {
    let mut policy = algorithm.policy().clone();
    policy.zero_output(log_std);
    algorithm.set_policy(&policy)
}
