//! Cells of a square grid by index, and places in metres.

use super::{CELL, SIDE};

/// Number of cells.
pub(super) const CELLS: usize = SIDE * SIDE;

/// Returns the index of a cell; none outside the grid.
pub(super) fn index([x, y]: [i32; 2]) -> Option<usize> {
    let inside = |at: i32| usize::try_from(at).ok().filter(|at| *at < SIDE);
    Some(inside(y)? * SIDE + inside(x)?)
}

/// Returns column and row of a cell.
pub(super) fn column_row(index: usize) -> [i32; 2] {
    [(index % SIDE) as i32, (index / SIDE) as i32]
}

/// Returns the middle of a cell, in metres.
pub(super) fn middle(index: usize) -> [f64; 2] {
    column_row(index).map(|at| (f64::from(at) + 0.5) * CELL)
}

/// Returns column and row of a place in metres.
pub(super) fn column_row_of(place: [f64; 2]) -> [i32; 2] {
    place.map(|part| (part / CELL).floor() as i32)
}

/// Returns the cell of a place; none outside the grid.
pub(super) fn cell_of(place: [f64; 2]) -> Option<usize> {
    index(column_row_of(place))
}

/// Calls `visit` for every cell of the grid within `radius` cells of a cell.
pub(super) fn disc(centre: usize, radius: f64, mut visit: impl FnMut(usize)) {
    let ([x, y], reach) = (column_row(centre), radius as i32);
    for down in -reach..=reach {
        for right in -reach..=reach {
            if f64::from(down * down + right * right) <= radius * radius
                && let Some(cell) = index([x + right, y + down])
            {
                visit(cell);
            }
        }
    }
}

/// Returns the distance between two places.
pub(super) fn distance(one: [f64; 2], other: [f64; 2]) -> f64 {
    let [x, y] = [one[0] - other[0], one[1] - other[1]];
    (x * x + y * y).sqrt()
}

/// Returns the cells next to a cell in the four directions.
pub(super) fn beside(cell: usize) -> impl Iterator<Item = usize> {
    let [x, y] = column_row(cell);
    [[1, 0], [-1, 0], [0, 1], [0, -1]]
        .into_iter()
        .filter_map(move |[right, down]| index([x + right, y + down]))
}
