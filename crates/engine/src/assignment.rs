//! Linear assignment: the pairing of rows with columns that has the least total cost.
//!
//! Trackers pair tracks with detections by it, metrics pair predictions with ground truth. Shortest augmenting
//! paths on a rectangular matrix: D. F. Crouse, "On implementing 2D rectangular assignment algorithms", IEEE
//! Transactions on Aerospace and Electronic Systems 52(4), 2016. Among equally good pairings it picks the one that
//! SciPy's `linear_sum_assignment` picks, because published tracking scores depend on that choice.

/// Largest magnitude of a cost; a larger one forbids its pair. Sums of allowed costs stay finite.
const LARGEST_COST: f64 = 1e200;

fn is_allowed(cost: f64) -> bool {
    cost.abs() <= LARGEST_COST
}

/// Returns the pairs `(row, column)` with the least total cost, in rising order of rows.
///
/// `costs` is a matrix in row-major order with `columns` columns. No row and no column occurs twice. The number of pairs
/// is the largest possible, and among all pairings of that number the cheapest is chosen. A pair whose cost is infinite,
/// NaN or above 1e200 in magnitude is never chosen. Time grows with `min(rows, columns)² · max(rows, columns)`.
///
/// ```
/// use opendr_engine::assignment::cheapest_pairs;
///
/// let costs = [4.0, 1.0, f64::INFINITY, 2.0, 0.0, 5.0];
/// assert_eq!(cheapest_pairs(&costs, 3), [(0, 1), (1, 0)]);
/// ```
pub fn cheapest_pairs(costs: &[f64], columns: usize) -> Vec<(usize, usize)> {
    let mut assignment = Assignment::default();
    assignment.cheapest_pairs(costs, columns);
    assignment.pairs
}

/// [`cheapest_pairs`] with reusable buffers: nothing is allocated after the first calls.
#[derive(Debug, Clone, Default)]
pub struct Assignment {
    paths: AugmentingPaths,
    pairs: Vec<(usize, usize)>,
}

impl Assignment {
    /// Returns the same as the function [`cheapest_pairs`].
    pub fn cheapest_pairs(&mut self, costs: &[f64], columns: usize) -> &[(usize, usize)] {
        let Self { paths, pairs } = self;
        pairs.clear();
        let rows = costs.len().checked_div(columns).unwrap_or(0);
        debug_assert_eq!(costs.len(), rows * columns, "the last row is incomplete");
        let allowed = costs.iter().filter(|cost| is_allowed(**cost)).map(|cost| cost.abs());
        let Some(largest) = allowed.reduce(f64::max) else { return pairs };

        // One forbidden pair costs more than any set of allowed ones can save.
        let (short, long) = (rows.min(columns), rows.max(columns));
        let forbidden = 2.0 * short as f64 * (largest + 1.0) + 1.0;
        let is_tall = rows > columns;
        let position = |row: usize, column: usize| match is_tall {
            true => column * columns + row,
            false => row * columns + column,
        };
        paths.begin(short, long);
        for row in 0..short {
            paths.costs.extend((0..long).map(|column| match costs[position(row, column)] {
                cost if is_allowed(cost) => cost,
                _ => forbidden,
            }));
        }
        (0..short).for_each(|row| paths.add(row));
        let assigned = (0..short).filter_map(|row| Some((row, paths.column_of[row]?)));
        let assigned = assigned.filter(|&(row, column)| is_allowed(costs[position(row, column)]));
        pairs.extend(assigned.map(|(row, column)| if is_tall { (column, row) } else { (row, column) }));
        pairs.sort_unstable();
        pairs
    }
}

/// A cheapest pairing of the rows added so far, with its dual variables (prices).
#[derive(Debug, Clone, Default)]
struct AugmentingPaths {
    costs: Vec<f64>,
    columns: usize,
    row_price: Vec<f64>,
    column_price: Vec<f64>,
    column_of: Vec<Option<usize>>,
    row_of: Vec<Option<usize>>,
    /// Length of the shortest known path from the added row to each column.
    distance: Vec<f64>,
    /// The row before each column on that path.
    before: Vec<usize>,
    /// Columns whose shortest path is not final.
    open: Vec<usize>,
    settled: Vec<usize>,
    reached: Vec<usize>,
}

impl AugmentingPaths {
    /// Removes all rows and costs, for a matrix of this size.
    fn begin(&mut self, rows: usize, columns: usize) {
        fn fill<T: Copy>(list: &mut Vec<T>, length: usize, value: T) {
            list.clear();
            list.resize(length, value);
        }
        self.costs.clear();
        self.columns = columns;
        fill(&mut self.row_price, rows, 0.0);
        fill(&mut self.column_price, columns, 0.0);
        fill(&mut self.column_of, rows, None);
        fill(&mut self.row_of, columns, None);
        fill(&mut self.distance, columns, 0.0);
        fill(&mut self.before, columns, 0);
    }

    /// Pairs one more row, moving earlier ones along the shortest path to a free column.
    fn add(&mut self, row: usize) {
        let Some((free, length)) = self.shortest_path(row) else { return };
        self.row_price[row] += length;
        for &reached in &self.reached {
            if let Some(column) = self.column_of[reached].filter(|_| reached != row) {
                self.row_price[reached] += length - self.distance[column];
            }
        }
        for &column in &self.settled {
            self.column_price[column] -= length - self.distance[column];
        }
        let mut column = free;
        loop {
            let freed = self.before[column];
            self.row_of[column] = Some(freed);
            match self.column_of[freed].replace(column) {
                Some(next) if freed != row => column = next,
                _ => break,
            }
        }
    }

    /// Returns the nearest free column from `row` and the length of the path to it (Dijkstra on reduced costs).
    fn shortest_path(&mut self, row: usize) -> Option<(usize, f64)> {
        // In reverse order, so that a constant matrix gives the diagonal.
        self.open.clear();
        self.open.extend((0..self.columns).rev());
        self.distance.fill(f64::INFINITY);
        self.settled.clear();
        self.reached.clear();
        let (mut row, mut length) = (row, 0.0);
        loop {
            self.reached.push(row);
            let costs = &self.costs[row * self.columns..][..self.columns];
            let (mut nearest, mut lowest) = (None, f64::INFINITY);
            for (at, &column) in self.open.iter().enumerate() {
                let through = length + costs[column] - self.row_price[row] - self.column_price[column];
                if through < self.distance[column] {
                    self.distance[column] = through;
                    self.before[column] = row;
                }
                let distance = self.distance[column];
                if distance < lowest || (distance == lowest && self.row_of[column].is_none()) {
                    (nearest, lowest) = (Some(at), distance);
                }
            }
            let column = self.open.swap_remove(nearest?);
            self.settled.push(column);
            length = lowest;
            match self.row_of[column] {
                None => return Some((column, length)),
                Some(next) => row = next,
            }
        }
    }
}

#[cfg(test)]
mod tests;
