//! Part affinity fields: decoding of maps of joints and limbs to persons, and encoding of persons to maps.
//!
//! Cao et al., "Realtime Multi-Person 2D Pose Estimation using Part Affinity Fields", CVPR 2017; Osokin, "Real-time 2D
//! Multi-Person Pose Estimation on CPU: Lightweight OpenPose", 2018. Each joint has a heat map with peaks at that joint of all
//! persons; each limb has a vector field along that limb of all persons. [`PartAffinity`] decodes these maps in three steps:
//!
//! 1. Peaks of each heat map. The map is upsampled (cubic) only around cells that are local maxima, so the result is that of
//!    an upsampled map at the cost of a coarse one.
//! 2. Candidates: every pair of peaks that a limb could connect has the mean of the field along it as its score.
//! 3. Persons grow from candidates, highest score first. A candidate that would give a person a second joint of a kind is
//!    skipped. This is the greedy matching of each limb (Cao et al., section 2.4) and the assembly of limbs in one pass.
//!
//! [`MapEncoder`] encodes the target maps of a training. Joints and their order are OpenDR's
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
pub use paint::MapEncoder;
use peaks::Peak;
use persons::Growing;

/// Number of joints of a person.
pub const JOINTS: usize = 18;
/// Number of heat maps: one per joint, and the background.
pub const HEAT_MAPS: usize = JOINTS + 1;
/// Number of maps of fields: x and y of each limb.
pub const FIELDS: usize = 2 * LIMBS.len();

/// A person in pixels of the network's input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Person {
    /// Joints in OpenDR's order; the confidence of each is the height of its peak, 0..=1.
    pub joints: [Keypoint; JOINTS],
    /// Mean confidence of the joints, with 0 for missing ones; 0..=1.
    pub score: f32,
}

/// Parameters of the decoder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartAffinity {
    /// Height below which peaks are ignored, 0..=1.
    pub peak_threshold: f32,
    /// Upsampling factor around peaks; 1 to [`PartAffinity::MAX_UPSAMPLE_RATIO`].
    pub upsample_ratio: usize,
    /// Distance below which peaks of one joint are merged, in pixels of the network's input.
    pub radius: f32,
    /// Value of the field along a limb below which a sample does not count; 0..=1.
    pub limb_threshold: f32,
    /// Minimum share of samples of a limb that count, 0..=1.
    pub limb_share: f32,
    /// Minimum number of joints of a person.
    pub min_joints: usize,
}

impl Default for PartAffinity {
    /// Returns Osokin's parameters.
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
pub struct DecodeScratch {
    peaks: Vec<Peak>,
    candidates: Vec<Candidate>,
    growing: Growing,
}

impl PartAffinity {
    /// Maximum upsampling factor.
    pub const MAX_UPSAMPLE_RATIO: usize = 8;

    /// Fills `persons`, highest score first. Nothing is allocated once `memory` and `persons` are large enough.
    ///
    /// At most 64 peaks per joint are used, the highest. NaN and infinite values have no peaks and no limbs.
    pub fn decode(&self, maps: &PartMaps<'_>, memory: &mut DecodeScratch, persons: &mut Vec<Person>) {
        let DecodeScratch { peaks, candidates, growing } = memory;
        let ends = peaks::find(self, maps, peaks);
        limbs::find(self, maps, peaks, &ends, candidates);
        growing.grow(peaks, candidates);
        growing.finish(self.min_joints, peaks, &maps.grid(), persons);
    }
}
