use proptest::prelude::*;

use super::*;

/// Returns the most pairs and the least cost over all pairings, by brute force.
fn best_by_brute_force(costs: &[f64], rows: usize, columns: usize) -> (usize, f64) {
    fn visit(costs: &[f64], columns: usize, row: usize, taken: u32) -> (usize, f64) {
        if row * columns >= costs.len() {
            return (0, 0.0);
        }
        let mut best = visit(costs, columns, row + 1, taken);
        for column in (0..columns).filter(|column| taken & 1 << column == 0) {
            let cost = costs[row * columns + column];
            if is_allowed(cost) {
                let (pairs, rest) = visit(costs, columns, row + 1, taken | 1 << column);
                let tried = (pairs + 1, rest + cost);
                if tried.0 > best.0 || (tried.0 == best.0 && tried.1 < best.1) {
                    best = tried;
                }
            }
        }
        best
    }
    if columns == 0 || rows == 0 { (0, 0.0) } else { visit(costs, columns, 0, 0) }
}

fn check(costs: &[f64], rows: usize, columns: usize) {
    let pairs = cheapest_pairs(costs, columns);
    assert!(pairs.is_sorted_by_key(|(row, _)| *row));
    let mut taken = vec![false; columns];
    for (row, column) in &pairs {
        assert!(*row < rows && !std::mem::replace(&mut taken[*column], true));
    }
    assert!(pairs.windows(2).all(|pair| pair[0].0 != pair[1].0));
    let total: f64 = pairs.iter().map(|(row, column)| costs[row * columns + column]).sum();
    let (count, least) = best_by_brute_force(costs, rows, columns);
    assert_eq!(pairs.len(), count, "{rows}x{columns} {costs:?}");
    assert!((total - least).abs() <= 1e-9 * (1.0 + least.abs()), "{total} is not {least}: {costs:?}");
}

/// Generates matrices up to 5x5, with many ties and a quarter of the pairs forbidden.
fn matrix() -> impl Strategy<Value = (usize, usize, Vec<f64>)> {
    let cost = prop_oneof![
        2 => (-3..4i32).prop_map(f64::from),
        1 => -1.0..1.0f64,
        1 => prop_oneof![Just(f64::INFINITY), Just(f64::NAN), Just(f64::NEG_INFINITY)],
    ];
    (0..6usize, 0..6usize).prop_flat_map(move |(rows, columns)| {
        (Just(rows), Just(columns), prop::collection::vec(cost.clone(), rows * columns))
    })
}

proptest! {
    #[test]
    fn pairing_is_optimal((rows, columns, costs) in matrix()) {
        check(&costs, rows, columns);
    }
}

/// The results of SciPy 1.17's `linear_sum_assignment` on the same matrices.
#[test]
fn ties_are_resolved_as_in_scipy() {
    assert_eq!(cheapest_pairs(&[1.0; 9], 3), [(0, 0), (1, 1), (2, 2)]);
    assert_eq!(cheapest_pairs(&[1.0; 6], 3), [(0, 0), (1, 1)]);
    assert_eq!(cheapest_pairs(&[1.0; 6], 2), [(0, 0), (1, 1)]);
    let costs = [1.0, 2.0, 2.0, 1.0, 2.0, 1.0, 1.0, 2.0, 1.0, 2.0, 2.0, 1.0];
    assert_eq!(cheapest_pairs(&costs, 4), [(0, 0), (1, 1), (2, 3)]);
    assert_eq!(cheapest_pairs(&costs, 3), [(0, 0), (1, 1), (2, 2)]);
}

#[test]
fn more_pairs_come_before_less_cost() {
    let none = f64::INFINITY;
    assert_eq!(cheapest_pairs(&[0.0, 100.0, 100.0, none], 2), [(0, 1), (1, 0)]);
    assert_eq!(cheapest_pairs(&[none, none, none, 3.0], 2), [(1, 1)]);
    assert_eq!(cheapest_pairs(&[none; 4], 2), []);
    assert_eq!(cheapest_pairs(&[1e300, -1e150, 1e150, f64::MAX], 2), [(0, 1), (1, 0)]);
    assert_eq!(cheapest_pairs(&[], 5), []);
    assert_eq!(cheapest_pairs(&[], 0), []);
}

/// A permutation hidden in a large matrix.
#[test]
fn large_matrices() {
    let size = 300;
    let hidden = |row: usize| (row * 7 + 3) % size;
    let costs: Vec<f64> = (0..size * size)
        .map(|at| if hidden(at / size) == at % size { -1.0 } else { (at * 31 % 97) as f64 / 97.0 })
        .collect();
    let pairs = cheapest_pairs(&costs, size);
    assert!(pairs.into_iter().eq((0..size).map(|row| (row, hidden(row)))));
}
