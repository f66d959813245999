//! Costs of flying on from the cells around the drone.

use super::map_raster::{ASIDE, BEHIND, CELL, COLUMNS, ROWS};
use super::{HALF_TRACK, RADIUS};

/// Costs of paths from cells around the drone to the end of the map, in metres of free path. They are computed backwards, column by
/// column, for paths that never turn back (dynamic programming; Bellman, 1957). Unobserved cells are free.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WayCosts {
    /// Cost of a metre in each cell, column by column.
    weights: Vec<f32>,
    costs: Vec<f32>,
    /// Cells that contain points, and their indices.
    is_marked: Vec<bool>,
    marked: Vec<usize>,
}

/// Distances to a point below which a cell is blocked or narrow, and the cost of such a cell.
pub(super) const BLOCKED: (f32, f32) = (RADIUS + 0.05, 10.0);
const NARROW: (f32, f32) = (RADIUS + 0.3, 2.0);
/// Radius, in cells, within which a point affects costs.
const SPREAD: usize = 3;

impl Default for WayCosts {
    fn default() -> Self {
        let cells = COLUMNS * ROWS;
        Self {
            weights: vec![1.0; cells],
            costs: vec![0.0; cells],
            is_marked: vec![false; cells],
            marked: Vec::with_capacity(cells),
        }
    }
}

impl WayCosts {
    /// Computes the costs for points given relative to the drone, along the corridor and to the left. The drone is `offset` to the left of
    /// the middle and has `left` metres to go.
    pub fn find(&mut self, points: impl Iterator<Item = [f32; 2]>, offset: f32, left: f32) {
        self.mark(points);
        self.weights.fill(1.0);
        for (row, side) in (0..ROWS).map(|row| (row, offset + (row as f32 - ASIDE as f32) * CELL)) {
            if side.abs() > HALF_TRACK - BLOCKED.0 {
                (0..COLUMNS).for_each(|column| self.weights[column * ROWS + row] = BLOCKED.1);
            }
        }
        for marked in std::mem::take(&mut self.marked) {
            self.spread(marked / ROWS, marked % ROWS);
        }
        self.fly_back(left);
    }

    /// Computes the costs where `weigh` writes the cost of a metre in each cell, column by column, with `left` metres to go.
    pub fn find_weighted(&mut self, left: f32, weigh: impl FnOnce(&mut [f32])) {
        weigh(&mut self.weights);
        self.fly_back(left);
    }

    fn mark(&mut self, points: impl Iterator<Item = [f32; 2]>) {
        self.is_marked.fill(false);
        self.marked.clear();
        for [ahead, left] in points {
            let cell = |metres: f32, before: usize| (metres / CELL + before as f32 + 0.5).floor();
            let (column, row) = (cell(ahead, BEHIND), cell(left, ASIDE));
            if (0.0..COLUMNS as f32).contains(&column) && (0.0..ROWS as f32).contains(&row) {
                let at = column as usize * ROWS + row as usize;
                if !std::mem::replace(&mut self.is_marked[at], true) {
                    self.marked.push(at);
                }
            }
        }
    }

    /// Raises the costs of the cells around an occupied one.
    fn spread(&mut self, column: usize, row: usize) {
        let around = |at: usize, count: usize| at.saturating_sub(SPREAD)..(at + SPREAD + 1).min(count);
        for other in around(column, COLUMNS) {
            for beside in around(row, ROWS) {
                let cells = [other.abs_diff(column), beside.abs_diff(row)].map(|cells| cells as f32 * CELL);
                let away = cells[0] * cells[0] + cells[1] * cells[1];
                let weight = match away {
                    _ if away < BLOCKED.0 * BLOCKED.0 => BLOCKED.1,
                    _ if away < NARROW.0 * NARROW.0 => NARROW.1,
                    _ => 1.0,
                };
                let own = &mut self.weights[other * ROWS + beside];
                *own = own.max(weight);
            }
        }
    }

    /// Computes the costs of each column from those of the next one.
    fn fly_back(&mut self, left: f32) {
        const DIAGONAL: f32 = std::f32::consts::SQRT_2 * CELL;
        self.costs.fill(0.0);
        let last = ((left / CELL).max(0.0) as usize + BEHIND + 1).min(COLUMNS - 1);
        for column in (0..last).rev() {
            let (before, behind) = self.costs.split_at_mut((column + 1) * ROWS);
            let (own, next) = (&mut before[column * ROWS..], &behind[..ROWS]);
            let weights = &self.weights[column * ROWS..(column + 1) * ROWS];
            for row in 0..ROWS {
                let diagonal = next[row.saturating_sub(1)].min(next[(row + 1).min(ROWS - 1)]);
                own[row] = (next[row] + weights[row] * CELL).min(diagonal + weights[row] * DIAGONAL);
            }
            for row in 1..ROWS {
                own[row] = own[row].min(own[row - 1] + weights[row] * CELL);
            }
            for row in (0..ROWS - 1).rev() {
                own[row] = own[row].min(own[row + 1] + weights[row] * CELL);
            }
        }
    }

    /// Returns the cost of a metre at a place, ahead and left of the drone.
    pub fn weight(&self, [ahead, left]: [f32; 2]) -> f32 {
        let cell = |metres: f32, before: usize, count: usize| {
            // Negative numbers saturate at 0.
            ((metres / CELL + before as f32 + 0.5) as usize).min(count - 1)
        };
        self.weights[cell(ahead, BEHIND, COLUMNS) * ROWS + cell(left, ASIDE, ROWS)]
    }

    /// Returns the cost of flying on from a place, ahead and left of the drone, interpolated between cells.
    pub fn at(&self, [ahead, left]: [f32; 2]) -> f32 {
        let place = |metres: f32, before: usize, count: usize| {
            let cells = (metres / CELL + before as f32).clamp(0.0, count as f32 - 1.001);
            (cells as usize, cells.fract())
        };
        let ((column, x), (row, y)) = (place(ahead, BEHIND, COLUMNS), place(left, ASIDE, ROWS));
        let within = |column: usize| {
            let costs = &self.costs[column * ROWS + row..];
            costs[0] * (1.0 - y) + costs[1] * y
        };
        within(column) * (1.0 - x) + within(column + 1) * x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_lead_around_walls() {
        let mut costs = WayCosts::default();
        costs.find(std::iter::empty(), 0.0, 30.0);
        assert!((costs.at([0.0; 2]) - 10.0).abs() < 1e-3, "{}", costs.at([0.0; 2]));
        assert!((costs.at([1.0, 0.5]) - 9.0).abs() < 1e-3);
        // A wall 4 m ahead, from 1 m to the right to the left border.
        let wall = || (0..60).map(|step| [4.0, 0.1 * step as f32 - 1.0]);
        costs.find(wall(), 0.0, 30.0);
        let (left, right) = (costs.at([1.0, 1.0]), costs.at([1.0, -1.0]));
        assert!(right < left && right > 9.2 && left < 12.0, "{left} {right}");
        // Beyond the finish everything is free.
        costs.find(wall(), 0.0, 3.0);
        assert!((2.5..3.5).contains(&costs.at([0.0; 2])), "{}", costs.at([0.0; 2]));
        costs.find(std::iter::empty(), 4.5, 30.0);
        assert!(costs.at([0.0, 0.4]) > costs.at([0.0, -1.0]) + 1.0);
    }
}
