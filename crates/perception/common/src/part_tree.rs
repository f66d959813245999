//! Persons from heatmaps and displacements: PersonLab's fast greedy decoder.
//!
//! Papandreou et al., PersonLab, ECCV 2018, section 3.2, as in PoseNet: joints are peaks of heatmaps, refined by
//! short-range offsets. From the best free peak the other joints follow along a tree by mid-range displacements. The score
//! of a person counts only joints that no better person has.

use opendr_engine::target::Keypoint;

/// Edges of the tree over COCO's 17 joints: parent and child.
const EDGES: [[usize; 2]; 16] = [
    [0, 1],
    [1, 3],
    [0, 2],
    [2, 4],
    [0, 5],
    [5, 7],
    [7, 9],
    [5, 11],
    [11, 13],
    [13, 15],
    [0, 6],
    [6, 8],
    [8, 10],
    [6, 12],
    [12, 14],
    [14, 16],
];
const JOINTS: usize = 17;
/// Number of refinements of a displaced joint by the offset of its cell.
const REFINEMENTS: usize = 2;

/// Outputs of the network over a grid of cells, planar, in pixels of the network's input.
#[derive(Clone, Copy)]
pub struct PartMaps<'a> {
    /// Number of rows of cells.
    pub rows: usize,
    /// Number of columns of cells.
    pub columns: usize,
    /// Pixels per cell.
    pub stride: f32,
    /// Logits `[17, rows, columns]`.
    pub heatmap: &'a [f32],
    /// Short-range offsets `[34, rows, columns]`: 17 y, then 17 x.
    pub offsets: &'a [f32],
    /// Displacements from parent to child `[32, rows, columns]`: 16 y, then 16 x.
    pub forward: &'a [f32],
    /// Displacements from child to parent `[32, rows, columns]`: 16 y, then 16 x.
    pub backward: &'a [f32],
}

/// A person in pixels of the network's input. The confidence of a joint is the heatmap's score.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Person {
    /// COCO's 17 joints.
    pub joints: [Keypoint; JOINTS],
    /// Sum of the scores of the joints that no better person has, divided by 17.
    pub score: f32,
}

/// Settings of the decoder.
#[derive(Debug, Clone, Copy)]
pub struct PartTree {
    /// Score below which a peak starts no person, 0..=1.
    pub peak_threshold: f32,
    /// Distance within which joints of one kind belong to one person, in pixels of the network's input.
    pub radius: f32,
    /// Maximum number of persons.
    pub max_persons: usize,
}

/// A peak of one heatmap.
#[derive(Debug, Clone, Copy)]
pub struct Peak {
    score: f32,
    joint: usize,
    cell: [usize; 2],
}

impl PartTree {
    /// Fills `persons`, in the order of their start peaks' scores. `peaks` is work memory.
    pub fn decode(&self, maps: &PartMaps<'_>, peaks: &mut Vec<Peak>, persons: &mut Vec<Person>) {
        persons.clear();
        maps.find_peaks(self.peak_threshold, peaks);
        peaks.sort_unstable_by(|a, b| {
            b.score.total_cmp(&a.score).then(a.joint.cmp(&b.joint)).then(a.cell.cmp(&b.cell))
        });
        for peak in peaks.iter() {
            if persons.len() >= self.max_persons {
                break;
            }
            let start = maps.offset_point(peak.cell, peak.joint);
            if self.is_taken(persons, peak.joint, start) {
                continue;
            }
            let mut person = Person { joints: [Keypoint::MISSING; JOINTS], score: 0.0 };
            person.joints[peak.joint] = keypoint(start, peak.score);
            maps.grow(&mut person.joints);
            person.score = self.score(persons, &person.joints);
            persons.push(person);
        }
    }

    fn is_taken(&self, persons: &[Person], joint: usize, [x, y]: [f32; 2]) -> bool {
        persons.iter().any(|person| {
            let other = person.joints[joint];
            (other.x - x).powi(2) + (other.y - y).powi(2) <= self.radius * self.radius
        })
    }

    /// Returns the sum of the scores of the joints that no earlier person has, divided by the number of joints.
    fn score(&self, persons: &[Person], joints: &[Keypoint; JOINTS]) -> f32 {
        let free =
            joints.iter().enumerate().filter(|(joint, at)| !self.is_taken(persons, *joint, [at.x, at.y]));
        free.map(|(_, at)| at.confidence).sum::<f32>() / JOINTS as f32
    }
}

impl PartMaps<'_> {
    /// Finds the local maxima over 3x3 cells that reach the threshold.
    fn find_peaks(&self, threshold: f32, peaks: &mut Vec<Peak>) {
        peaks.clear();
        let logit = (threshold / (1.0 - threshold)).ln();
        for joint in 0..JOINTS {
            for row in 0..self.rows {
                for column in 0..self.columns {
                    let value = self.logit([row, column], joint);
                    if value >= logit && self.is_peak([row, column], joint, value) {
                        peaks.push(Peak { score: sigmoid(value), joint, cell: [row, column] });
                    }
                }
            }
        }
    }

    fn is_peak(&self, [row, column]: [usize; 2], joint: usize, value: f32) -> bool {
        let near = |at: usize, end: usize| at.saturating_sub(1)..=(at + 1).min(end - 1);
        near(row, self.rows)
            .all(|row| near(column, self.columns).all(|column| self.logit([row, column], joint) <= value))
    }

    /// Fills the joints from the one known joint along the tree: first up to the root, then down.
    fn grow(&self, joints: &mut [Keypoint; JOINTS]) {
        for (edge, [parent, child]) in EDGES.iter().copied().enumerate().rev() {
            self.step(joints, child, parent, edge, self.backward);
        }
        for (edge, [parent, child]) in EDGES.iter().copied().enumerate() {
            self.step(joints, parent, child, edge, self.forward);
        }
    }

    fn step(
        &self,
        joints: &mut [Keypoint; JOINTS],
        from: usize,
        to: usize,
        edge: usize,
        displacements: &[f32],
    ) {
        let source = joints[from];
        if source.confidence <= 0.0 || joints[to].confidence > 0.0 {
            return;
        }
        let cell = self.cell_at([source.x, source.y]);
        let [dx, dy] = self.vector(displacements, EDGES.len(), edge, cell);
        let mut target = [source.x + dx, source.y + dy];
        for _ in 0..REFINEMENTS {
            target = self.offset_point(self.cell_at(target), to);
        }
        let score = sigmoid(self.logit(self.cell_at(target), to));
        joints[to] = keypoint(target, score);
    }

    /// Returns the position `[x, y]` of the joint that the offset of the cell predicts.
    fn offset_point(&self, cell: [usize; 2], joint: usize) -> [f32; 2] {
        let [dx, dy] = self.vector(self.offsets, JOINTS, joint, cell);
        [cell[1] as f32 * self.stride + dx, cell[0] as f32 * self.stride + dy]
    }

    /// Returns `[x, y]` from maps with every y before every x.
    fn vector(&self, maps: &[f32], count: usize, at: usize, cell: [usize; 2]) -> [f32; 2] {
        [maps[self.index(count + at, cell)], maps[self.index(at, cell)]]
    }

    /// Returns the cell nearest to a point; NaN maps to cell 0.
    fn cell_at(&self, [x, y]: [f32; 2]) -> [usize; 2] {
        let nearest = |at: f32, count: usize| ((at / self.stride).round().max(0.0) as usize).min(count - 1);
        [nearest(y, self.rows), nearest(x, self.columns)]
    }

    fn index(&self, map: usize, [row, column]: [usize; 2]) -> usize {
        (map * self.rows + row) * self.columns + column
    }

    fn logit(&self, cell: [usize; 2], joint: usize) -> f32 {
        self.heatmap[self.index(joint, cell)]
    }
}

fn keypoint([x, y]: [f32; 2], confidence: f32) -> Keypoint {
    Keypoint { x, y, confidence }
}

fn sigmoid(value: f32) -> f32 {
    1.0 / (1.0 + (-value).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 9;
    const CELLS: usize = SIDE * SIDE;
    const STRIDE: f32 = 16.0;

    struct SyntheticMaps {
        heatmap: Vec<f32>,
        offsets: Vec<f32>,
        forward: Vec<f32>,
        backward: Vec<f32>,
    }

    impl SyntheticMaps {
        fn maps(&self) -> PartMaps<'_> {
            let Self { heatmap, offsets, forward, backward } = self;
            PartMaps { rows: SIDE, columns: SIDE, stride: STRIDE, heatmap, offsets, forward, backward }
        }
    }

    /// Returns maps with each person's joints in the given cells, with an offset of (1, -2) pixels.
    fn synthetic(persons: &[[[usize; 2]; JOINTS]]) -> SyntheticMaps {
        let mut synthetic = SyntheticMaps {
            heatmap: vec![-9.0; CELLS * JOINTS],
            offsets: vec![0.0; CELLS * 2 * JOINTS],
            forward: vec![0.0; CELLS * 32],
            backward: vec![0.0; CELLS * 32],
        };
        for (number, joints) in persons.iter().enumerate() {
            for (joint, [row, column]) in joints.iter().enumerate() {
                let cell = row * SIDE + column;
                synthetic.heatmap[joint * CELLS + cell] = 4.0 - number as f32;
                synthetic.offsets[joint * CELLS + cell] = -2.0;
                synthetic.offsets[(JOINTS + joint) * CELLS + cell] = 1.0;
            }
            for (edge, [parent, child]) in EDGES.iter().enumerate() {
                let ([row, column], [to_row, to_column]) = (joints[*parent], joints[*child]);
                let (dy, dx) =
                    ((to_row as f32 - row as f32) * STRIDE, (to_column as f32 - column as f32) * STRIDE);
                let (here, there) = (row * SIDE + column, to_row * SIDE + to_column);
                for (map, value) in [(edge, dy), (16 + edge, dx)] {
                    synthetic.forward[map * CELLS + here] = value;
                    synthetic.backward[map * CELLS + there] = -value;
                }
            }
        }
        synthetic
    }

    fn body(column: usize) -> [[usize; 2]; JOINTS] {
        std::array::from_fn(|joint| [joint / 2, column + joint % 2 * 2])
    }

    fn decode(synthetic: &SyntheticMaps) -> Vec<Person> {
        let mut persons = Vec::new();
        let tree = PartTree { peak_threshold: 0.5, radius: 10.0, max_persons: 10 };
        tree.decode(&synthetic.maps(), &mut Vec::new(), &mut persons);
        persons
    }

    #[test]
    fn two_persons_are_separated() {
        let bodies = [body(0), body(5)];
        let persons = decode(&synthetic(&bodies));
        assert_eq!(persons.len(), 2);
        for (person, joints) in persons.iter().zip(bodies) {
            for (found, [row, column]) in person.joints.iter().zip(joints) {
                assert_eq!((found.x, found.y), (column as f32 * STRIDE + 1.0, row as f32 * STRIDE - 2.0));
            }
        }
        assert!((persons[0].score - sigmoid(4.0)).abs() < 1e-6);
        assert!((persons[1].score - sigmoid(3.0)).abs() < 1e-6);
    }

    #[test]
    fn invalid_maps_do_not_panic() {
        let mut synthetic = synthetic(&[body(2)]);
        for (values, bad) in [(&mut synthetic.forward, f32::NAN), (&mut synthetic.backward, f32::INFINITY)] {
            values.fill(bad);
        }
        synthetic.offsets.fill(-1e30);
        assert!(decode(&synthetic).len() <= 10);
        synthetic.heatmap.fill(f32::NAN);
        assert!(decode(&synthetic).is_empty());
    }
}
