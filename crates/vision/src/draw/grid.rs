//! A map of scores stretched over an image.

/// Values `[height, width]` with bilinear interpolation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid<'a> {
    values: &'a [f32],
    width: usize,
    height: usize,
}

impl<'a> Grid<'a> {
    /// Returns `None` when there are not exactly `width * height` values, or none.
    pub(super) fn new(values: &'a [f32], [width, height]: [usize; 2]) -> Option<Self> {
        (width.checked_mul(height) == Some(values.len()) && !values.is_empty()).then_some(Self {
            values,
            width,
            height,
        })
    }

    pub(super) fn width(&self) -> f32 {
        self.width as f32
    }

    pub(super) fn height(&self) -> f32 {
        self.height as f32
    }

    /// Returns the interpolated value at a position (bilinear; cell `(0, 0)` has its centre at 0.5, 0.5) and its
    /// derivatives by `x` and `y`. Beyond the border the nearest position counts.
    pub(super) fn sample(&self, x: f32, y: f32) -> [f32; 3] {
        let [(left, right, dx), (top, bottom, dy)] = [between(x, self.width), between(y, self.height)];
        let at = |x: usize, y: usize| self.values.get(y * self.width + x).copied().unwrap_or(0.0);
        let [a, b, c, d] = [at(left, top), at(right, top), at(left, bottom), at(right, bottom)];
        let (upper, lower) = (a + (b - a) * dx, c + (d - c) * dx);
        let along_x = (b - a) + ((d - c) - (b - a)) * dy;
        [upper + (lower - upper) * dy, along_x, lower - upper]
    }
}

/// Returns the first of the two cells around a position, and the weight of the second.
fn between(place: f32, count: usize) -> (usize, usize, f32) {
    let place = (place - 0.5).clamp(0.0, (count - 1) as f32);
    let first = place as usize;
    (first, (first + 1).min(count - 1), place - first as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_between_cells_are_interpolated() {
        let grid = Grid::new(&[0.0, 1.0, 2.0, 5.0], [2, 2]).unwrap();
        assert_eq!(grid.sample(0.5, 0.5)[0], 0.0);
        assert_eq!(grid.sample(1.0, 1.0), [2.0, 2.0, 3.0]);
        assert_eq!(grid.sample(-9.0, 1.5)[0], 2.0);
        assert_eq!(grid.sample(1e30, 1e30)[0], 5.0);
        assert!(!grid.sample(f32::NAN, 0.5)[0].is_finite() || grid.sample(f32::NAN, 0.5)[0] == 0.0);
    }

    #[test]
    fn grids_of_wrong_size_are_none() {
        for size in [[3, 1], [0, 0], [usize::MAX, 2]] {
            assert!(Grid::new(&[0.0; 4], size).is_none(), "{size:?}");
        }
    }
}
