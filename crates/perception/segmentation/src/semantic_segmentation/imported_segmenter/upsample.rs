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

/// Work memory of [`classes_of_row`].
#[derive(Default)]
pub(super) struct RowScores {
    /// The scores of one row of the image at the columns of the map, class by class within a column.
    scores: Vec<f32>,
}

/// Writes the class with the highest score, interpolated bilinearly, at each of `columns` of a row of the image; the first of equal ones.
/// `size` is the number of classes and of the map's columns, `strides` the steps from a class, row and column to the next.
pub(super) fn classes_of_row(
    values: &[f32],
    [classes, map_columns]: [usize; 2],
    [by_class, by_row, by_column]: [usize; 3],
    row: Between,
    columns: &[Between],
    memory: &mut RowScores,
    labels: &mut [u32],
) {
    let scores = &mut memory.scores;
    scores.clear();
    scores.reserve(classes * map_columns);
    for column in 0..map_columns {
        let at = |line: usize, class: usize| values[line * by_row + column * by_column + class * by_class];
        scores.extend((0..classes).map(|class| {
            let (above, below) = (at(row.first, class), at(row.second, class));
            above + (below - above) * row.share
        }));
    }
    for (label, column) in labels.iter_mut().zip(columns) {
        let left = &scores[column.first * classes..][..classes];
        let right = &scores[column.second * classes..][..classes];
        let mut best = (0, f32::NEG_INFINITY);
        for ((left, right), class) in left.iter().zip(right).zip(0..) {
            let score = left + (right - left) * column.share;
            if score > best.1 {
                best = (class, score);
            }
        }
        *label = best.0;
    }
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
        let (mut memory, mut labels) = (RowScores::default(), [9; 5]);
        classes_of_row(&scores, [2, 2], [2, 2, 1], row, &columns, &mut memory, &mut labels);
        assert_eq!(labels, [0, 0, 0, 1, 1]);
        classes_of_row(&scores, [2, 2], [1, 4, 2], row, &columns, &mut memory, &mut labels);
        assert_eq!(labels, [0, 0, 0, 1, 1]);
        let nothing = [f32::NAN; 4];
        classes_of_row(&nothing, [2, 2], [2, 2, 1], row, &columns, &mut memory, &mut labels);
        assert_eq!(labels, [0; 5]);
    }
}
