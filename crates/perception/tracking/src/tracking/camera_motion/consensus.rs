//! The motion that most points agree with.

use opendr_vision::Similarity;

use super::SimilarityMotion;

/// Minimum number of points.
const FEWEST: usize = 8;
const ROUNDS: usize = 6;
/// Tolerance of agreement, as a share of the image's longer side.
const AGREEMENT: f32 = 1.0 / 320.0;
/// Factor of the tolerance in the first round, which fits a shift only: rotations move the corners of an image more than
/// its centre.
const FIRST: f32 = 8.0;

/// Points of the last frame and their positions in the current one.
#[derive(Debug, Default)]
pub(super) struct Consensus {
    pairs: Vec<[[f32; 2]; 2]>,
    shifts: Vec<f32>,
    from: Vec<[f32; 2]>,
    to: Vec<[f32; 2]>,
}

impl Consensus {
    pub fn begin(&mut self) {
        self.pairs.clear();
    }

    pub fn add(&mut self, from: [f32; 2], to: [f32; 2]) {
        self.pairs.push([from, to]);
    }

    /// Fits the median shift first, then a similarity to the points that agree, with a decreasing tolerance.
    pub fn motion(&mut self, size: [usize; 2]) -> SimilarityMotion {
        if self.pairs.len() < FEWEST {
            return SimilarityMotion::NONE;
        }
        let shift = [0, 1].map(|axis| self.median(axis));
        let mut motion = SimilarityMotion::new([1.0, 0.0], shift.map(f64::from));
        let agreement = size[0].max(size[1]) as f32 * AGREEMENT;
        for round in 0..ROUNDS {
            let tolerance = agreement * (FIRST / (1 << (2 * round)) as f32).max(1.0);
            self.from.clear();
            self.to.clear();
            for [from, to] in &self.pairs {
                let expected = motion.map(from.map(f64::from));
                if (expected[0] as f32 - to[0]).hypot(expected[1] as f32 - to[1]) <= tolerance {
                    self.from.push(*from);
                    self.to.push(*to);
                }
            }
            let is_majority = self.from.len() >= FEWEST.max(self.pairs.len() / 3);
            match Similarity::from_points(&self.from, &self.to).filter(|_| is_majority) {
                Some(found) => motion = motion_of(&found),
                None => return SimilarityMotion::NONE,
            }
        }
        motion
    }

    fn median(&mut self, axis: usize) -> f32 {
        self.shifts.clear();
        self.shifts.extend(self.pairs.iter().map(|[from, to]| to[axis] - from[axis]));
        let middle = self.shifts.len() / 2;
        *self.shifts.select_nth_unstable_by(middle, f32::total_cmp).1
    }
}

/// Converts a similarity of images to a motion: the crop is the current frame.
fn motion_of(found: &Similarity) -> SimilarityMotion {
    let scale = 1.0 / f64::from(found.scale());
    let (sine, cosine) = (-f64::from(found.angle())).sin_cos();
    let [x, y] = found.crop_from_image([0.0, 0.0]).map(f64::from);
    SimilarityMotion::new([scale * cosine, scale * sine], [x, y])
}
