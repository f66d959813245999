//! Scaling of a scene.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::cloud::scene::SceneChange;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Scales points and boxes about the lidar.
#[derive(Debug, Clone, Params)]
pub struct CloudScale {
    /// Smallest factor.
    #[param(default = 0.95, range = 0.1..=10.0)]
    pub min_scale: f32,
    /// Largest factor.
    #[param(default = 1.05, range = 0.1..=10.0)]
    pub max_scale: f32,
}

impl Augmentation for CloudScale {
    const NAME: &'static str = "cloud_scale";
    const ABOUT: &'static str = "scales a point cloud";
}

impl Augment for CloudScale {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let scale = f64::from(random.uniform(self.min_scale, self.max_scale));
        SceneChange { scale, ..SceneChange::NONE }.apply(sample)
    }
}
