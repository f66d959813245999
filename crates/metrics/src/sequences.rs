//! What the tracking metrics share: counts over several sequences, dense indices of identities, and one-to-one matching.

use std::collections::HashMap;
use std::fmt::Debug;

use opendr_engine::assignment::cheapest_pairs;

/// The state of a metric over one sequence.
pub(crate) trait SequenceState: Debug + Clone + Default {
    /// Counts that are added over sequences.
    type Counts: Debug + Clone + Default;

    /// Returns the counts of the sequence as if it were over.
    fn counts(&self) -> Self::Counts;

    /// Adds the counts of other sequences to `sum`.
    fn add(sum: &mut Self::Counts, other: &Self::Counts);
}

/// The counts of finished sequences and the state of the open one.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sequences<S: SequenceState> {
    finished: S::Counts,
    /// State of the open sequence.
    pub(crate) open: S,
}

impl<S: SequenceState> Sequences<S> {
    /// Returns the counts of all sequences, including the open one.
    pub(crate) fn counts(&self) -> S::Counts {
        let mut counts = self.finished.clone();
        S::add(&mut counts, &self.open.counts());
        counts
    }

    /// Finishes the open sequence and starts another.
    pub(crate) fn end(&mut self) {
        self.finished = self.counts();
        self.open = S::default();
    }

    /// Finishes the open sequence and adds the counts of `other`.
    pub(crate) fn merge(&mut self, other: &Self) {
        self.end();
        S::add(&mut self.finished, &other.counts());
    }
}

/// Dense indices of identities, in the order of their first occurrence.
#[derive(Debug, Clone, Default)]
pub(crate) struct Indices(HashMap<i64, usize>);

impl Indices {
    /// Returns the index of an identity; a new identity gets the next index.
    pub(crate) fn index(&mut self, identity: i64) -> usize {
        let next = self.0.len();
        *self.0.entry(identity).or_insert(next)
    }

    /// Returns the number of identities.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }
}

/// Returns the one-to-one pairs `(row, column, weight)` with the greatest total weight. `weights` lists the entries
/// `(row, column, weight)` of a matrix of `rows` by `columns` that are not 0.
pub(crate) fn heaviest_pairs(
    rows: usize,
    columns: usize,
    weights: impl IntoIterator<Item = (usize, usize, f64)>,
) -> Vec<(usize, usize, f64)> {
    let mut costs = vec![0.0; rows * columns];
    for (row, column, weight) in weights {
        costs[row * columns + column] = -weight;
    }
    let pairs = cheapest_pairs(&costs, columns).into_iter();
    pairs.map(|(row, column)| (row, column, -costs[row * columns + column])).collect()
}
