//! The perception loop of an episode: view, belief, observation, motion.

use opendr_engine::rig::{Achieved, ViewPose};
use opendr_engine::target::Action;
use opendr_engine::{Random, Result};

use crate::best_view::BestViewEstimator;
use crate::fusion::{Belief, Fusion};
use crate::observation::Observer;
use crate::scene::ActiveScene;

/// A scene with the belief over its classes.
#[derive(Debug)]
pub struct ViewLoop<S> {
    scene: S,
    belief: Belief,
    observer: Observer,
    evidence: Vec<f32>,
    class: usize,
}

impl<S: ActiveScene> ViewLoop<S> {
    /// Creates the loop over a scene; `budget` is the maximum number of motions, `estimator` that of the best view.
    ///
    /// # Errors
    /// Returns `InvalidParam` for a scene of fewer than two classes.
    pub fn new(
        mut scene: S,
        fusion: Fusion,
        budget: usize,
        estimator: Option<BestViewEstimator>,
    ) -> Result<Self> {
        let classes = scene.classes();
        let observer = Observer::new(scene.rig().axes(), budget, estimator);
        Ok(Self {
            belief: Belief::new(classes, fusion)?,
            observer,
            evidence: vec![0.0; classes],
            class: 0,
            scene,
        })
    }

    /// Begins an episode and captures its first view.
    ///
    /// # Errors
    /// Returns errors of the scene.
    pub fn begin(&mut self, random: &mut Random) -> Result<()> {
        self.class = self.scene.begin(random)?;
        self.belief.reset();
        self.observer.reset(self.scene.rig().pose());
        self.capture()
    }

    /// Moves the camera and captures a view.
    ///
    /// # Errors
    /// Returns errors of the scene.
    pub fn step(&mut self, action: &Action) -> Result<Achieved> {
        let achieved = self.scene.rig().apply(action)?;
        self.observer.set_motion(achieved);
        self.capture()?;
        Ok(achieved)
    }

    /// Captures a view at the current pose.
    ///
    /// # Errors
    /// Returns errors of the scene.
    fn capture(&mut self) -> Result<()> {
        let pose = self.scene.rig().pose();
        self.observer.add(self.scene.view(&mut self.evidence)?, pose)?;
        self.belief.add(pose, &self.evidence)
    }

    /// Writes the observation of the camera policy.
    pub fn observe(&mut self, observation: &mut [f32]) {
        let pose = self.scene.rig().pose();
        self.observer.observe(&pose, &self.belief, observation);
    }

    /// Returns the belief.
    pub fn belief(&self) -> &Belief {
        &self.belief
    }

    /// Returns the evidence of the last view.
    pub fn evidence(&self) -> &[f32] {
        &self.evidence
    }

    /// Returns the true class of this episode.
    pub fn class(&self) -> usize {
        self.class
    }

    /// Returns the probability of the true class.
    pub fn probability(&self) -> f32 {
        self.belief.probabilities()[self.class]
    }

    /// Returns the camera pose.
    pub fn pose(&mut self) -> ViewPose {
        self.scene.rig().pose()
    }

    /// Returns the scene.
    pub fn scene(&mut self) -> &mut S {
        &mut self.scene
    }
}
