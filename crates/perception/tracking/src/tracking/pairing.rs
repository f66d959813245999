//! Sparse linear assignment of tracks and detections.

use opendr_engine::assignment::Assignment;

/// Assigns rows to columns for the largest sum of gains. Its memory is reused.
///
/// Only proposed pairs are considered. They separate into groups without a common row or column, mostly of one pair each,
/// and each group is solved exactly by linear assignment. Time and memory therefore depend on the crowds in a frame, not on
/// the product of tracks and boxes.
///
/// ```
/// use opendr_tracking::tracking::SparseAssignment;
///
/// let mut pairing = SparseAssignment::default();
/// pairing.propose(0, 0, 0.9);
/// pairing.propose(0, 1, 0.8);
/// pairing.propose(1, 0, 0.7);
/// assert_eq!(pairing.solve(), [(0, 1), (1, 0)]);
/// ```
#[derive(Debug, Clone, Default)]
pub struct SparseAssignment {
    proposals: Vec<Proposal>,
    /// Union-find parents of rows, then a row of each column.
    leaders: [Vec<usize>; 2],
    assignment: Assignment,
    rows: Vec<usize>,
    columns: Vec<usize>,
    costs: Vec<f64>,
    pairs: Vec<(usize, usize)>,
}

#[derive(Debug, Clone, Copy)]
struct Proposal {
    row: usize,
    column: usize,
    gain: f64,
    /// First row of its group.
    group: usize,
}

/// Maximum of rows times columns of a group that is solved exactly; larger groups are solved greedily by the largest gain.
const LARGEST_GROUP: usize = 1 << 20;

impl SparseAssignment {
    /// Clears the proposals.
    pub fn clear(&mut self) {
        self.proposals.clear();
    }

    /// Proposes a pair with its gain; gains that are not above 0 and finite are ignored.
    pub fn propose(&mut self, row: usize, column: usize, gain: f64) {
        if gain > 0.0 && gain.is_finite() {
            self.proposals.push(Proposal { row, column, gain, group: 0 });
        }
    }

    /// Returns the best pairs `(row, column)`, sorted by rows.
    pub fn solve(&mut self) -> &[(usize, usize)] {
        self.pairs.clear();
        self.group();
        self.proposals.sort_unstable_by_key(|proposal| (proposal.group, proposal.row, proposal.column));
        let mut begin = 0;
        while let Some(first) = self.proposals.get(begin) {
            let group = first.group;
            let length = self.proposals[begin..].iter().take_while(|other| other.group == group).count();
            self.solve_group(begin, begin + length);
            begin += length;
        }
        self.pairs.sort_unstable();
        &self.pairs
    }

    /// Assigns every proposal to its group: those connected by common rows or columns.
    fn group(&mut self) {
        let Self { proposals, leaders: [rows, columns], .. } = self;
        // A column has the first row that was proposed with it.
        const NONE: usize = usize::MAX;
        let most = |of: fn(&Proposal) -> usize| proposals.iter().map(of).max().map_or(0, |most| most + 1);
        let counts = [most(|proposal| proposal.row), most(|proposal| proposal.column)];
        rows.clear();
        rows.extend(0..counts[0]);
        columns.clear();
        columns.resize(counts[1], NONE);
        for proposal in proposals.iter() {
            match columns[proposal.column] {
                NONE => columns[proposal.column] = proposal.row,
                other => {
                    let (one, other) = (leader(rows, proposal.row), leader(rows, other));
                    rows[one.max(other)] = one.min(other);
                }
            }
        }
        for proposal in proposals.iter_mut() {
            proposal.group = leader(rows, proposal.row);
        }
    }

    fn solve_group(&mut self, begin: usize, end: usize) {
        let Self { proposals, assignment, rows, columns, costs, pairs, .. } = self;
        let proposals = &mut proposals[begin..end];
        if let [only] = proposals {
            return pairs.push((only.row, only.column));
        }
        for (list, of) in [(&mut *rows, (|p| p.row) as fn(&Proposal) -> usize), (columns, |p| p.column)] {
            list.clear();
            list.extend(proposals.iter().map(of));
            list.sort_unstable();
            list.dedup();
        }
        let cells = rows.len() * columns.len();
        if cells > LARGEST_GROUP {
            return greedy(proposals, rows, columns, pairs);
        }
        costs.clear();
        costs.resize(cells, 0.0);
        for proposal in proposals.iter() {
            let at = |list: &[usize], value: usize| list.binary_search(&value).unwrap_or_default();
            let cell = at(rows, proposal.row) * columns.len() + at(columns, proposal.column);
            // Of repeated proposals the best counts.
            costs[cell] = costs[cell].min(-proposal.gain);
        }
        let found = assignment.cheapest_pairs(costs, columns.len()).iter();
        let matched = found.filter(|(row, column)| costs[row * columns.len() + column] < 0.0);
        pairs.extend(matched.map(|(row, column)| (rows[*row], columns[*column])));
    }
}

/// Returns the first row of the group of `row`, and shortens the path to it.
fn leader(rows: &mut [usize], mut row: usize) -> usize {
    while rows[row] != row {
        rows[row] = rows[rows[row]];
        row = rows[row];
    }
    row
}

/// Takes the pairs in the order of decreasing gains. `rows` and `columns` lose those that are taken.
fn greedy(
    proposals: &mut [Proposal],
    rows: &mut Vec<usize>,
    columns: &mut Vec<usize>,
    pairs: &mut Vec<(usize, usize)>,
) {
    proposals
        .sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then((a.row, a.column).cmp(&(b.row, b.column))));
    for proposal in proposals {
        let places = (rows.binary_search(&proposal.row), columns.binary_search(&proposal.column));
        if let (Ok(row), Ok(column)) = places {
            rows.remove(row);
            columns.remove(column);
            pairs.push((proposal.row, proposal.column));
        }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::assignment::cheapest_pairs;
    use proptest::prelude::*;

    use super::*;

    fn sum(gains: &[f64], pairs: &[(usize, usize)], columns: usize) -> f64 {
        pairs.iter().map(|(row, column)| gains[row * columns + column]).sum()
    }

    proptest! {
        /// Checks that groups do not change the result: the sum equals that of the whole matrix.
        #[test]
        fn as_the_whole_matrix(rows in 1usize..12, columns in 1usize..12, seed in prop::collection::vec(0u8..40, 144)) {
            let gains: Vec<f64> = seed[..rows * columns].iter().map(|number| f64::from(*number) - 28.0).collect();
            let mut pairing = SparseAssignment::default();
            // Twice, as memory is reused.
            for _ in 0..2 {
                pairing.clear();
                for (at, gain) in gains.iter().enumerate() {
                    pairing.propose(at / columns, at % columns, *gain);
                }
                let pairs = pairing.solve().to_vec();
                let costs: Vec<f64> = gains.iter().map(|gain| (-gain).min(0.0)).collect();
                let expected: f64 = cheapest_pairs(&costs, columns).iter().map(|(row, column)| -costs[row * columns + column]).sum();
                prop_assert!((sum(&gains, &pairs, columns) - expected).abs() < 1e-9);
                prop_assert!(pairs.is_sorted_by_key(|(row, _)| *row));
                let mut taken: Vec<_> = pairs.iter().map(|(_, column)| *column).collect();
                taken.sort_unstable();
                taken.dedup();
                prop_assert_eq!(taken.len(), pairs.len());
            }
        }
    }

    #[test]
    fn a_large_group_is_solved_greedily() {
        let mut pairing = SparseAssignment::default();
        for row in 0..1100 {
            (0..1100)
                .for_each(|column| pairing.propose(row, column, 1.0 / (1.0 + row.abs_diff(column) as f64)));
        }
        assert_eq!(pairing.solve(), (0..1100).map(|at| (at, at)).collect::<Vec<_>>());
    }

    #[test]
    fn pairs_without_gain_are_not_assigned() {
        let mut pairing = SparseAssignment::default();
        for gain in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            pairing.propose(0, 0, gain);
        }
        assert_eq!(pairing.solve(), []);
        pairing.propose(7, 3, 0.5);
        assert_eq!(pairing.solve(), [(7, 3)]);
    }
}
