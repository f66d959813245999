//! Limb candidates from peaks and fields.

use super::layout::{JOINTS, LIMBS};
use super::maps::{PartMaps, Plane};
use super::parameters::PartAffinity;
use super::peaks::Peak;

/// Two peaks that may be the ends of a limb.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Candidate {
    /// Mean of the field along the limb.
    pub(super) score: f32,
    pub(super) limb: usize,
    /// Indices of the peaks.
    pub(super) ends: [usize; 2],
}

/// Number of samples of the field along a limb.
const SAMPLES: usize = 10;

/// Fills `candidates`, highest score first.
pub(super) fn find(
    how: &PartAffinity,
    maps: &PartMaps<'_>,
    peaks: &[Peak],
    ends: &[usize; JOINTS],
    candidates: &mut Vec<Candidate>,
) {
    candidates.clear();
    let peaks_of = |joint: usize| joint.checked_sub(1).map_or(0, |before| ends[before])..ends[joint];
    for (limb, [from, to]) in LIMBS.into_iter().enumerate() {
        let field = maps.field(limb);
        for first in peaks_of(from) {
            for second in peaks_of(to) {
                let along = [peaks[first].place, peaks[second].place];
                if let Some(score) = how.limb_score(&field, along) {
                    candidates.push(Candidate { score, limb, ends: [first, second] });
                }
            }
        }
    }
    candidates.sort_unstable_by(|a, b| {
        b.score.total_cmp(&a.score).then(a.limb.cmp(&b.limb)).then(a.ends.cmp(&b.ends))
    });
}

impl PartAffinity {
    /// Returns the line integral of the field from one position to another (Cao et al., Eq. 10), by samples; `None` without
    /// a limb.
    fn limb_score(&self, [x, y]: &[Plane<'_>; 2], [from, to]: [[f32; 2]; 2]) -> Option<f32> {
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0].hypot(way[1]);
        if length < 1e-3 {
            return None;
        }
        let (mut sum, mut above) = (0.0, 0);
        for sample in 0..SAMPLES {
            let part = sample as f32 / (SAMPLES - 1) as f32;
            let place = [from[0] + part * way[0], from[1] + part * way[1]];
            let along = (x.between(place) * way[0] + y.between(place) * way[1]) / length;
            sum += along;
            above += usize::from(along >= self.limb_threshold);
        }
        let is_limb = above as f32 >= self.limb_share * SAMPLES as f32;
        (is_limb && sum.is_finite()).then_some(sum / SAMPLES as f32)
    }
}
