//! Terrain as heights on a grid.

use opendr_engine::{Error, Result};

use super::triangle::Triangle;
use super::{Mesh, Vector};

/// Heights on a grid in the plane z = 0, centred on the origin, with two triangles per cell. Solid below the surface;
/// empty outside the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightField {
    heights: Vec<f32>,
    columns: usize,
    rows: usize,
    spacing: f32,
    surface: Mesh,
}

impl HeightField {
    /// Creates a field from heights in metres, in rows along x from the smallest y; points are `spacing` metres apart.
    ///
    /// # Errors
    /// `InvalidInput` for fewer than two columns or rows, more than 2^20 points, a wrong number of heights, or a number that is
    /// not finite or not below 1e5.
    pub fn new(heights: &[f32], columns: usize, spacing: f32) -> Result<Self> {
        let rows = heights.len() / columns.max(1);
        let fits = columns >= 2 && rows >= 2 && rows * columns == heights.len() && heights.len() <= 1 << 20;
        let is_finite = heights.iter().all(|height| height.abs() < 1e5);
        let is_spaced = spacing > 0.0 && spacing < 1e3;
        if !(fits && is_finite && is_spaced) {
            return Err(Error::invalid_input(format!(
                "the field has {} heights in {columns} columns, {spacing} m apart; give at least 2 columns and rows, at most 2^20 heights below 1e5 and a spacing below 1e3",
                heights.len()
            )));
        }
        let corner = |column: usize, row: usize| -> Vector {
            let from_middle = |at: usize, count: usize| (at as f32 - (count - 1) as f32 / 2.0) * spacing;
            [from_middle(column, columns), from_middle(row, rows), heights[row * columns + column]]
        };
        let mut triangles = Vec::with_capacity(2 * (columns - 1) * (rows - 1));
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                let [a, b] = [corner(column, row), corner(column + 1, row)];
                let [c, d] = [corner(column, row + 1), corner(column + 1, row + 1)];
                triangles.extend([Triangle::new([a, b, d]), Triangle::new([a, d, c])]);
            }
        }
        let surface = Mesh::of(triangles);
        Ok(Self { heights: heights.to_vec(), columns, rows, spacing, surface })
    }

    /// Returns the height at a point of the plane; `None` outside the grid.
    pub fn height(&self, x: f32, y: f32) -> Option<f32> {
        let place = |at: f32, count: usize| {
            let cells = (count - 1) as f32;
            let at = at / self.spacing + cells / 2.0;
            (0.0..=cells).contains(&at).then(|| {
                let cell = at.floor().min(cells - 1.0);
                (cell as usize, at - cell)
            })
        };
        let ((column, u), (row, v)) = (place(x, self.columns)?, place(y, self.rows)?);
        let height = |right: usize, up: usize| self.heights[(row + up) * self.columns + column + right];
        let (a, d) = (height(0, 0), height(1, 1));
        Some(match u >= v {
            true => a + u * (height(1, 0) - a) + v * (d - height(1, 0)),
            false => a + v * (height(0, 1) - a) + u * (d - height(0, 1)),
        })
    }

    /// Returns the distance of a point from the surface; negative below.
    pub fn distance(&self, point: Vector) -> f32 {
        let distance = self.surface.distance(point);
        let is_below = self.height(point[0], point[1]).is_some_and(|height| point[2] < height);
        if is_below { -distance } else { distance }
    }

    pub(super) fn surface(&self) -> &Mesh {
        &self.surface
    }
}
