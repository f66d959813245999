//! Valid boxes of a detector's list.

use opendr_engine::target::BoundingBoxList;

/// Maximum number of boxes per frame, by score, and of tracks. More are noise, and time grows with their product.
pub const MAX_BOXES: usize = 1000;

/// A valid box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValidBox {
    /// Corners `[x0, y0, x1, y1]`, finite, with x1 > x0 and y1 > y0.
    pub corners: [f64; 4],
    /// Score.
    pub confidence: f64,
    /// Index in the list.
    pub index: usize,
}

/// Fills `valid` with the boxes of a list that have at least the score `threshold`, are finite and have an area, in the
/// order of the list; of more than [`MAX_BOXES`], those with the highest scores.
pub fn valid_boxes(list: &BoundingBoxList, threshold: f64, valid: &mut Vec<ValidBox>) {
    valid.clear();
    valid.extend(list.boxes.iter().enumerate().filter_map(|(index, found)| {
        let [left, top, width, height] = [found.left, found.top, found.width, found.height].map(f64::from);
        let corners = [left, top, left + width, top + height];
        let confidence = f64::from(found.confidence);
        let has_area = corners[2] > corners[0] && corners[3] > corners[1];
        let is_valid = has_area && corners.iter().all(|edge| edge.is_finite()) && confidence >= threshold;
        is_valid.then_some(ValidBox { corners, confidence, index })
    }));
    if valid.len() > MAX_BOXES {
        let best_first =
            |a: &ValidBox, b: &ValidBox| b.confidence.total_cmp(&a.confidence).then(a.index.cmp(&b.index));
        valid.select_nth_unstable_by(MAX_BOXES, best_first);
        valid.truncate(MAX_BOXES);
        valid.sort_unstable_by_key(|found| found.index);
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::BoundingBox;

    use super::*;

    #[test]
    fn invalid_boxes_are_dropped() {
        let rows = [
            [0.0, 0.0, 5.0, 5.0, 0.9],
            [f32::NAN, 0.0, 5.0, 5.0, 0.9],
            [0.0, f32::INFINITY, 5.0, 5.0, 0.9],
            [0.0, 0.0, -5.0, 5.0, 0.9],
            [0.0, 0.0, 5.0, 0.0, 0.9],
            [0.0, 0.0, 5.0, f32::NAN, 0.9],
            [0.0, 0.0, 5.0, 5.0, f32::NAN],
            [0.0, 0.0, 5.0, 5.0, 0.2],
            [1e30, 0.0, 1.0, 1.0, 0.9],
            [1.0, 2.0, 3.0, 4.0, 0.5],
        ];
        let boxes = rows
            .map(|[left, top, width, height, score]| BoundingBox::new(0, left, top, width, height, score));
        let mut valid = Vec::new();
        valid_boxes(&boxes.to_vec().into(), 0.3, &mut valid);
        assert_eq!(valid.iter().map(|found| found.index).collect::<Vec<_>>(), [0, 9]);
        assert_eq!(valid[1].corners, [1.0, 2.0, 4.0, 6.0]);
    }

    #[test]
    fn of_many_the_best_are_kept_in_their_order() {
        let boxes =
            (0..5000).map(|at| BoundingBox::new(0, at as f32, 0.0, 1.0, 1.0, (at % 10) as f32 / 10.0));
        let mut valid = Vec::new();
        valid_boxes(&boxes.collect::<Vec<_>>().into(), 0.0, &mut valid);
        assert_eq!(valid.len(), MAX_BOXES);
        assert!(valid.is_sorted_by_key(|found| found.index));
        assert!(valid.iter().all(|found| found.index % 10 >= 8));
    }
}
