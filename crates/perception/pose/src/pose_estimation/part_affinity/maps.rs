//! The maps of one image, and their grid.

use opendr_engine::{Error, Result};

use super::layout::{FIELDS, HEAT_MAPS, JOINTS};

/// Cells over a network's input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Number of rows of cells.
    pub rows: usize,
    /// Number of columns of cells.
    pub columns: usize,
    /// Pixels per cell.
    pub stride: f32,
}

/// Position of the first cell: the centre of the first pixel, as of strided convolutions with symmetric padding.
const ORIGIN: f32 = 0.5;

impl Grid {
    /// Returns the number of cells.
    pub fn cells(&self) -> usize {
        self.rows * self.columns
    }

    /// Converts a position `[x, y]` in cells to pixels of the network's input.
    pub fn point_from_cell(&self, place: [f32; 2]) -> [f32; 2] {
        place.map(|part| part * self.stride + ORIGIN)
    }

    /// Converts a point `[x, y]` of the network's input to a position in cells.
    pub fn cell_from_point(&self, point: [f32; 2]) -> [f32; 2] {
        point.map(|part| (part - ORIGIN) / self.stride)
    }
}

/// Outputs of a network for one image.
#[derive(Debug, Clone, Copy)]
pub struct PartMaps<'a> {
    grid: Grid,
    heat: &'a [f32],
    fields: &'a [f32],
}

impl<'a> PartMaps<'a> {
    /// Creates maps from heatmaps `[19, rows, columns]`, of which the background may be missing, and fields
    /// `[38, rows, columns]`: x and y of each of [`LIMBS`](super::LIMBS).
    ///
    /// # Errors
    /// `Format` when the sizes do not fit.
    pub fn new(grid: Grid, heat: &'a [f32], fields: &'a [f32]) -> Result<Self> {
        let cells = grid.cells();
        let fits = [JOINTS, HEAT_MAPS].iter().any(|maps| Some(heat.len()) == cells.checked_mul(*maps))
            && Some(fields.len()) == cells.checked_mul(FIELDS);
        if cells == 0 || !fits {
            return Err(Error::format(format!(
                "{} and {} values are not {HEAT_MAPS} heatmaps and {FIELDS} fields of {} x {} cells; load another model",
                heat.len(),
                fields.len(),
                grid.columns,
                grid.rows
            )));
        }
        Ok(Self { grid, heat, fields })
    }

    /// Returns the grid of all maps.
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Returns the maximum of a cell's heatmaps without the background.
    pub fn max_heat(&self, column: usize, row: usize) -> f32 {
        let cell = row * self.grid.columns + column;
        let joints = self.heat.chunks_exact(self.grid.cells()).take(JOINTS);
        joints.filter_map(|map| map.get(cell)).copied().fold(f32::NEG_INFINITY, f32::max)
    }

    pub(super) fn heat(&self, joint: usize) -> Plane<'a> {
        self.plane(self.heat, joint)
    }

    /// Returns x and y of the field of a limb.
    pub(super) fn field(&self, limb: usize) -> [Plane<'a>; 2] {
        [self.plane(self.fields, 2 * limb), self.plane(self.fields, 2 * limb + 1)]
    }

    fn plane(&self, maps: &'a [f32], number: usize) -> Plane<'a> {
        let cells = self.grid.cells();
        let values = &maps[number * cells..(number + 1) * cells];
        Plane { values, rows: self.grid.rows, columns: self.grid.columns }
    }
}

/// One map.
#[derive(Clone, Copy)]
pub(super) struct Plane<'a> {
    pub(super) values: &'a [f32],
    pub(super) rows: usize,
    pub(super) columns: usize,
}

impl Plane<'_> {
    /// Returns the value of a cell; beyond the border that of the nearest.
    pub(super) fn at(&self, x: isize, y: isize) -> f32 {
        let inside = |at: isize, count: usize| at.clamp(0, count as isize - 1) as usize;
        self.values[inside(y, self.rows) * self.columns + inside(x, self.columns)]
    }

    /// Interpolates between the four cells around a position in cells; beyond the border as at the border.
    pub(super) fn between(&self, [x, y]: [f32; 2]) -> f32 {
        let (x, right, left_part) = between(x, self.columns);
        let (y, lower, upper_part) = between(y, self.rows);
        let row = |row: usize| {
            let row = &self.values[row * self.columns..(row + 1) * self.columns];
            row[x] + left_part * (row[right] - row[x])
        };
        let upper = row(y);
        upper + upper_part * (row(lower) - upper)
    }
}

/// Returns the cell before a position, the one after, and the fraction between them.
fn between(place: f32, count: usize) -> (usize, usize, f32) {
    // The maximum of NaN and 0 is 0.
    let place = place.max(0.0).min((count - 1) as f32);
    let before = place as usize;
    (before, (before + 1).min(count - 1), place - before as f32)
}
