//! Sparse symmetric positive definite systems in envelope form.

/// The lower triangle of a symmetric matrix: each row from its first entry to the diagonal. Cholesky's decomposition fills only the
/// envelope (A. George and J. Liu, Computer solution of large sparse positive definite systems, 1981). In the graph of a trajectory a row
/// reaches back to the pose before, and far only where a loop was closed.
#[derive(Debug, Default)]
pub(super) struct Envelope {
    /// First column of each row.
    firsts: Vec<usize>,
    /// Offset of each row's first entry.
    offsets: Vec<usize>,
    entries: Vec<f64>,
}

impl Envelope {
    /// Sets the shape: the first column of each row, at most the row's number; all entries are 0.
    pub fn reshape(&mut self, firsts: &[usize]) {
        self.firsts.clear();
        self.firsts.extend(firsts.iter().enumerate().map(|(row, first)| (*first).min(row)));
        self.offsets.clear();
        let mut end = 0;
        for (row, first) in self.firsts.iter().enumerate() {
            self.offsets.push(end);
            end += row - first + 1;
        }
        self.entries.clear();
        self.entries.resize(end, 0.0);
    }

    /// Adds to an entry of the lower triangle within the envelope.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        debug_assert!(column <= row && column >= self.firsts[row]);
        let at = self.offsets[row] + column - self.firsts[row];
        self.entries[at] += value;
    }

    /// Returns the diagonal entry of a row.
    pub fn diagonal(&self, row: usize) -> f64 {
        self.entries[self.offsets[row] + row - self.firsts[row]]
    }

    /// Solves the system in place and destroys the matrix; returns `false` if it is not positive definite.
    pub fn solve(&mut self, right: &mut [f64]) -> bool {
        for row in 0..self.firsts.len() {
            let first = self.firsts[row];
            let (before, own) = self.entries.split_at_mut(self.offsets[row]);
            let own = &mut own[..row - first + 1];
            for column in first..row {
                let its_first = self.firsts[column];
                let its = &before[self.offsets[column]..][..column - its_first + 1];
                let from = first.max(its_first);
                let sum = dot(&own[from - first..column - first], &its[from - its_first..column - its_first]);
                own[column - first] = (own[column - first] - sum) / its[column - its_first];
            }
            let (diagonal, rest) = match own.split_last_mut() {
                Some(split) => split,
                None => return false,
            };
            let left = *diagonal - dot(rest, rest);
            if left.is_nan() || left <= 0.0 {
                return false;
            }
            *diagonal = left.sqrt();
            right[row] = (right[row] - dot(rest, &right[first..row])) / *diagonal;
        }
        for row in (0..self.firsts.len()).rev() {
            let first = self.firsts[row];
            let own = &self.entries[self.offsets[row]..][..row - first + 1];
            right[row] /= own[row - first];
            let solved = right[row];
            for (value, entry) in right[first..row].iter_mut().zip(own) {
                *value -= entry * solved;
            }
        }
        true
    }
}

/// Returns the product of two slices of one length, in four sums.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, others) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = fours.remainder().iter().zip(others.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in fours.zip(others) {
        (0..4).for_each(|at| sums[at] += a[at] * b[at]);
    }
    sums.iter().sum::<f64>() + rest
}
