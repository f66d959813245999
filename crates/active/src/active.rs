//! Active perception on a rig.

use opendr_engine::data::Image;
use opendr_engine::learner::{AnyLearner, Entry};
use opendr_engine::rig::{Limit, ViewPose, ViewRig};
use opendr_engine::target::Action;
use opendr_engine::{Error, Result};
use serde::Serialize;

use crate::any_recogniser::AnyRecogniser;
use crate::fusion::Belief;
use crate::learner::{ActiveContainer, has_camera_policy};
use crate::model::ActiveModel;
use crate::recogniser::ViewRecogniser;
use crate::session::ActiveSession;
use crate::stop::{StopReason, StopRule};

/// Makes a recogniser active: it moves the camera of a rig to where the recogniser is expected to be certain, and stops when
/// the belief is.
///
/// Any [`ViewRecogniser`] fits, and with [`LearnerRecogniser`](crate::LearnerRecogniser) or
/// [`AnyRecogniser`](crate::AnyRecogniser) any learner whose target has classes. The camera policy observes a thumbnail,
/// confidences and poses alone, so that the recogniser can be exchanged.
pub struct Active<R> {
    recogniser: R,
    session: ActiveSession,
    stop: StopRule,
    axes: usize,
    evidence: Vec<f32>,
}

/// A view of a run.
#[derive(Debug, Clone, Serialize)]
pub struct View {
    /// Pose of the camera.
    pub pose: ViewPose,
    /// The image.
    #[serde(skip)]
    pub image: Image,
    /// The most likely class after it.
    pub class: usize,
    /// Its probability.
    pub confidence: f32,
    /// The motion after it; `None` after the last view.
    pub action: Option<Action>,
    /// By how much the motion was expected to raise the probability of the true class; `None` after the last view.
    pub expected_gain: Option<f32>,
    /// For each axis the limit that stopped the motion after it.
    pub limits: [Option<Limit>; 4],
}

/// A run from the first view to the stop.
#[derive(Debug, Clone, Serialize)]
pub struct Outcome {
    /// The views, in their order.
    pub views: Vec<View>,
    /// The most likely class.
    pub class: usize,
    /// Probability of each class.
    pub probabilities: Vec<f32>,
    /// Why the run stopped.
    pub reason: StopReason,
}

impl Active<Box<dyn ViewRecogniser>> {
    /// Makes a loaded learner of the registry active: one of active perception by its own camera policy, any other learner of images
    /// with classes by `camera_policy`.
    ///
    /// # Errors
    /// Returns `InvalidParam` where the camera policy is missing, or given to a learner that has one; otherwise as
    /// [`AnyRecogniser::new`] and [`ActiveContainer::of`].
    pub fn of_learner(
        learner: &dyn AnyLearner,
        entry: &Entry,
        camera_policy: Option<&ActiveModel>,
    ) -> Result<Self> {
        match (camera_policy, has_camera_policy(entry)) {
            (None, true) => {
                let ActiveContainer { model, recogniser, .. } = ActiveContainer::of(learner)?;
                Self::new(Box::new(recogniser), &model)
            }
            (Some(model), false) => {
                let recogniser = AnyRecogniser::new(learner, entry, learner.classes().len())?;
                Self::new(Box::new(recogniser), model)
            }
            (Some(_), true) => Err(Error::invalid_param(format!(
                "{} has a camera policy of its own; omit camera_policy (--camera-policy)",
                entry.spec.class
            ))),
            (None, false) => Err(Error::invalid_param(format!(
                "{} has no camera policy; give one as camera_policy (--camera-policy), trained by \"opendr fit active_object_recognition\"",
                entry.spec.class
            ))),
        }
    }
}

impl<R: ViewRecogniser> Active<R> {
    /// Creates active perception from a recogniser and a trained model.
    ///
    /// # Errors
    /// Returns `InvalidParam` for a recogniser of fewer than two classes.
    pub fn new(recogniser: R, model: &ActiveModel) -> Result<Self> {
        let classes = recogniser.classes();
        let session = ActiveSession::new(model, classes)?;
        let (stop, axes) = (model.stop, model.axes.len());
        Ok(Self { session, recogniser, stop, axes, evidence: vec![0.0; classes] })
    }

    /// Returns the recogniser.
    pub fn recogniser(&self) -> &R {
        &self.recogniser
    }

    /// Returns the belief after the last view.
    pub fn belief(&self) -> &Belief {
        self.session.belief()
    }

    /// Captures views and moves until the belief is certain, no motion is expected to help, or the budget is used.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a rig with another number of axes, and errors of rig and recogniser.
    pub fn run(&mut self, rig: &mut dyn ViewRig) -> Result<Outcome> {
        if rig.axes().len() != self.axes {
            return Err(Error::invalid_input(format!(
                "a policy of {} axes for a rig of {}; train it on this rig",
                self.axes,
                rig.axes().len()
            )));
        }
        self.session.begin(rig.pose());
        let mut views = Vec::with_capacity(self.stop.moves + 1);
        loop {
            let (image, pose) = (rig.capture()?, rig.pose());
            self.recogniser.recognise(&image, &mut self.evidence)?;
            let decision = self.session.add(&image, pose, &self.evidence, &self.stop)?;
            let (class, confidence) = (decision.class, decision.confidence);
            let mut view =
                View { pose, image, class, confidence, action: None, expected_gain: None, limits: [None; 4] };
            match (decision.action, decision.reason) {
                (Some(action), None) => {
                    let achieved = rig.apply(&action)?;
                    self.session.set_motion(achieved);
                    view.action = Some(action);
                    view.expected_gain = Some(decision.expected_gain);
                    view.limits = achieved.limits;
                    views.push(view);
                }
                (_, reason) => {
                    views.push(view);
                    let probabilities = self.belief().probabilities().to_vec();
                    let reason = reason.unwrap_or(StopReason::Budget);
                    return Ok(Outcome { views, class, probabilities, reason });
                }
            }
        }
    }
}
