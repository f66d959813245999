//! Points that were not seen.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::cloud::points::each_cloud;
use crate::augment::{Augment, Augmentation, Others};

/// Leaves out a random share of the points; the others keep their order.
#[derive(Debug, Clone, Params)]
pub struct DropPoints {
    /// Largest share of points that are left out.
    #[param(default = 0.2, range = 0.0..=1.0)]
    pub max_share: f32,
}

impl Augmentation for DropPoints {
    const NAME: &'static str = "drop_points";
    const ABOUT: &'static str = "leaves out points of a cloud";
}

impl Augment for DropPoints {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &Others<'_>) -> Result<()> {
        let share = random.uniform(0.0, self.max_share);
        each_cloud(sample, |data, channels| {
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
