//! Which person a pixel belongs to: the one whose joints its long offsets point at.
//!
//! Papandreou et al., PersonLab, ECCV 2018, section 3.3.

use opendr_engine::target::Keypoint;
use opendr_perception_common::part_tree::Person;

const JOINTS: usize = 17;
/// How often a place is pulled to where its own cell points.
const REFINEMENTS: usize = 2;
/// Joints of a person below this score do not count.
const LEAST_SCORE: f32 = 0.3;

/// Long offsets over a grid of cells, in pixels of the network's input.
#[derive(Clone, Copy)]
pub(super) struct LongOffsets<'a> {
    /// Cells down and across.
    pub grid: [usize; 2],
    /// Pixels from cell to cell.
    pub stride: f32,
    /// `[rows, columns, 34]`: 17 y, 17 x, from a cell to the joints of its person.
    pub values: &'a [f32],
}

impl LongOffsets<'_> {
    /// Which of the persons the place belongs to; `None` when there is none, or none whose joints are known.
    pub fn owner(&self, place: [f32; 2], persons: &[Person]) -> Option<usize> {
        if persons.len() < 2 {
            return (!persons.is_empty()).then_some(0);
        }
        let joints: [[f32; 2]; JOINTS] = std::array::from_fn(|joint| self.joint(place, joint));
        let mut best = (f32::INFINITY, None);
        for (number, person) in persons.iter().enumerate() {
            let distance = distance(&joints, &person.joints);
            if distance < best.0 {
                best = (distance, Some(number));
            }
        }
        best.1
    }

    /// Where the place sees a joint of its person.
    fn joint(&self, [x, y]: [f32; 2], joint: usize) -> [f32; 2] {
        let [across, down] = self.offset(self.cell_at([x, y]), joint);
        let mut seen = [x + across, y + down];
        for _ in 0..REFINEMENTS {
            let cell = self.cell_at(seen);
            let [across, down] = self.offset(cell, joint);
            seen = [cell[1] as f32 * self.stride + across, cell[0] as f32 * self.stride + down];
        }
        seen
    }

    fn offset(&self, [row, column]: [usize; 2], joint: usize) -> [f32; 2] {
        let cell = &self.values[(row * self.grid[1] + column) * 2 * JOINTS..][..2 * JOINTS];
        [cell[JOINTS + joint], cell[joint]]
    }

    /// The cell nearest to a point; NaN goes to the first.
    fn cell_at(&self, [x, y]: [f32; 2]) -> [usize; 2] {
        let nearest = |at: f32, count: usize| ((at / self.stride).round().max(0.0) as usize).min(count - 1);
        [nearest(y, self.grid[0]), nearest(x, self.grid[1])]
    }
}

/// Mean squared distance over the joints that are known; infinite without any.
fn distance(seen: &[[f32; 2]; JOINTS], joints: &[Keypoint; JOINTS]) -> f32 {
    let (mut sum, mut count) = (0.0, 0.0);
    for ([x, y], joint) in seen.iter().zip(joints) {
        if joint.confidence > LEAST_SCORE {
            sum += (x - joint.x).powi(2) + (y - joint.y).powi(2);
            count += 1.0;
        }
    }
    if count > 0.0 { sum / count } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn person(x: f32) -> Person {
        let joint = |joint: usize| Keypoint { x, y: 4.0 * joint as f32, confidence: 0.9 };
        Person { joints: std::array::from_fn(joint), score: 0.9 }
    }

    /// The left half of the grid points at a person at x = 32, the right half at one at x = 128.
    fn offsets() -> Vec<f32> {
        let mut values = Vec::new();
        for row in 0..11 {
            for column in 0..11 {
                let target = if column < 6 { 32.0 } else { 128.0 };
                values.extend((0..JOINTS).map(|joint| 4.0 * joint as f32 - 16.0 * row as f32));
                values.extend([target - 16.0 * column as f32; JOINTS]);
            }
        }
        values
    }

    #[test]
    fn each_half_goes_to_its_person() {
        let values = offsets();
        let offsets = LongOffsets { grid: [11, 11], stride: 16.0, values: &values };
        let persons = [person(32.0), person(128.0)];
        assert_eq!(offsets.owner([70.0, 30.0], &persons), Some(0));
        assert_eq!(offsets.owner([100.0, 150.0], &persons), Some(1));
        assert_eq!(offsets.owner([100.0, 150.0], &persons[..1]), Some(0));
        assert_eq!(offsets.owner([100.0, 150.0], &[]), None);
    }

    #[test]
    fn nonsense_belongs_to_nobody() {
        let values = vec![f32::NAN; 11 * 11 * 34];
        let offsets = LongOffsets { grid: [11, 11], stride: 16.0, values: &values };
        assert_eq!(offsets.owner([1.0, 1.0], &[person(1.0), person(2.0)]), None);
        let values = vec![f32::INFINITY; 11 * 11 * 34];
        let offsets = LongOffsets { grid: [11, 11], stride: 16.0, values: &values };
        assert_eq!(offsets.owner([f32::MAX, -5.0], &[person(1.0), person(2.0)]), None);
    }
}
