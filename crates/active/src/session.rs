//! Views of one subject in, decisions out.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::rig::{Achieved, ViewPose};
use opendr_engine::target::Action;
use opendr_kernels::Compute;

use crate::camera_policy::{CameraContext, CameraPolicy as _, TrainedPolicy};
use crate::fusion::Belief;
use crate::gain::GainNetwork;
use crate::model::ActiveModel;
use crate::observation::Observer;
use crate::stop::{StopReason, StopRule};

/// The state of active perception of one subject: belief, camera policy, stop rule.
#[derive(Debug)]
pub struct ActiveSession {
    policy: TrainedPolicy,
    gain: GainNetwork,
    compute: Compute,
    belief: Belief,
    observer: Observer,
    axes: Vec<opendr_engine::rig::ViewAxis>,
    observation: Vec<f32>,
    deflections: Vec<f32>,
}

/// The decision after a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// The most likely class.
    pub class: usize,
    /// Its probability.
    pub confidence: f32,
    /// The next motion; `None` after the last view.
    pub action: Option<Action>,
    /// By how much the motion is expected to raise the probability of the true class.
    pub expected_gain: f32,
    /// Why this view is the last one.
    pub reason: Option<StopReason>,
}

impl ActiveSession {
    /// Creates a session of a model, for `classes` classes.
    ///
    /// # Errors
    /// Returns `InvalidParam` for fewer than two classes.
    pub fn new(model: &ActiveModel, classes: usize) -> Result<Self> {
        Ok(Self {
            policy: TrainedPolicy::new(model.policy.clone()),
            gain: model.gain.clone(),
            compute: Compute::single(),
            belief: Belief::new(classes, model.fusion)?,
            observer: Observer::new(&model.axes, model.stop.moves, model.best_view.clone()),
            axes: model.axes.clone(),
            observation: vec![0.0; Observer::LEN],
            deflections: vec![0.0; model.axes.len()],
        })
    }

    /// Begins with a new subject, seen from `pose`.
    pub fn begin(&mut self, pose: ViewPose) {
        self.belief.reset();
        self.policy.begin(0);
        self.observer.reset(pose);
    }

    /// Returns the belief.
    pub fn belief(&self) -> &Belief {
        &self.belief
    }

    /// Adds a view and decides on the next motion.
    ///
    /// # Errors
    /// Returns `InvalidInput` for an image that is not of 8 bits, evidence of another number of classes and numbers that are not
    /// finite, `Internal` for networks whose outputs are not finite.
    pub fn add(
        &mut self,
        image: &Image,
        pose: ViewPose,
        evidence: &[f32],
        stop: &StopRule,
    ) -> Result<Decision> {
        let Self { policy, gain, compute, belief, observer, axes, observation, deflections } = self;
        let motions = belief.views();
        belief.add(pose, evidence)?;
        observer.add(image, pose)?;
        observer.observe(&pose, belief, observation);
        policy.choose(&CameraContext { observation, pose, axes, best: None }, deflections)?;
        let expected_gain = gain.predict(compute, observation, deflections)?.first().copied().unwrap_or(0.0);
        let (class, confidence) = belief.best();
        let reason = stop.reason(motions, confidence, Some(expected_gain));
        let action = if reason.is_some() { None } else { Some(Action::new(deflections)?) };
        Ok(Decision { class, confidence, action, expected_gain, reason })
    }

    /// States what the rig carried out of the motion.
    pub fn set_motion(&mut self, achieved: Achieved) {
        self.observer.set_motion(achieved);
    }
}
