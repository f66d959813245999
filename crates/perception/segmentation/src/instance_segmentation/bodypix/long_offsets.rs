//! Assignment of pixels to persons by long offsets, which point from a pixel to the joints of its person.
//!
//! Papandreou et al., PersonLab, ECCV 2018, section 3.3.

use opendr_engine::target::Keypoint;
use opendr_perception_common::part_tree::Person;

const JOINTS: usize = 17;
/// Number of refinements of a joint position by the offset at its own cell.
const REFINEMENTS: usize = 2;
/// Minimum score of a joint.
const LEAST_SCORE: f32 = 0.3;

/// Long offsets on a grid of cells, in pixels of the network's input.
#[derive(Clone, Copy)]
pub(super) struct LongOffsets<'a> {
    /// Rows and columns of cells.
    pub grid: [usize; 2],
    /// Distance of cells in pixels.
    pub stride: f32,
    /// Offsets `[rows, columns, 34]`, 17 y then 17 x, from a cell to the joints of its person.
    pub values: &'a [f32],
}

impl LongOffsets<'_> {
    /// Returns the index of the person to which the place belongs; `None` without a person that has known joints.
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

    /// Returns the position of a joint that the offsets at a place point to.
    fn joint(&self, [x, y]: [f32; 2], joint: usize) -> [f32; 2] {
        let [across, down] = self.offset(self.cell_at([x, y]), joint);
        let mut predicted = [x + across, y + down];
        for _ in 0..REFINEMENTS {
            let cell = self.cell_at(predicted);
            let [across, down] = self.offset(cell, joint);
            predicted = [cell[1] as f32 * self.stride + across, cell[0] as f32 * self.stride + down];
        }
        predicted
    }

    fn offset(&self, [row, column]: [usize; 2], joint: usize) -> [f32; 2] {
        let cell = &self.values[(row * self.grid[1] + column) * 2 * JOINTS..][..2 * JOINTS];
        [cell[JOINTS + joint], cell[joint]]
    }

    /// Returns the cell nearest to a point; the first for NaN.
    fn cell_at(&self, [x, y]: [f32; 2]) -> [usize; 2] {
        let nearest = |at: f32, count: usize| ((at / self.stride).round().max(0.0) as usize).min(count - 1);
        [nearest(y, self.grid[0]), nearest(x, self.grid[1])]
    }
}

/// Returns the mean squared distance over the known joints; infinite without any.
fn distance(predicted: &[[f32; 2]; JOINTS], joints: &[Keypoint; JOINTS]) -> f32 {
    let (mut sum, mut count) = (0.0, 0.0);
    for ([x, y], joint) in predicted.iter().zip(joints) {
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

    /// Returns offsets that point at a person at x = 32 in the left half of the grid, and at one at x = 128 in the right half.
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
    fn each_half_is_assigned_to_its_person() {
        let values = offsets();
        let offsets = LongOffsets { grid: [11, 11], stride: 16.0, values: &values };
        let persons = [person(32.0), person(128.0)];
        assert_eq!(offsets.owner([70.0, 30.0], &persons), Some(0));
        assert_eq!(offsets.owner([100.0, 150.0], &persons), Some(1));
        assert_eq!(offsets.owner([100.0, 150.0], &persons[..1]), Some(0));
        assert_eq!(offsets.owner([100.0, 150.0], &[]), None);
    }

    #[test]
    fn invalid_offsets_are_assigned_to_no_person() {
        let values = vec![f32::NAN; 11 * 11 * 34];
        let offsets = LongOffsets { grid: [11, 11], stride: 16.0, values: &values };
        assert_eq!(offsets.owner([1.0, 1.0], &[person(1.0), person(2.0)]), None);
        let values = vec![f32::INFINITY; 11 * 11 * 34];
        let offsets = LongOffsets { grid: [11, 11], stride: 16.0, values: &values };
        assert_eq!(offsets.owner([f32::MAX, -5.0], &[person(1.0), person(2.0)]), None);
    }
}
