//! One episode of looking: views into a belief, the observation of now.

use opendr_engine::rig::{Achieved, ViewPose};
use opendr_engine::target::Action;
use opendr_engine::{Random, Result};

use crate::fusion::{Belief, Fusion};
use crate::observation::Observer;
use crate::scene::ActiveScene;

/// A scene with the belief about it.
#[derive(Debug)]
pub struct Look<S> {
    scene: S,
    belief: Belief,
    observer: Observer,
    evidence: Vec<f32>,
    class: usize,
}

impl<S: ActiveScene> Look<S> {
    /// Over a scene, before an episode.
    ///
    /// # Errors
    /// `InvalidParam` for a scene of fewer than two classes.
    pub fn new(mut scene: S, fusion: Fusion, budget: usize) -> Result<Self> {
        let classes = scene.classes();
        let observer = Observer::new(scene.rig().axes(), budget);
        Ok(Self {
            belief: Belief::new(classes, fusion)?,
            observer,
            evidence: vec![0.0; classes],
            class: 0,
            scene,
        })
    }

    /// Begins an episode and takes its first picture.
    ///
    /// # Errors
    /// Those of the scene.
    pub fn begin(&mut self, random: &mut Random) -> Result<()> {
        self.class = self.scene.begin(random)?;
        self.belief.reset();
        self.observer.reset(self.scene.rig().pose());
        self.take()
    }

    /// Moves and takes a picture.
    ///
    /// # Errors
    /// Those of the scene.
    pub fn step(&mut self, action: &Action) -> Result<Achieved> {
        let achieved = self.scene.rig().apply(action)?;
        self.observer.moved(achieved);
        self.take()?;
        Ok(achieved)
    }

    /// Takes a picture from where the camera is.
    ///
    /// # Errors
    /// Those of the scene.
    pub fn take(&mut self) -> Result<()> {
        let image = self.scene.view(&mut self.evidence)?;
        self.observer.saw(image)?;
        let pose = self.scene.rig().pose();
        self.belief.add(pose, &self.evidence)
    }

    /// Writes the observation of now.
    pub fn observe(&mut self, observation: &mut [f32]) {
        let pose = self.scene.rig().pose();
        self.observer.observe(&pose, &self.belief, observation);
    }

    /// The belief.
    pub fn belief(&self) -> &Belief {
        &self.belief
    }

    /// Evidence of the last view.
    pub fn evidence(&self) -> &[f32] {
        &self.evidence
    }

    /// The true class of this episode.
    pub fn class(&self) -> usize {
        self.class
    }

    /// The probability of the true class.
    pub fn probability(&self) -> f32 {
        self.belief.probabilities()[self.class]
    }

    /// Where the camera is.
    pub fn pose(&mut self) -> ViewPose {
        self.scene.rig().pose()
    }

    /// The scene.
    pub fn scene(&mut self) -> &mut S {
        &mut self.scene
    }
}
