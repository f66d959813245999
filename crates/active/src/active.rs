//! A recogniser that moves its camera.

use opendr_engine::data::Image;
use opendr_engine::rig::{Limit, ViewPose, ViewRig};
use opendr_engine::target::Action;
use opendr_engine::{Error, Result};
use opendr_kernels::Compute;
use opendr_rl::{ActionMode, PolicyMemory};
use serde::Serialize;

use crate::fusion::Belief;
use crate::observation::Observer;
use crate::recogniser::ViewRecogniser;
use crate::stop::StopReason;
use crate::training::ActiveModel;

/// Makes a recogniser active: it looks, moves where its policy expects to see more, and stops when it is certain.
///
/// Any [`ViewRecogniser`] goes in, and with [`LearnerRecogniser`](crate::LearnerRecogniser) any learner of the toolkit whose
/// target has classes. The policy is given a thumbnail, confidences and poses alone, so it outlives the recogniser.
pub struct Active<R> {
    recogniser: R,
    model: ActiveModel,
    compute: Compute,
    belief: Belief,
    memory: PolicyMemory,
    evidence: Vec<f32>,
}

/// A view of a run.
#[derive(Debug, Clone, Serialize)]
pub struct View {
    /// Where it was taken from.
    pub pose: ViewPose,
    /// The picture.
    #[serde(skip)]
    pub image: Image,
    /// The most likely class after it.
    pub class: usize,
    /// Its probability.
    pub confidence: f32,
    /// The movement after it; `None` after the last view.
    pub action: Option<Action>,
    /// By how much the movement was expected to raise the probability of the true class; `None` after the last view.
    pub expected_gain: Option<f32>,
    /// For each axis the limit that stopped the movement after it.
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
    /// Why it stopped.
    pub reason: StopReason,
}

impl<R: ViewRecogniser> Active<R> {
    /// An active recogniser by a trained model.
    ///
    /// # Errors
    /// `InvalidParam` for a recogniser of fewer than two classes.
    pub fn new(recogniser: R, model: ActiveModel) -> Result<Self> {
        let classes = recogniser.classes();
        Ok(Self {
            belief: Belief::new(classes, model.fusion)?,
            recogniser,
            model,
            compute: Compute::single(),
            memory: PolicyMemory::default(),
            evidence: vec![0.0; classes],
        })
    }

    /// The recogniser.
    pub fn recogniser(&self) -> &R {
        &self.recogniser
    }

    /// The belief after the last view.
    pub fn belief(&self) -> &Belief {
        &self.belief
    }

    /// Looks and moves until it is certain, no movement is expected to help, or the budget is used.
    ///
    /// # Errors
    /// `InvalidInput` for a rig with another number of axes than the policy moves; those of rig and recogniser.
    pub fn run(&mut self, rig: &mut dyn ViewRig) -> Result<Outcome> {
        let axes = self.model.policy.action().len();
        if rig.axes().len() != axes {
            return Err(Error::invalid_input(format!(
                "a policy of {axes} axes for a rig of {}; train it on this rig",
                rig.axes().len()
            )));
        }
        self.belief.reset();
        self.memory.reset(0);
        let mut observer = Observer::new(rig.axes(), self.model.stop.moves);
        observer.reset(rig.pose());
        let (mut observation, mut deflections) = (vec![0.0; Observer::LEN], vec![0.0; axes]);
        let mut views = Vec::with_capacity(self.model.stop.moves + 1);
        loop {
            let (image, pose) = (rig.capture()?, rig.pose());
            self.recogniser.recognise(&image, &mut self.evidence)?;
            self.belief.add(pose, &self.evidence)?;
            observer.saw(&image)?;
            observer.observe(&pose, &self.belief, &mut observation);
            let gain = self.propose(&observation, &mut deflections)?;
            let (class, confidence) = self.belief.best();
            let view =
                View { pose, image, class, confidence, action: None, expected_gain: None, limits: [None; 4] };
            let reason = self.model.stop.reason(views.len(), confidence, Some(gain));
            views.push(view);
            if let Some(reason) = reason {
                return Ok(Outcome {
                    views,
                    class,
                    probabilities: self.belief.probabilities().to_vec(),
                    reason,
                });
            }
            let action = Action::new(&deflections)?;
            let achieved = rig.apply(&action)?;
            observer.moved(achieved);
            if let Some(view) = views.last_mut() {
                (view.action, view.expected_gain, view.limits) = (Some(action), Some(gain), achieved.limits);
            }
        }
    }

    /// Writes the policy's movement, and returns its expected gain.
    fn propose(&mut self, observation: &[f32], deflections: &mut [f32]) -> Result<f32> {
        let Self { model, compute, memory, .. } = self;
        model.policy.act(compute, observation, ActionMode::Deterministic, memory, deflections)?;
        deflections.iter_mut().for_each(|axis| *axis = axis.clamp(-1.0, 1.0));
        Ok(model.gain.predict(compute, observation, deflections).first().copied().unwrap_or(0.0))
    }
}
