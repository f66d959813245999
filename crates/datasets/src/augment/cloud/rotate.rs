//! Rotation of a scene.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::cloud::scene::SceneChange;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Rotates points and boxes about the vertical axis through the lidar.
#[derive(Debug, Clone, Params)]
pub struct CloudRotate {
    /// Largest angle in either direction.
    #[param(default = 0.785, range = 0.0..=3.15, unit = "rad")]
    pub max_angle: f32,
}

impl Augmentation for CloudRotate {
    const NAME: &'static str = "cloud_rotate";
    const ABOUT: &'static str = "rotates a point cloud about the vertical axis";
}

impl Augment for CloudRotate {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let angle = f64::from(random.uniform(-self.max_angle, self.max_angle));
        SceneChange { angle, ..SceneChange::NONE }.apply(sample)
    }
}
