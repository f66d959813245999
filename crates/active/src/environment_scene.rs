//! Episodes of an environment with a recogniser in the loop.

use opendr_engine::data::Image;
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::rig::{ViewPose, ViewRig};
use opendr_engine::{Error, Random, Result};

use crate::environment_rig::EnvironmentRig;
use crate::recogniser::ViewRecogniser;
use crate::scene::ActiveScene;

/// A scene whose rig moves in an environment.
pub struct EnvironmentScene<R> {
    rig: EnvironmentRig,
    recogniser: R,
}

impl<R: ViewRecogniser> EnvironmentScene<R> {
    /// Creates a scene in an environment from a source.
    ///
    /// # Errors
    /// Returns errors of the environment, and `InvalidInput` for a recogniser of another number of classes.
    pub fn new(source: &dyn EnvironmentSource, recogniser: R) -> Result<Self> {
        let rig = EnvironmentRig::new(source.make()?)?;
        if recogniser.classes() != rig.classes() {
            return Err(Error::invalid_input(format!(
                "a recogniser of {} classes in an environment of {}; train it on views of this environment",
                recogniser.classes(),
                rig.classes()
            )));
        }
        Ok(Self { rig, recogniser })
    }
}

impl<R: ViewRecogniser> ActiveScene for EnvironmentScene<R> {
    fn classes(&self) -> usize {
        self.recogniser.classes()
    }

    fn begin(&mut self, random: &mut Random) -> Result<usize> {
        self.rig.begin(random.bits())
    }

    fn rig(&mut self) -> &mut dyn ViewRig {
        &mut self.rig
    }

    fn view(&mut self, evidence: &mut [f32]) -> Result<&Image> {
        self.recogniser.recognise(self.rig.image(), evidence)?;
        Ok(self.rig.image())
    }

    fn best_pose(&self) -> Option<ViewPose> {
        self.rig.best_pose()
    }
}
