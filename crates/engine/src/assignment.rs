//! Linear assignment: pairing rows with columns at the least total cost.
//!
//! Trackers pair tracks with detections by it, metrics pair what was found with what is true. Shortest augmenting
//! paths on a rectangular matrix: D. F. Crouse, "On implementing 2D rectangular assignment algorithms", IEEE
//! Transactions on Aerospace and Electronic Systems 52(4), 2016. Among equally good pairings it picks the one that
//! SciPy's `linear_sum_assignment` picks, because published tracking scores depend on that choice.

/// Beyond this magnitude a cost forbids its pair; sums of costs below it stay finite.
const LARGEST_COST: f64 = 1e200;

fn is_allowed(cost: f64) -> bool {
    cost.abs() <= LARGEST_COST
}

/// The cheapest pairs `(row, column)` in rising order of rows; no row and no column occurs twice.
///
/// `costs` holds rows of `columns` costs each, one after the other. As many pairs are made as can be, and among all
/// ways of making that many the cheapest is chosen. A pair whose cost is infinite, NaN or beyond 1e200 in magnitude is
/// never made. Time grows with `min(rows, columns)² · max(rows, columns)`.
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

/// [`cheapest_pairs`] with memory that is used again: after the first calls nothing is allocated.
#[derive(Debug, Clone, Default)]
pub struct Assignment {
    paths: AugmentingPaths,
    pairs: Vec<(usize, usize)>,
}

impl Assignment {
    /// As the function of this name.
    pub fn cheapest_pairs(&mut self, costs: &[f64], columns: usize) -> &[(usize, usize)] {
        let Self { paths, pairs } = self;
        pairs.clear();
        let rows = costs.len().checked_div(columns).unwrap_or(0);
        debug_assert_eq!(costs.len(), rows * columns, "the last row is not whole");
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
        let found = (0..short).filter_map(|row| Some((row, paths.column_of[row]?)));
        let found = found.filter(|&(row, column)| is_allowed(costs[position(row, column)]));
        pairs.extend(found.map(|(row, column)| if is_tall { (column, row) } else { (row, column) }));
        pairs.sort_unstable();
        pairs
    }
}

/// A cheapest pairing of the rows added so far, with the prices (dual variables) that prove it.
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
    /// Columns whose shortest path is not settled.
    open: Vec<usize>,
    settled: Vec<usize>,
    reached: Vec<usize>,
}

impl AugmentingPaths {
    /// Forgets all rows; the costs are yet to come.
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

    /// The nearest free column from `row` and the length of the way there (Dijkstra on reduced costs).
    fn shortest_path(&mut self, row: usize) -> Option<(usize, f64)> {
        // Backwards, so that a constant matrix gives the diagonal.
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
