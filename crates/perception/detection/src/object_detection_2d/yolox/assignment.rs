//! Assignment of cells to objects by the cost of their predictions: SimOTA (Ge et al., YOLOX, section 2.3; Ge et al., OTA: Optimal
//! transport assignment for object detection, CVPR 2021).

use super::network::BOX_VALUES;
use crate::object_detection_2d::ground_truth::{GroundTruthBox, iou};

/// Half of the side of the square around an object's centre whose cells are candidates, in strides.
const CENTRE_RADIUS: f32 = 2.5;
/// Number of candidates whose IoUs sum to the number of cells of an object.
const TOP: usize = 10;
/// Weight of the boxes in the cost.
const BOX_WEIGHT: f32 = 3.0;
/// Cost of a cell that is not both in the box and near its centre.
const OUTSIDE: f32 = 1e5;
/// Smallest logarithm of a probability.
const LEAST_LOG: f32 = -100.0;

/// A cell of the grids.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Column and row within its level.
    pub place: [f32; 2],
    /// Stride of its level, in pixels.
    pub stride: f32,
}

/// A cell that is assigned to an object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Positive {
    /// Index of the cell: level by level, fine to coarse, row by row.
    pub cell: usize,
    /// Index of the object.
    pub object: usize,
    /// IoU of the predicted box and the object.
    pub iou: f32,
}

/// Returns the cells of all levels of a square input of `side` pixels.
pub fn grid(side: usize, strides: &[usize]) -> Vec<Cell> {
    let level = |stride: &usize| {
        let (columns, stride) = (side / stride, *stride as f32);
        (0..columns * columns)
            .map(move |cell| Cell { place: [(cell % columns) as f32, (cell / columns) as f32], stride })
    };
    strides.iter().flat_map(level).collect()
}

impl Cell {
    /// Returns the centre of the cell, in pixels.
    pub fn centre(&self) -> [f32; 2] {
        self.place.map(|place| (place + 0.5) * self.stride)
    }

    /// Returns the corners of the box predicted by the first four values of `row`, in pixels.
    fn decode(&self, row: &[f32]) -> [f32; 4] {
        let x = (row[0] + self.place[0]) * self.stride;
        let y = (row[1] + self.place[1]) * self.stride;
        let (half_width, half_height) = (row[2].exp() * self.stride / 2.0, row[3].exp() * self.stride / 2.0);
        [x - half_width, y - half_height, x + half_width, y + half_height]
    }

    /// Returns whether the centre is in the box, and whether it is near the box's centre.
    fn is_within(&self, [x0, y0, x1, y1]: [f32; 4]) -> (bool, bool) {
        let [x, y] = self.centre();
        let radius = CENTRE_RADIUS * self.stride;
        let is_near = (x - (x0 + x1) / 2.0).abs() < radius && (y - (y0 + y1) / 2.0).abs() < radius;
        (contains([x0, y0, x1, y1], [x, y]), is_near)
    }
}

/// Returns whether a point is in a box.
pub fn contains([x0, y0, x1, y1]: [f32; 4], [x, y]: [f32; 2]) -> bool {
    x > x0 && x < x1 && y > y0 && y < y1
}

/// A cell that is in a box or near the centre of one.
struct Candidate<'a> {
    cell: usize,
    row: &'a [f32],
    corners: [f32; 4],
    /// Sum over the classes of `ln(1 - score)`.
    none: f32,
}

impl Candidate<'_> {
    /// Returns the score of a class, the geometric mean of its probability and the objectness.
    fn score(&self, class: usize) -> f32 {
        (sigmoid(self.row[BOX_VALUES + class]) * sigmoid(self.row[BOX_VALUES - 1])).sqrt()
    }

    /// Returns the cross-entropy of the scores with the object's class, plus that of the box.
    fn cost(&self, object: &GroundTruthBox, iou: f32, is_inside: bool) -> f32 {
        let score = self.score(object.class);
        let entropy = -log(score) - (self.none - log(1.0 - score));
        let outside = if is_inside { 0.0 } else { OUTSIDE };
        entropy - BOX_WEIGHT * (iou + 1e-8).ln() + outside
    }
}

/// Assigns cells to the objects of an image, in the order of the cells. `rows` has one row `[x, y, ln width, ln height,
/// objectness, classes...]` of logits per cell. A cell wanted by several objects is assigned to the one of least cost.
pub fn positives(cells: &[Cell], rows: &[f32], objects: &[GroundTruthBox]) -> Vec<Positive> {
    let fields = rows.len().checked_div(cells.len()).unwrap_or_default();
    if objects.is_empty() || fields <= BOX_VALUES {
        return Vec::new();
    }
    let candidates = candidates(cells, rows, fields, objects);
    let count = candidates.len();
    let (mut costs, mut ious) = (Vec::with_capacity(count * objects.len()), Vec::new());
    for object in objects {
        for candidate in &candidates {
            let overlap = iou(candidate.corners, object.corners);
            let (is_in_box, is_near) = cells[candidate.cell].is_within(object.corners);
            costs.push(candidate.cost(object, overlap, is_in_box && is_near));
            ious.push(overlap);
        }
    }
    // Number of objects that want each candidate, and the last of them.
    let mut wanted: Vec<(usize, usize)> = vec![(0, 0); count];
    for index in 0..objects.len() {
        let (costs, ious) = (&costs[index * count..][..count], &ious[index * count..][..count]);
        for candidate in cheapest(costs, cells_wanted(ious)) {
            wanted[candidate] = (wanted[candidate].0 + 1, index);
        }
    }
    let assigned = wanted.into_iter().enumerate().filter(|(_, (times, _))| *times > 0);
    let positive = |(candidate, (times, object)): (usize, (usize, usize))| {
        let cost = |object: &usize| costs[object * count + candidate];
        let least = || (0..objects.len()).min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let object = if times > 1 { least().unwrap_or(object) } else { object };
        Positive { cell: candidates[candidate].cell, object, iou: ious[object * count + candidate] }
    };
    assigned.map(positive).collect()
}

fn candidates<'a>(
    cells: &[Cell],
    rows: &'a [f32],
    fields: usize,
    objects: &[GroundTruthBox],
) -> Vec<Candidate<'a>> {
    let mut candidates = Vec::new();
    for (index, (cell, row)) in cells.iter().zip(rows.chunks_exact(fields)).enumerate() {
        let is_candidate = |object: &GroundTruthBox| {
            let (is_in_box, is_near) = cell.is_within(object.corners);
            is_in_box || is_near
        };
        if objects.iter().any(is_candidate) {
            let mut candidate = Candidate { cell: index, row, corners: cell.decode(row), none: 0.0 };
            candidate.none = (0..fields - BOX_VALUES).map(|class| log(1.0 - candidate.score(class))).sum();
            candidates.push(candidate);
        }
    }
    candidates
}

/// Returns the number of cells of an object: the sum of its best IoUs, at least one.
fn cells_wanted(ious: &[f32]) -> usize {
    let mut best: Vec<f32> = ious.to_vec();
    best.sort_by(|a, b| b.total_cmp(a));
    (best.iter().take(TOP).sum::<f32>() as usize).clamp(1, TOP)
}

/// Returns the indices of the `count` least costs.
fn cheapest(costs: &[f32], count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..costs.len()).collect();
    order.sort_by(|a, b| costs[*a].total_cmp(&costs[*b]).then(a.cmp(b)));
    order.truncate(count);
    order
}

fn sigmoid(logit: f32) -> f32 {
    1.0 / (1.0 + (-logit).exp())
}

fn log(probability: f32) -> f32 {
    probability.ln().max(LEAST_LOG)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLASSES: usize = 3;

    fn cells() -> Vec<Cell> {
        grid(64, &[8, 16, 32])
    }

    /// Rows that predict boxes of one stride around each cell's centre, with equal scores.
    fn rows(cells: &[Cell]) -> Vec<f32> {
        cells.iter().flat_map(|_| [0.5, 0.5, 0.0, 0.0, -2.0, -2.0, -2.0, -2.0]).collect()
    }

    fn object(class: usize, corners: [f32; 4]) -> GroundTruthBox {
        GroundTruthBox { class, corners }
    }

    #[test]
    fn the_grid_covers_every_level() {
        let cells = cells();
        assert_eq!(cells.len(), 64 + 16 + 4);
        assert_eq!(
            (cells[9].centre(), cells[64].centre(), cells[83].centre()),
            ([12.0, 12.0], [8.0; 2], [48.0; 2])
        );
    }

    #[test]
    fn the_cell_with_the_best_box_is_assigned() {
        let cells = cells();
        let mut rows = rows(&cells);
        // Cell (1, 1) of stride 16 predicts exactly the object.
        let exact = 64 + 5;
        let fields = BOX_VALUES + CLASSES;
        rows[exact * fields..][..4].copy_from_slice(&[0.5, 0.5, 0.75f32.ln(), 1.25f32.ln()]);
        let [x, y] = cells[exact].centre();
        let found = positives(&cells, &rows, &[object(1, [x - 6.0, y - 10.0, x + 6.0, y + 10.0])]);
        let best = found.iter().max_by(|a, b| a.iou.total_cmp(&b.iou)).unwrap();
        assert_eq!((best.cell, best.object), (exact, 0));
        assert!((best.iou - 1.0).abs() < 1e-5, "{found:?}");
    }

    #[test]
    fn better_predictions_get_more_cells() {
        let cells = cells();
        let corners = [8.0, 8.0, 40.0, 40.0];
        let poor = positives(&cells, &rows(&cells), &[object(0, corners)]).len();
        let fields = BOX_VALUES + CLASSES;
        let mut good = rows(&cells);
        for (cell, row) in cells.iter().zip(good.chunks_exact_mut(fields)) {
            let centre = [24.0 / cell.stride - cell.place[0], 24.0 / cell.stride - cell.place[1]];
            row[..4].copy_from_slice(&[
                centre[0],
                centre[1],
                (32.0 / cell.stride).ln(),
                (32.0 / cell.stride).ln(),
            ]);
        }
        let good = positives(&cells, &good, &[object(0, corners)]);
        assert_eq!(good.len(), TOP);
        assert!(poor < TOP, "{poor}");
    }

    #[test]
    fn a_cell_has_one_object_and_the_class_decides_between_equals() {
        let cells = cells();
        let mut rows = rows(&cells);
        for row in rows.chunks_exact_mut(BOX_VALUES + CLASSES) {
            row[BOX_VALUES + 2] = 4.0;
        }
        let corners = [16.0, 16.0, 32.0, 32.0];
        let found = positives(&cells, &rows, &[object(0, corners), object(2, corners)]);
        assert!(!found.is_empty() && found.iter().all(|positive| positive.object == 1), "{found:?}");
    }

    #[test]
    fn images_without_objects_and_wild_predictions_are_no_error() {
        let cells = cells();
        assert!(positives(&cells, &rows(&cells), &[]).is_empty());
        let wild = vec![f32::NAN; cells.len() * (BOX_VALUES + CLASSES)];
        let far = object(0, [900.0, 900.0, 910.0, 910.0]);
        assert!(positives(&cells, &wild, &[far]).is_empty());
        assert!(positives(&cells, &wild, &[object(0, [0.0, 0.0, 30.0, 30.0])]).len() <= TOP);
    }
}
