//! Part affinity fields: from maps of joints and limbs to persons, and from persons to the maps.
//!
//! Cao et al., "Realtime Multi-Person 2D Pose Estimation using Part Affinity Fields", CVPR 2017; Osokin, "Real-time 2D
//! Multi-Person Pose Estimation on CPU: Lightweight OpenPose", 2018. For each joint a heat map peaks where anybody has
//! that joint; for each limb a field of vectors points, wherever anybody has that limb, along it. [`PartAffinity`] reads
//! such maps in three steps:
//!
//! 1. Peaks of each heat map. Only around a cell that is a local maximum is the map upsampled (cubic), so that the
//!    result is that of an upsampled map at the cost of a coarse one.
//! 2. Candidates: every pair of peaks that a limb could join is scored by the mean of the field along the way.
//! 3. Persons grow from candidates, best first. One that would give a person two of a joint is left out: this is the
//!    greedy matching of each limb (Cao et al., section 2.4) and the joining of limbs in one pass.
//!
//! [`Painter`] makes the maps that a network should answer. Joints and their order are OpenDR's
//! ([`Skeleton::Opendr18`](opendr_engine::target::Skeleton)).

mod limbs;
mod maps;
mod paint;
mod peaks;
mod persons;
#[cfg(test)]
mod tests;

use limbs::Candidate;
pub use limbs::LIMBS;
pub use maps::{Grid, PartMaps};
use opendr_engine::target::Keypoint;
pub use paint::Painter;
use peaks::Peak;
use persons::Growing;

/// Joints of a person.
pub const JOINTS: usize = 18;
/// Heat maps: one a joint, and the background.
pub const HEAT_MAPS: usize = JOINTS + 1;
/// Fields: x and y of each limb.
pub const FIELDS: usize = 2 * LIMBS.len();

/// A person in pixels of the network's input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Person {
    /// In OpenDR's order; the confidence of each is the height of its peak, 0..=1.
    pub joints: [Keypoint; JOINTS],
    /// The mean confidence of the joints, those that were not found counting as 0; 0..=1.
    pub score: f32,
}

/// How maps are read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartAffinity {
    /// Peaks below this height are no joints, 0..=1.
    pub peak_threshold: f32,
    /// Steps from cell to cell in which a peak is looked for; 1 to [`PartAffinity::MAX_UPSAMPLE_RATIO`].
    pub upsample_ratio: usize,
    /// Peaks of one joint nearer than this are one, pixels of the network's input.
    pub radius: f32,
    /// Where the field along a limb is below this there is no limb; 0..=1.
    pub limb_threshold: f32,
    /// The share of a limb where there must be one, 0..=1.
    pub limb_share: f32,
    /// Persons with fewer joints are dropped.
    pub min_joints: usize,
}

impl Default for PartAffinity {
    /// Osokin's numbers.
    fn default() -> Self {
        Self {
            peak_threshold: 0.1,
            upsample_ratio: 4,
            radius: 12.0,
            limb_threshold: 0.05,
            limb_share: 0.8,
            min_joints: 3,
        }
    }
}

/// Work memory of [`PartAffinity::decode`].
#[derive(Debug, Clone, Default)]
pub struct Memory {
    peaks: Vec<Peak>,
    candidates: Vec<Candidate>,
    growing: Growing,
}

impl PartAffinity {
    /// The finest upsampling.
    pub const MAX_UPSAMPLE_RATIO: usize = 8;

    /// Fills `persons`, best first. Once `memory` and `persons` are large enough nothing is allocated.
    ///
    /// At most 64 peaks of a joint are looked at, the highest. NaN and infinite numbers make no peak and no limb.
    pub fn decode(&self, maps: &PartMaps<'_>, memory: &mut Memory, persons: &mut Vec<Person>) {
        let Memory { peaks, candidates, growing } = memory;
        let ends = peaks::find(self, maps, peaks);
        limbs::find(self, maps, peaks, &ends, candidates);
        growing.grow(peaks, candidates);
        growing.finish(self.min_joints, peaks, &maps.grid(), persons);
    }
}
