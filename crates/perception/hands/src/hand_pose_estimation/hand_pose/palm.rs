//! Decoding of the palm detector's outputs to squares around hands.

use opendr_engine::{Error, Result};
use opendr_perception_common::rotated_square::{RotatedSquare, angle_upwards};
use opendr_perception_common::suppression::{Candidate, keep_best, merge_overlapping};
use opendr_vision::InputGeometry;

/// Number of values of a palm: centre, size and seven keypoints, `x, y` each, in input pixels relative to the anchor.
pub(super) const ROW: usize = 18;
/// Indices of the keypoints at the wrist and at the base of the middle finger.
const WRIST: usize = 0;
const MIDDLE: usize = 2;
/// Feature maps: cells along a side, and anchors per cell.
const MAPS: [(usize, usize); 2] = [(24, 2), (12, 6)];
/// Number of candidates with the highest scores that are processed; more are noise.
const CONSIDERED: usize = 100;

/// Centres of the detector's anchors, in shares of the input's side.
#[derive(Debug)]
pub(super) struct Anchors(Vec<[f32; 2]>);

/// Work memory.
#[derive(Debug, Default)]
pub(super) struct PalmScratch {
    candidates: Vec<Candidate>,
    members: Vec<Candidate>,
}

impl Anchors {
    /// Creates the anchors of an input of 192 pixels: cell by cell, row by row.
    pub fn new() -> Self {
        let map = |(cells, each): (usize, usize)| {
            let centre = move |at: usize| (at as f32 + 0.5) / cells as f32;
            (0..cells * cells)
                .flat_map(move |cell| std::iter::repeat_n([centre(cell % cells), centre(cell / cells)], each))
        };
        Self(MAPS.into_iter().flat_map(map).collect())
    }

    /// Adds a square around the hand of each palm to `hands`, highest score first, in pixels of the image.
    ///
    /// `rows` is `[anchors, 18]`, `logits` `[anchors]`, `side` that of the input. Palms that overlap by more than `overlap`
    /// are averaged, weighted by their scores.
    ///
    /// # Errors
    /// `Format` when the number of rows differs from that of the anchors.
    pub fn decode(
        &self,
        [rows, logits]: [&[f32]; 2],
        side: usize,
        geometry: &InputGeometry,
        [threshold, overlap]: [f32; 2],
        scratch: &mut PalmScratch,
        hands: &mut Vec<RotatedSquare>,
    ) -> Result<()> {
        let anchors = self.0.len();
        if rows.len() != anchors * ROW || logits.len() != anchors {
            return Err(Error::format(format!(
                "a palm detector of 192 pixels needs {anchors} rows of {ROW} values and as many scores, not {} and {}; load another model",
                rows.len(),
                logits.len()
            )));
        }
        let side = side as f32;
        // Position `at` of palm `index`, in input pixels.
        let point = |index: usize, at: usize| {
            let row = &rows[index * ROW..(index + 1) * ROW];
            let [x, y] = self.0[index];
            [row[at] + x * side, row[at + 1] + y * side]
        };
        scratch.candidates.clear();
        for (index, logit) in logits.iter().enumerate() {
            let score = 1.0 / (1.0 + (-logit).exp());
            let all_finite = || rows[index * ROW..(index + 1) * ROW].iter().all(|number| number.is_finite());
            if score >= threshold && all_finite() {
                let ([x, y], size) = (point(index, 0), [rows[index * ROW + 2], rows[index * ROW + 3]]);
                let corners = [x - size[0] / 2.0, y - size[1] / 2.0, x + size[0] / 2.0, y + size[1] / 2.0];
                scratch.candidates.push(Candidate { corners, score, class: 0, index: index as u32 });
            }
        }
        keep_best(&mut scratch.candidates, CONSIDERED);
        merge_overlapping(&mut scratch.candidates, &mut scratch.members, overlap, |members| {
            let total: f32 = members.iter().map(|member| member.score).sum();
            let blend = |value: &dyn Fn(&Candidate) -> [f32; 2]| {
                let sum = members.iter().fold([0.0; 2], |sum, member| {
                    let [x, y] = value(member);
                    [sum[0] + x * member.score, sum[1] + y * member.score]
                });
                sum.map(|sum| sum / total)
            };
            let low = blend(&|member| [member.corners[0], member.corners[1]]);
            let high = blend(&|member| [member.corners[2], member.corners[3]]);
            let key = |number: usize| blend(&|member| point(member.index as usize, 4 + 2 * number));
            let centre = geometry.image_from_input([(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0]);
            let long = (high[0] - low[0]).max(high[1] - low[1]) * geometry.scale[0];
            let angle = angle_upwards(key(WRIST), key(MIDDLE));
            // From the palm to the hand: half its height up, 2.6 times as large (MediaPipe).
            hands.push(RotatedSquare { centre, side: long, angle }.moved(-0.5, 2.6));
        });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GEOMETRY: InputGeometry =
        InputGeometry { image_size: [384.0, 384.0], scale: [2.0, 2.0], offset: [0.0, 0.0] };

    #[test]
    fn anchors_are_mediapipes() {
        let Anchors(anchors) = Anchors::new();
        assert_eq!(anchors.len(), 2016);
        assert_eq!(anchors[0], [0.5 / 24.0, 0.5 / 24.0]);
        assert_eq!((anchors[1], anchors[2]), (anchors[0], [1.5 / 24.0, 0.5 / 24.0]));
        assert_eq!((anchors[1152], anchors[1158]), ([0.5 / 12.0, 0.5 / 12.0], [1.5 / 12.0, 0.5 / 12.0]));
        assert_eq!(anchors[2015], [11.5 / 12.0, 11.5 / 12.0]);
    }

    #[test]
    fn overlapping_palms_are_one_hand() {
        let (mut rows, mut logits) = (vec![0.0; 2016 * ROW], vec![-20.0; 2016]);
        // Two anchors of one cell detect a palm of 20 pixels with its fingers to the right.
        for index in [1152, 1153] {
            logits[index] = 3.0;
            rows[index * ROW..][..10].copy_from_slice(&[4.0, 0.0, 20.0, 20.0, 0.0, 0.0, 0.0, 0.0, 10.0, 0.0]);
        }
        // Palms that are not finite are dropped.
        logits[5] = 9.0;
        rows[5 * ROW] = f32::NAN;
        logits[6] = f32::NAN;
        let (mut hands, mut scratch) = (Vec::new(), PalmScratch::default());
        let mut decode = |rows: &[f32], logits: &[f32]| {
            Anchors::new().decode([rows, logits], 192, &GEOMETRY, [0.5, 0.3], &mut scratch, &mut hands)
        };
        decode(&rows, &logits).unwrap();
        assert!(decode(&rows[1..], &logits).is_err() && decode(&rows, &logits[1..]).is_err());
        let [hand] = hands[..] else { panic!("{hands:?}") };
        assert!((hand.side - 2.6 * 40.0).abs() < 1e-3, "{hand:?}");
        assert!((hand.angle - std::f32::consts::FRAC_PI_2).abs() < 1e-5);
        // The centre of the palm, (12, 8) in the input, then half its height along the fingers.
        assert!((hand.centre[0] - 44.0).abs() < 1e-3 && (hand.centre[1] - 16.0).abs() < 1e-3, "{hand:?}");
    }
}
