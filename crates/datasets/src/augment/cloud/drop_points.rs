//! Random removal of points.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::cloud::points::for_each_cloud;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Removes a random share of the points; the others keep their order.
#[derive(Debug, Clone, Params)]
pub struct DropPoints {
    /// Largest share of points that are removed.
    #[param(default = 0.2, range = 0.0..=1.0)]
    pub max_share: f32,
}

impl Augmentation for DropPoints {
    const NAME: &'static str = "drop_points";
    const ABOUT: &'static str = "removes random points of a cloud";
}

impl Augment for DropPoints {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let share = random.uniform(0.0, self.max_share);
        for_each_cloud(sample, |data, channels| {
            let mut kept = 0;
            for point in 0..data.len() / channels {
                if !random.chance(share) {
                    data.copy_within(point * channels..(point + 1) * channels, kept * channels);
                    kept += 1;
                }
            }
            data.truncate(kept * channels);
        })
    }
}
