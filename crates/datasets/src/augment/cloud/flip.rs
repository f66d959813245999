//! Mirroring of a scene.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::cloud::scene::SceneChange;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Mirrors points and boxes: left and right of the lidar are swapped.
#[derive(Debug, Clone, Params)]
pub struct CloudFlip {}

impl Augmentation for CloudFlip {
    const NAME: &'static str = "cloud_flip";
    const ABOUT: &'static str = "mirrors a point cloud left to right";
}

impl Augment for CloudFlip {
    fn apply(&self, sample: &mut Sample, _: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        SceneChange { mirrored: true, ..SceneChange::NONE }.apply(sample)
    }
}
