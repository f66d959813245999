//! Corners on a grid.

use super::pyramid::Level;

/// Finds corners: the pixel of the largest smaller eigenvalue of the gradients' moments in each free cell (J. Shi and C. Tomasi, Good
/// features to track, 1994).
#[derive(Debug, Default)]
pub(crate) struct CornerFinder {
    occupied: Vec<bool>,
    /// Products of gradients, and their sums along rows, of one cell.
    products: Vec<[f32; 3]>,
    sums: Vec<[f32; 3]>,
}

/// Half side of the window of moments.
const HALF: usize = 3;
/// Distance of corners from the border: the window of the optical flow fits on the level of half the size.
const BORDER: usize = 20;
/// Smaller eigenvalue, per pixel of the window, below which there is only noise: squares of grey levels per pixel.
const FLOOR: f32 = 8.0;

impl CornerFinder {
    /// Appends corners to `corners` until there is one in each cell of `side` pixels, or `most`; cells of `taken` are left out.
    pub fn find(
        &mut self,
        level: &Level,
        side: usize,
        taken: impl Iterator<Item = [f32; 2]>,
        most: usize,
        corners: &mut Vec<[f32; 2]>,
    ) {
        let [columns, rows] =
            [level.width, level.height].map(|pixels| pixels.saturating_sub(2 * BORDER) / side);
        self.occupied.clear();
        self.occupied.resize(columns * rows, false);
        for [x, y] in taken {
            let [column, row] = [x, y].map(|at| (at.max(0.0) as usize).saturating_sub(BORDER) / side);
            if column < columns && row < rows {
                self.occupied[row * columns + column] = true;
            }
        }
        // Cells are visited in an order that spreads a limited number over the image.
        let cells = columns * rows;
        let stride =
            (0..).map(|more| cells * 5 / 13 + 1 + more).find(|stride| divisor(*stride, cells.max(1)) == 1);
        let stride = stride.unwrap_or(1);
        for number in 0..cells {
            if corners.len() >= most {
                return;
            }
            let cell = number * stride % cells;
            if !self.occupied[cell] {
                let from = [BORDER + cell % columns * side, BORDER + cell / columns * side];
                corners.extend(self.strongest(level, from, side));
            }
        }
    }

    fn strongest(&mut self, level: &Level, [left, top]: [usize; 2], side: usize) -> Option<[f32; 2]> {
        let across = side + 2 * HALF;
        self.products.clear();
        for y in top - HALF..top + side + HALF {
            let at = |row: usize| &level.luminance[row * level.width + left - HALF - 1..][..across + 2];
            let (above, own, below) = (at(y - 1), at(y), at(y + 1));
            self.products.extend((1..=across).map(|x| {
                let [dx, dy] = [0.5 * (own[x + 1] - own[x - 1]), 0.5 * (below[x] - above[x])];
                [dx * dx, dx * dy, dy * dy]
            }));
        }
        self.sums.clear();
        for row in self.products.chunks_exact(across) {
            self.sums.extend(row.windows(2 * HALF + 1).map(|window| {
                window.iter().fold([0.0; 3], |sum, part| std::array::from_fn(|at| sum[at] + part[at]))
            }));
        }
        let mut best = (FLOOR * ((2 * HALF + 1) * (2 * HALF + 1)) as f32, None);
        for y in 0..side {
            for x in 0..side {
                let rows = (0..=2 * HALF).map(|row| self.sums[(y + row) * side + x]);
                let [a, b, c] = rows.fold([0.0; 3], |sum, part| std::array::from_fn(|at| sum[at] + part[at]));
                let smaller = 0.5 * (a + c - ((a - c) * (a - c) + 4.0 * b * b).sqrt());
                if smaller > best.0 {
                    best = (smaller, Some([(left + x) as f32, (top + y) as f32]));
                }
            }
        }
        best.1
    }
}

/// Returns the greatest common divisor.
fn divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { divisor(b, a % b) }
}
