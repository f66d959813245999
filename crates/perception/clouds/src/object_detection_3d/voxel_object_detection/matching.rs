//! Assignment of ground truth to anchors.

use opendr_engine::overlap::box_iou;
use opendr_engine::target::LidarBox;

use super::coding::nearest_upright;
use super::layout::PillarLayout;

/// Training target of an anchor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AnchorTarget {
    /// Background.
    Background,
    /// The object with this index.
    Object(usize),
    /// Ignored in the loss.
    Ignored,
}

/// IoU from which an anchor is assigned to an object, and from which it is ignored. Both are below the paper's 0.6 and 0.45, as
/// cells are coarse: a car is as wide as two of them.
const OBJECT: f64 = 0.45;
const ANYTHING: f64 = 0.3;

/// An annotated object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundTruth {
    /// Position, size and yaw in the lidar's frame.
    pub place: LidarBox,
    /// Class index; `None` for an ignored object.
    pub class: Option<usize>,
}

/// Returns the training target of each anchor: anchor by anchor, row-major.
///
/// The IoU is that of the nearest axis-aligned rectangles on the ground, as in SECOND; every object is assigned at least the
/// anchor with the highest IoU.
pub fn assign_anchors(layout: &PillarLayout, ground_truths: &[GroundTruth]) -> Vec<AnchorTarget> {
    let [columns, rows] = layout.maps();
    let cells = columns * rows;
    let mut wanted = vec![AnchorTarget::Background; layout.anchors.len() * cells];
    let mut best = vec![0.0; wanted.len()];
    let mut forced = Vec::new();
    for (number, ground_truth) in ground_truths.iter().enumerate() {
        let around = corners(ground_truth.place.center, nearest_upright(&ground_truth.place));
        let mut own = (0.0, None);
        for (kind, anchor) in layout.anchors.iter().enumerate() {
            if ground_truth.class.is_some_and(|class| class != anchor.class) {
                continue;
            }
            let sides = nearest_upright(&anchor.at([0.0; 2]));
            for (column, row) in near(layout, around, sides) {
                let [x, y] = layout.middle(column, row).map(f64::from);
                let overlap = box_iou(around, corners([x, y, 0.0], sides));
                let at = kind * cells + row * columns + column;
                if ground_truth.class.is_none() {
                    if overlap >= ANYTHING && wanted[at] == AnchorTarget::Background {
                        wanted[at] = AnchorTarget::Ignored;
                    }
                    continue;
                }
                if overlap > own.0 {
                    own = (overlap, Some(at));
                }
                if overlap > best[at] && overlap >= ANYTHING {
                    best[at] = overlap;
                    wanted[at] =
                        if overlap >= OBJECT { AnchorTarget::Object(number) } else { AnchorTarget::Ignored };
                }
            }
        }
        forced.extend(own.1.map(|at| (at, number)));
    }
    for (at, number) in forced {
        wanted[at] = AnchorTarget::Object(number);
    }
    wanted
}

/// Returns `[x0, y0, x1, y1]`.
fn corners([x, y, _]: [f64; 3], [along, across]: [f64; 2]) -> [f64; 4] {
    [x - along / 2.0, y - across / 2.0, x + along / 2.0, y + across / 2.0]
}

/// Returns the columns and rows whose anchors may overlap a box.
fn near(
    layout: &PillarLayout,
    [x0, y0, x1, y1]: [f64; 4],
    [along, across]: [f64; 2],
) -> impl Iterator<Item = (usize, usize)> {
    let side = f64::from(layout.grid.side) * layout.stride as f64;
    let [columns, rows] = layout.maps();
    let cells = |from: f64, to: f64, origin: f32, count: usize| {
        let at = |place: f64| ((place - f64::from(origin)) / side).clamp(0.0, count as f64) as usize;
        at(from)..(at(to) + 1).min(count)
    };
    let columns = cells(x0 - along / 2.0, x1 + along / 2.0, layout.grid.x[0], columns);
    let rows = cells(y0 - across / 2.0, y1 + across / 2.0, layout.grid.y[0], rows);
    rows.flat_map(move |row| columns.clone().map(move |column| (column, row)))
}

#[cfg(test)]
mod tests {
    use super::super::anchors::AnchorKind;
    use super::*;
    use crate::pillars::PillarGrid;

    fn layout() -> PillarLayout {
        let grid = PillarGrid { x: [0.0, 16.0], y: [-8.0, 8.0], z: [-3.0, 1.0], side: 0.5 };
        PillarLayout { grid, stride: 2, anchors: AnchorKind::of_class("Car", 0).unwrap().to_vec() }
    }

    fn car(x: f64, y: f64, yaw: f64, class: Option<usize>) -> GroundTruth {
        GroundTruth { place: LidarBox { center: [x, y, -1.7], size: [3.9, 1.6, 1.5], yaw }, class }
    }

    #[test]
    fn anchors_around_a_car_are_assigned_to_it() {
        // In the middle of column 5, row 8, along x.
        let wanted = assign_anchors(&layout(), &[car(5.5, 0.5, 3.1, Some(0))]);
        let objects: Vec<_> = (0..wanted.len()).filter(|at| wanted[*at] == AnchorTarget::Object(0)).collect();
        // One column aside: 2.9 of 4.9 metres, 0.59; one row aside: 0.6 of 2.6 metres.
        assert_eq!(objects, [8 * 16 + 4, 8 * 16 + 5, 8 * 16 + 6]);
        assert_eq!(wanted[8 * 16 + 7], AnchorTarget::Ignored);
        assert!(wanted[256..].iter().all(|wanted| *wanted != AnchorTarget::Object(0)));
    }

    #[test]
    fn every_object_has_an_anchor_and_ignored_objects_have_none() {
        let askew = assign_anchors(&layout(), &[car(5.9, 0.97, 0.7, Some(0))]);
        assert!(askew.contains(&AnchorTarget::Object(0)));
        let ignored = assign_anchors(&layout(), &[car(5.5, 0.5, 0.0, None)]);
        assert!(ignored.contains(&AnchorTarget::Ignored) && !ignored.contains(&AnchorTarget::Object(0)));
        let far = assign_anchors(&layout(), &[car(900.0, -900.0, 0.0, Some(0))]);
        assert!(far.iter().all(|wanted| *wanted == AnchorTarget::Background));
    }
}
