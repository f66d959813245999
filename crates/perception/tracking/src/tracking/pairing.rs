//! Pairing tracks with what was found, where most pairs are out of the question.

use opendr_engine::assignment::Assignment;

/// Pairs rows with columns for the largest sum of gains. Memory is used again from frame to frame.
///
/// Only proposed pairs are looked at. They fall apart into groups that share no row and no column, mostly of one pair each,
/// and each group is solved exactly, by linear assignment; so time and memory follow the crowds in a frame, not the
/// product of all tracks and boxes.
///
/// ```
/// use opendr_tracking::tracking::Pairing;
///
/// let mut pairing = Pairing::default();
/// pairing.propose(0, 0, 0.9);
/// pairing.propose(0, 1, 0.8);
/// pairing.propose(1, 0, 0.7);
/// assert_eq!(pairing.solve(), [(0, 1), (1, 0)]);
/// ```
#[derive(Debug, Clone, Default)]
pub struct Pairing {
    proposals: Vec<Proposal>,
    /// Of each row, then of each column: another of its group, or itself.
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
    /// The first row of its group.
    group: usize,
}

/// Groups of more rows times columns are paired by the largest gain first: exactly, they would take seconds.
const LARGEST_GROUP: usize = 1 << 20;

impl Pairing {
    /// Forgets what was proposed and paired.
    pub fn begin(&mut self) {
        self.proposals.clear();
    }

    /// A pair that may be made and what it is worth; one that is not worth more than 0 is not proposed.
    pub fn propose(&mut self, row: usize, column: usize, gain: f64) {
        if gain > 0.0 && gain.is_finite() {
            self.proposals.push(Proposal { row, column, gain, group: 0 });
        }
    }

    /// The best pairs `(row, column)`, in rising order of rows.
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

    /// Gives every proposal its group: what is connected by rows or columns in common.
    fn group(&mut self) {
        let Self { proposals, leaders: [rows, columns], .. } = self;
        // A column's leader is a row; none yet.
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
            // Proposed twice, the better counts.
            costs[cell] = costs[cell].min(-proposal.gain);
        }
        let found = assignment.cheapest_pairs(costs, columns.len()).iter();
        let made = found.filter(|(row, column)| costs[row * columns.len() + column] < 0.0);
        pairs.extend(made.map(|(row, column)| (rows[*row], columns[*column])));
    }
}

/// The first row of the group of `row`; shortens the way there.
fn leader(rows: &mut [usize], mut row: usize) -> usize {
    while rows[row] != row {
        rows[row] = rows[rows[row]];
        row = rows[row];
    }
    row
}

/// Takes the pair of the largest gain, again and again. `rows` and `columns` lose those that are taken.
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
        /// Groups change nothing: the sum is that of the whole matrix, in which no pair costs nothing.
        #[test]
        fn as_the_whole_matrix(rows in 1usize..12, columns in 1usize..12, seed in prop::collection::vec(0u8..40, 144)) {
            let gains: Vec<f64> = seed[..rows * columns].iter().map(|number| f64::from(*number) - 28.0).collect();
            let mut pairing = Pairing::default();
            // Twice: memory is used again.
            for _ in 0..2 {
                pairing.begin();
                for (at, gain) in gains.iter().enumerate() {
                    pairing.propose(at / columns, at % columns, *gain);
                }
                let pairs = pairing.solve().to_vec();
                let costs: Vec<f64> = gains.iter().map(|gain| (-gain).min(0.0)).collect();
                let wanted: f64 = cheapest_pairs(&costs, columns).iter().map(|(row, column)| -costs[row * columns + column]).sum();
                prop_assert!((sum(&gains, &pairs, columns) - wanted).abs() < 1e-9);
                prop_assert!(pairs.is_sorted_by_key(|(row, _)| *row));
                let mut taken: Vec<_> = pairs.iter().map(|(_, column)| *column).collect();
                taken.sort_unstable();
                taken.dedup();
                prop_assert_eq!(taken.len(), pairs.len());
            }
        }
    }

    #[test]
    fn a_crowd_without_end_is_paired_by_the_largest_gain() {
        let mut pairing = Pairing::default();
        for row in 0..1100 {
            (0..1100)
                .for_each(|column| pairing.propose(row, column, 1.0 / (1.0 + row.abs_diff(column) as f64)));
        }
        assert_eq!(pairing.solve(), (0..1100).map(|at| (at, at)).collect::<Vec<_>>());
    }

    #[test]
    fn what_is_worth_nothing_is_not_paired() {
        let mut pairing = Pairing::default();
        for gain in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            pairing.propose(0, 0, gain);
        }
        assert_eq!(pairing.solve(), []);
        pairing.propose(7, 3, 0.5);
        assert_eq!(pairing.solve(), [(7, 3)]);
    }
}
