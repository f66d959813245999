//! Rows of candidates in a network's output: a box, an objectness and the scores of the classes.

use opendr_engine::{Error, Result};
use opendr_inference::TensorView;

use crate::suppression::Candidate;

/// The rows of an output `[1, rows, fields]`, or `[1, fields, rows]`.
#[derive(Clone, Copy)]
pub struct Rows<'a> {
    values: &'a [f32],
    rows: usize,
    fields: usize,
    row_stride: usize,
    field_stride: usize,
}

impl<'a> Rows<'a> {
    /// Reads an output of two or more dimensions, of which the last two are rows and fields and the others have size 1.
    ///
    /// # Errors
    /// `Format` for another shape, `InvalidInput` for another type of elements.
    pub fn of(output: &TensorView<'a>, transposed: bool) -> Result<Self> {
        let values = output.values::<f32>()?;
        let (outer, [first, second]) = match output.shape() {
            [outer @ .., first, second] => (outer, [*first, *second]),
            _ => return Err(Error::format(format!("an output {output:?} has no rows"))),
        };
        if outer.iter().any(|dim| *dim != 1) {
            return Err(Error::format(format!(
                "an output {output:?} has several batches; export the network with a batch of 1"
            )));
        }
        Ok(match transposed {
            false => Self { values, rows: first, fields: second, row_stride: second, field_stride: 1 },
            true => Self { values, rows: second, fields: first, row_stride: 1, field_stride: second },
        })
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Returns whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Returns the number of fields of a row.
    pub fn fields(&self) -> usize {
        self.fields
    }

    /// Returns a value; 0 outside of the output.
    pub fn at(&self, row: usize, field: usize) -> f32 {
        self.values.get(row * self.row_stride + field * self.field_stride).copied().unwrap_or(0.0)
    }

    /// Returns the four values of a box that begins at `field`.
    pub fn corners(&self, row: usize, field: usize) -> [f32; 4] {
        std::array::from_fn(|index| self.at(row, field + index))
    }

    /// Writes the highest value of the fields `first..first + count` of each row, and its index, into `best`.
    pub fn best(&self, first: usize, count: usize, best: &mut Vec<(f32, u32)>) {
        best.clear();
        best.resize(self.rows, (f32::NEG_INFINITY, 0));
        let count = count.min(self.fields.saturating_sub(first));
        if self.row_stride == 1 {
            // Neighbouring values are of one field: field by field, memory is read in order.
            for class in 0..count {
                let column = self.values.iter().skip((first + class) * self.field_stride);
                for (best, value) in best.iter_mut().zip(column) {
                    if *value > best.0 {
                        *best = (*value, class as u32);
                    }
                }
            }
            return;
        }
        for (best, row) in best.iter_mut().zip(self.values.chunks_exact(self.row_stride.max(1))) {
            for (value, class) in row.iter().skip(first).take(count).zip(0..) {
                if *value > best.0 {
                    *best = (*value, class);
                }
            }
        }
    }
}

/// What becomes a candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Selection {
    /// Score below which nothing does.
    pub threshold: f32,
    /// Whether every class of a row that reaches the threshold does, or only the class with the highest score.
    pub multi_label: bool,
}

/// The class scores of rows: `count` fields from `first` on.
#[derive(Clone, Copy)]
pub struct ClassScores<'a> {
    /// The rows.
    pub rows: Rows<'a>,
    /// First field with a class score.
    pub first: usize,
    /// Number of classes.
    pub count: usize,
}

impl Selection {
    /// Adds the candidates of a row whose highest class value and class are `best`; `score` maps a class's value to its score.
    pub fn add(
        self,
        classes: &ClassScores<'_>,
        row: usize,
        (best, class): (f32, u32),
        score: impl Fn(f32) -> f32,
        corners: impl FnOnce() -> [f32; 4],
        candidates: &mut Vec<Candidate>,
    ) {
        let best = score(best);
        if best.is_nan() || best < self.threshold {
            return;
        }
        let (corners, index) = (corners(), row as u32);
        if !self.multi_label {
            return candidates.push(Candidate { corners, score: best, class, index });
        }
        let ClassScores { rows, first, count } = classes;
        let scores = (0..*count).map(|class| (class, score(rows.at(row, first + class))));
        let reach = scores.filter(|(_, score)| *score >= self.threshold);
        candidates.extend(reach.map(|(class, score)| Candidate {
            corners,
            score,
            class: class as u32,
            index,
        }));
    }
}

/// Decodes rows of YOLOX: one per cell of the levels with `strides`, with box centres relative to the cell in strides, logarithms of
/// sizes in strides, objectness and class scores. Corners are in pixels of the network's input of `size`.
///
/// # Errors
/// `Format` when the number of rows is not that of the cells.
pub fn decode_grid(
    rows: &Rows<'_>,
    [width, height]: [usize; 2],
    strides: &[usize],
    selection: Selection,
    best: &mut Vec<(f32, u32)>,
    candidates: &mut Vec<Candidate>,
) -> Result<()> {
    let cells = cells_of([width, height], strides);
    if rows.len() != cells || rows.fields() < 6 {
        return Err(Error::format(format!(
            "the network has {} rows of {} values; an input of {width} x {height} pixels has {cells} cells of strides {strides:?}",
            rows.len(),
            rows.fields()
        )));
    }
    let classes = ClassScores { rows: *rows, first: 5, count: rows.fields() - 5 };
    rows.best(classes.first, classes.count, best);
    let mut row = 0;
    for stride in strides {
        let columns = width / stride;
        for cell in 0..columns * (height / stride) {
            let objectness = rows.at(row, 4);
            let score = |class_score: f32| class_score * objectness;
            let corners = || {
                let [x, y, log_width, log_height] = rows.corners(row, 0);
                let stride = *stride as f32;
                let x = (x + (cell % columns) as f32) * stride;
                let y = (y + (cell / columns) as f32) * stride;
                let (half_width, half_height) =
                    (log_width.exp() * stride / 2.0, log_height.exp() * stride / 2.0);
                [x - half_width, y - half_height, x + half_width, y + half_height]
            };
            selection.add(&classes, row, best[row], score, corners, candidates);
            row += 1;
        }
    }
    Ok(())
}

/// Returns the number of cells of all levels with `strides` for an input of `[width, height]` pixels.
pub fn cells_of([width, height]: [usize; 2], strides: &[usize]) -> usize {
    strides.iter().map(|stride| (width / stride) * (height / stride)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_orders_give_the_same_rows() {
        let (rows, columns) = ([1.0_f32, 2.0, 3.0, 4.0, 6.0, 5.0], [1.0_f32, 4.0, 2.0, 6.0, 3.0, 5.0]);
        let rows = Rows::of(&TensorView::new(&[1, 2, 3], &rows).unwrap(), false).unwrap();
        let columns = Rows::of(&TensorView::new(&[1, 3, 2], &columns).unwrap(), true).unwrap();
        let (mut first, mut second) = (Vec::new(), Vec::new());
        rows.best(1, 2, &mut first);
        columns.best(1, 2, &mut second);
        assert_eq!(first, [(3.0, 1), (6.0, 0)]);
        assert_eq!(first, second);
        assert_eq!((columns.len(), columns.fields(), columns.at(1, 2)), (2, 3, 5.0));
    }

    #[test]
    fn a_cell_becomes_a_box() {
        // 64 x 32 pixels: 32 + 8 + 2 cells; the last has its centre at (48, 16).
        let mut values = vec![0.0_f32; 42 * 7];
        values[41 * 7..].copy_from_slice(&[0.5, 0.5, 0.0, 2.0_f32.ln(), 0.5, 0.2, 0.8]);
        let rows = Rows::of(&TensorView::new(&[1, 42, 7], &values).unwrap(), false).unwrap();
        let mut candidates = Vec::new();
        let selection = Selection { threshold: 0.3, multi_label: false };
        decode_grid(&rows, [64, 32], &[8, 16, 32], selection, &mut Vec::new(), &mut candidates).unwrap();
        let [found] = candidates[..] else { panic!("{candidates:?}") };
        assert_eq!((found.class, found.score, found.index), (1, 0.4, 41));
        let wanted = [32.0, -16.0, 64.0, 48.0];
        assert!(found.corners.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-4));
        assert!(
            decode_grid(&rows, [64, 64], &[8, 16, 32], selection, &mut Vec::new(), &mut candidates).is_err()
        );
    }
}
