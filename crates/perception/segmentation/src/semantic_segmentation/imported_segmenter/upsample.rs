//! The class of every pixel of an image, from scores on a coarser map.

/// Where a pixel lies between two places of the map, along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Between {
    pub first: usize,
    pub second: usize,
    /// Share of the second.
    pub share: f32,
}

impl Between {
    /// Returns the neighbours of a position in pixels of the map, whose first centre is 0; positions outside are those of the edge.
    pub fn at(position: f32, count: usize) -> Self {
        let last = count.saturating_sub(1);
        let position = position.clamp(0.0, last as f32);
        let first = position as usize;
        Self { first, second: (first + 1).min(last), share: position - first as f32 }
    }
}

/// Class scores on a map.
#[derive(Clone, Copy)]
pub(super) struct Scores<'a> {
    pub values: &'a [f32],
    /// Numbers of classes, and of the map's rows and columns.
    pub counts: [usize; 3],
    /// Steps from a class, row and column to the next.
    pub strides: [usize; 3],
}

/// Interpolates class scores, with reused memory.
#[derive(Default)]
pub(super) struct Upsampling {
    /// The best class of each place of the map, and its score.
    classes: Vec<u32>,
    best: Vec<f32>,
    /// The scores of a row of the image at two neighbouring columns of the map.
    left: Vec<f32>,
    right: Vec<f32>,
}

impl Scores<'_> {
    fn at(&self, class: usize, row: usize, column: usize) -> f32 {
        let [by_class, by_row, by_column] = self.strides;
        self.values[class * by_class + row * by_row + column * by_column]
    }

    /// Writes the scores of all classes between two rows at a column.
    fn between_rows(&self, row: Between, column: usize, scores: &mut Vec<f32>) {
        scores.clear();
        scores.extend((0..self.counts[0]).map(|class| {
            let (above, below) = (self.at(class, row.first, column), self.at(class, row.second, column));
            above + (below - above) * row.share
        }));
    }
}

impl Upsampling {
    /// Finds the best class of each place of the map, for [`classes_of_row`](Self::classes_of_row).
    pub fn begin(&mut self, scores: Scores<'_>) {
        let [classes, rows, columns] = scores.counts;
        let Self { classes: best_classes, best, .. } = self;
        best_classes.clear();
        best_classes.resize(rows * columns, 0);
        best.clear();
        best.resize(rows * columns, f32::NEG_INFINITY);
        let [by_class, by_row, by_column] = scores.strides;
        // Along the memory: class by class where the classes are planes.
        let is_planar = by_class > by_column;
        for row in 0..rows {
            let places = row * columns..(row + 1) * columns;
            let (best, best_classes) = (&mut best[places.clone()], &mut best_classes[places]);
            let line = &scores.values[row * by_row..];
            if is_planar {
                for class in 0..classes {
                    let plane = line[class * by_class..].iter().step_by(by_column);
                    for ((score, best), best_class) in plane.zip(&mut *best).zip(&mut *best_classes) {
                        let is_better = score > best;
                        *best = if is_better { *score } else { *best };
                        *best_class = if is_better { class as u32 } else { *best_class };
                    }
                }
            } else {
                for (column, best_class) in best_classes.iter_mut().enumerate() {
                    let place = line[column * by_column..].iter().step_by(by_class.max(1)).take(classes);
                    *best_class = best_of(place.copied());
                }
            }
        }
    }

    /// Writes the class with the highest score, interpolated bilinearly, at each of `columns` of a row of the image; the first of
    /// equal ones. [`begin`](Self::begin) has been called with the same scores.
    pub fn classes_of_row(
        &mut self,
        scores: Scores<'_>,
        row: Between,
        columns: &[Between],
        labels: &mut [u32],
    ) {
        let map_columns = scores.counts[2];
        let class_at = |row: usize, column: usize| self.classes[row * map_columns + column];
        let mut at = 0;
        while let Some(&Between { first, second, .. }) = columns.get(at) {
            let same = |column: &&Between| column.first == first && column.second == second;
            let count = columns[at..].iter().take_while(same).count();
            let (between, labels) = (&columns[at..at + count], &mut labels[at..at + count]);
            at += count;
            // A class that is best at all corners is best between them, where every score is linear in each direction.
            let class = class_at(row.first, first);
            let corners = [(row.first, second), (row.second, first), (row.second, second)];
            if corners.into_iter().all(|(row, column)| class_at(row, column) == class) {
                labels.fill(class);
                continue;
            }
            scores.between_rows(row, first, &mut self.left);
            scores.between_rows(row, second, &mut self.right);
            for (label, column) in labels.iter_mut().zip(between) {
                let pairs = self.left.iter().zip(&self.right);
                *label = best_of(pairs.map(|(left, right)| left + (right - left) * column.share));
            }
        }
    }
}

/// Returns the index of the highest score, the first of equal ones; 0 where no score is a number.
fn best_of(scores: impl Iterator<Item = f32>) -> u32 {
    let mut best = (0, f32::NEG_INFINITY);
    for (score, class) in scores.zip(0..) {
        if score > best.1 {
            best = (class, score);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_outside_are_those_of_the_edge() {
        let at = |position, count| {
            let Between { first, second, share } = Between::at(position, count);
            (first, second, share)
        };
        assert_eq!(at(-0.25, 4), (0, 1, 0.0));
        assert_eq!(at(1.25, 4), (1, 2, 0.25));
        assert_eq!(at(3.25, 4), (3, 3, 0.0));
        assert_eq!(at(0.5, 1), (0, 0, 0.0));
        assert_eq!(at(f32::NAN, 4).0, 0);
    }

    #[test]
    fn classes_change_where_interpolated_scores_cross() {
        // One row of two columns: class 0 falls from 1 to 0, class 1 rises from 0 to 3; they cross at a quarter.
        // Channels first and channels last lie alike in memory.
        let scores = [1.0, 0.0, 0.0, 3.0];
        let columns: Vec<Between> =
            [0.0, 0.2, 0.25, 0.3, 1.0].map(|position| Between::at(position, 2)).into();
        let row = Between::at(0.0, 1);
        let labels_of = |values: &[f32], strides| {
            let scores = Scores { values, counts: [2, 1, 2], strides };
            let (mut upsampling, mut labels) = (Upsampling::default(), [9; 5]);
            upsampling.begin(scores);
            upsampling.classes_of_row(scores, row, &columns, &mut labels);
            labels
        };
        assert_eq!(labels_of(&scores, [2, 2, 1]), [0, 0, 0, 1, 1]);
        assert_eq!(labels_of(&scores, [1, 4, 2]), [0, 0, 0, 1, 1]);
        assert_eq!(labels_of(&[f32::NAN; 4], [2, 2, 1]), [0; 5]);
    }

    /// The classes equal those of interpolating every score at every pixel.
    #[test]
    fn regions_of_one_class_equal_interpolation() {
        let [classes, rows, columns] = [5, 7, 9];
        let mut random = opendr_engine::Random::from_key([1]);
        // Smooth scores, so that neighbours often agree.
        let values: Vec<f32> = (0..classes * rows * columns)
            .map(|at| {
                let (class, row, column) = (at / (rows * columns), at / columns % rows, at % columns);
                ((class * 3 + row) as f32 * 0.7).sin()
                    + (column as f32 * 0.4 + class as f32).cos()
                    + random.uniform(-0.05, 0.05)
            })
            .collect();
        let planar = [rows * columns, columns, 1];
        let mut last = vec![0.0; values.len()];
        for (at, value) in values.iter().enumerate() {
            last[at % (rows * columns) * classes + at / (rows * columns)] = *value;
        }
        let places = |count: usize| -> Vec<Between> {
            (0..count * 6).map(|pixel| Between::at((pixel as f32 + 0.5) / 6.0 - 0.5, count)).collect()
        };
        for (values, strides) in [(&values, planar), (&last, [1, columns * classes, classes])] {
            let scores = Scores { values, counts: [classes, rows, columns], strides };
            let mut upsampling = Upsampling::default();
            upsampling.begin(scores);
            for row in places(rows) {
                let (all, mut labels) = (places(columns), vec![9; columns * 6]);
                upsampling.classes_of_row(scores, row, &all, &mut labels);
                for (label, column) in labels.iter().zip(&all) {
                    let expected = best_of((0..classes).map(|class| {
                        let at = |row, column| scores.at(class, row, column);
                        let side = |column| {
                            let (above, below) = (at(row.first, column), at(row.second, column));
                            above + (below - above) * row.share
                        };
                        let (left, right) = (side(column.first), side(column.second));
                        left + (right - left) * column.share
                    }));
                    assert_eq!(*label, expected, "{row:?} {column:?}");
                }
            }
        }
    }
}
