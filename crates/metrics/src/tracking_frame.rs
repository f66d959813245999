//! One frame of a video for tracking metrics: identities of objects and tracks, and their overlaps.

use std::collections::HashSet;

use opendr_engine::overlap::box_iou;
use opendr_engine::target::TrackingAnnotationList;
use opendr_engine::{Error, Result};

/// Identities in one frame and the overlap of every pair.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TrackingFrame {
    ground_truth: Vec<i64>,
    found: Vec<i64>,
    overlaps: Vec<f64>,
}

impl TrackingFrame {
    /// Maximum number of pairs per frame, which bounds the memory for hostile lists.
    pub(crate) const MOST_PAIRS: usize = 1 << 22;

    /// Creates a frame from identities and `overlaps`, `[ground truth, found]` in row-major order, each 0 to 1.
    ///
    /// # Errors
    /// Returns `InvalidInput` if an identity occurs twice in `ground_truth` or in `found`, if there is not one overlap per pair,
    /// or if an overlap is outside 0..=1.
    pub fn new(ground_truth: Vec<i64>, found: Vec<i64>, overlaps: Vec<f64>) -> Result<Self> {
        check_identities("the ground truth", &ground_truth)?;
        check_identities("the prediction", &found)?;
        check_pairs(ground_truth.len(), found.len())?;
        if overlaps.len() != ground_truth.len() * found.len() {
            return Err(Error::invalid_input(format!(
                "{} overlaps for {} true and {} predicted objects; give one for every pair",
                overlaps.len(),
                ground_truth.len(),
                found.len()
            )));
        }
        if let Some(wrong) = overlaps.iter().find(|overlap| !(0.0..=1.0).contains(*overlap)) {
            return Err(Error::invalid_input(format!("an overlap is {wrong}; give numbers from 0 to 1")));
        }
        Ok(Self { ground_truth, found, overlaps })
    }

    /// Creates a frame from identities and corners `[x0, y0, x1, y1]`; the overlap is the intersection over union.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a box that is not finite; otherwise as [`TrackingFrame::new`].
    pub fn from_boxes(ground_truth: &[(i64, [f64; 4])], found: &[(i64, [f64; 4])]) -> Result<Self> {
        check_boxes("the ground truth", ground_truth)?;
        check_boxes("the prediction", found)?;
        check_pairs(ground_truth.len(), found.len())?;
        let overlaps = ground_truth
            .iter()
            .flat_map(|(_, ground_truth)| found.iter().map(|(_, found)| box_iou(*ground_truth, *found)))
            .collect();
        let identities = |boxes: &[(i64, [f64; 4])]| boxes.iter().map(|(id, _)| *id).collect();
        Self::new(identities(ground_truth), identities(found), overlaps)
    }

    /// Creates a frame from the lists of a tracker and of the ground truth; classes are ignored.
    ///
    /// # Errors
    /// As [`TrackingFrame::from_boxes`].
    pub fn from_lists(found: &TrackingAnnotationList, ground_truth: &TrackingAnnotationList) -> Result<Self> {
        Self::from_boxes(&boxes_from_list(ground_truth), &boxes_from_list(found))
    }

    /// Returns the identities of the ground truth.
    pub fn ground_truth(&self) -> &[i64] {
        &self.ground_truth
    }

    /// Returns the identities of the prediction.
    pub fn predictions(&self) -> &[i64] {
        &self.found
    }

    /// Returns the overlaps, `[ground truth, found]` in row-major order.
    pub fn overlaps(&self) -> &[f64] {
        &self.overlaps
    }

    /// Returns the overlap of object `ground_truth` and track `found`, by their indices in the frame.
    pub(crate) fn overlap(&self, ground_truth: usize, found: usize) -> f64 {
        self.overlaps[ground_truth * self.found.len() + found]
    }

    /// Returns the frame with the objects and tracks whose flags are set.
    pub(crate) fn keep(&self, ground_truth: &[bool], found: &[bool]) -> Self {
        let kept = |mask: &[bool]| (0..mask.len()).filter(|at| mask[*at]).collect::<Vec<_>>();
        let (ground_truth, found) = (kept(ground_truth), kept(found));
        Self {
            overlaps: ground_truth
                .iter()
                .flat_map(|row| found.iter().map(|at| self.overlap(*row, *at)))
                .collect(),
            ground_truth: ground_truth.into_iter().map(|at| self.ground_truth[at]).collect(),
            found: found.into_iter().map(|at| self.found[at]).collect(),
        }
    }

    /// Returns how well the boxes overlap regardless of identities, 0 to 1.
    pub(crate) fn coverage(&self) -> f64 {
        let width = self.found.len();
        let mut best = (vec![0.0f64; self.ground_truth.len()], vec![0.0f64; width]);
        for (at, overlap) in self.overlaps.iter().enumerate() {
            best.0[at / width] = best.0[at / width].max(*overlap);
            best.1[at % width] = best.1[at % width].max(*overlap);
        }
        let hits = best.0.iter().sum::<f64>().min(best.1.iter().sum());
        match (self.ground_truth.len() + width) as f64 - hits {
            union if union > 0.0 => hits / union,
            _ => 1.0,
        }
    }
}

fn boxes_from_list(list: &TrackingAnnotationList) -> Vec<(i64, [f64; 4])> {
    let corners = |left: f32, top: f32, width: f32, height: f32| {
        let [left, top, width, height] = [left, top, width, height].map(f64::from);
        [left, top, left + width, top + height]
    };
    list.annotations
        .iter()
        .map(|track| {
            let place = &track.bounding_box;
            (track.id, corners(place.left, place.top, place.width, place.height))
        })
        .collect()
}

fn check_identities(what: &str, identities: &[i64]) -> Result<()> {
    let mut unique = HashSet::with_capacity(identities.len());
    match identities.iter().find(|id| !unique.insert(**id)) {
        Some(id) => Err(Error::invalid_input(format!(
            "two objects of {what} have id {id} in one frame; give every object its own id"
        ))),
        None => Ok(()),
    }
}

fn check_boxes(what: &str, boxes: &[(i64, [f64; 4])]) -> Result<()> {
    match boxes.iter().find(|(_, corners)| corners.iter().any(|corner| !corner.is_finite())) {
        Some((id, corners)) => Err(Error::invalid_input(format!(
            "object {id} of {what} has corners {corners:?}; give finite numbers"
        ))),
        None => Ok(()),
    }
}

fn check_pairs(ground_truth: usize, found: usize) -> Result<()> {
    match ground_truth.checked_mul(found) {
        Some(pairs) if pairs <= TrackingFrame::MOST_PAIRS => Ok(()),
        _ => Err(Error::invalid_input(format!(
            "{ground_truth} true and {found} predicted objects in one frame are more than {} pairs; give fewer",
            TrackingFrame::MOST_PAIRS
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_and_coverage() {
        let ground_truth = [(1, [0.0, 0.0, 2.0, 2.0]), (2, [10.0, 0.0, 12.0, 2.0])];
        let found = [(7, [0.0, 1.0, 2.0, 3.0]), (8, [10.0, 0.0, 12.0, 2.0]), (9, [50.0, 0.0, 51.0, 1.0])];
        let frame = TrackingFrame::from_boxes(&ground_truth, &found).unwrap();
        assert_eq!(frame.overlaps(), [1.0 / 3.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let hits = 4.0 / 3.0;
        assert_eq!(frame.coverage(), hits / (5.0 - hits));
        let kept = frame.keep(&[false, true], &[true, true, false]);
        assert_eq!(kept, TrackingFrame::new(vec![2], vec![7, 8], vec![0.0, 1.0]).unwrap());
        assert_eq!(TrackingFrame::default().coverage(), 1.0);
    }

    #[test]
    fn invalid_frames_are_rejected() {
        let here = [0.0, 0.0, 1.0, 1.0];
        assert!(TrackingFrame::from_boxes(&[(1, here), (1, here)], &[]).is_err());
        assert!(TrackingFrame::from_boxes(&[], &[(-1, here), (-1, here)]).is_err());
        assert!(TrackingFrame::from_boxes(&[(1, [0.0, f64::NAN, 1.0, 1.0])], &[]).is_err());
        assert!(TrackingFrame::new(vec![1], vec![1], vec![]).is_err());
        assert!(TrackingFrame::new(vec![1], vec![1], vec![1.5]).is_err());
        let many: Vec<_> = (0..5000).map(|id| (id, here)).collect();
        assert!(TrackingFrame::from_boxes(&many, &many).unwrap_err().to_string().contains("pairs"));
    }
}
