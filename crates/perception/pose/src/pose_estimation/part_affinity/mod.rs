//! Part affinity fields: decoding of maps of joints and limbs to persons, and encoding of persons to maps.
//!
//! Cao et al., "Realtime Multi-Person 2D Pose Estimation using Part Affinity Fields", CVPR 2017; Osokin, "Real-time 2D
//! Multi-Person Pose Estimation on CPU: Lightweight OpenPose", 2018. Each joint has a heatmap with peaks at that joint of all
//! persons; each limb has a vector field along that limb of all persons. [`PartAffinity`] decodes these maps in three steps:
//!
//! 1. Peaks of each heatmap. The map is upsampled (cubic) only around cells that are local maxima, so the result is that of
//!    an upsampled map at the cost of a coarse one.
//! 2. Candidates: every pair of peaks that a limb could connect has the mean of the field along it as its score.
//! 3. Persons grow from candidates, highest score first. A candidate that would give a person a second joint of a kind is
//!    skipped. This is the greedy matching of each limb (Cao et al., section 2.4) and the assembly of limbs in one pass.
//!
//! [`MapEncoder`] encodes the target maps of a training. Joints and their order are OpenDR's
//! ([`Skeleton::Opendr18`](opendr_engine::target::Skeleton)).

mod layout;
mod limbs;
mod maps;
mod paint;
mod parameters;
mod peaks;
mod person;
mod persons;
#[cfg(test)]
mod tests;

pub use layout::{FIELDS, HEAT_MAPS, JOINTS, LIMBS};
use limbs::Candidate;
pub use maps::{Grid, PartMaps};
pub use paint::MapEncoder;
pub use parameters::PartAffinity;
use peaks::Peak;
pub use person::Person;
use persons::Growing;

/// Work memory of [`PartAffinity::decode`].
#[derive(Debug, Clone, Default)]
pub struct DecodeScratch {
    peaks: Vec<Peak>,
    candidates: Vec<Candidate>,
    growing: Growing,
}

impl PartAffinity {
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
