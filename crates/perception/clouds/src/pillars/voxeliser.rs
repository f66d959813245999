//! Assignment of points to pillars.

use super::PillarGrid;

/// A point with its pillar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PillarPoint {
    /// Index of its pillar, in the order in which pillars first occur.
    pub pillar: u32,
    /// Features for a network, about -1 to 1: offset in the cell (x, y), height, distance.
    pub features: [f32; Self::FEATURES],
}

impl PillarPoint {
    /// Number of features of a point.
    pub const FEATURES: usize = 4;
}

/// Sorts points into the pillars of a grid.
///
/// Costs one step per point, and between frames one per occupied pillar. Pillars keep sums, so the number of points of a pillar
/// is not limited.
#[derive(Debug, Default)]
pub struct Voxeliser {
    /// Pillar of every cell, plus one; 0 for none.
    numbers: Vec<u32>,
    cells: Vec<u32>,
    sums: Vec<[f32; 4]>,
}

impl Voxeliser {
    /// Number of statistics of a pillar: the number of its points, and their mean (x, y, z).
    pub const STATISTICS: usize = 4;

    /// Starts a new frame.
    pub fn begin(&mut self, grid: &PillarGrid) {
        if self.numbers.len() == grid.cells() {
            for cell in &self.cells {
                self.numbers[*cell as usize] = 0;
            }
        } else {
            self.numbers.clear();
            self.numbers.resize(grid.cells(), 0);
        }
        self.cells.clear();
        self.sums.clear();
    }

    /// Adds a point (x, y, z, ...); `None` for one outside of the grid or not finite.
    #[inline]
    pub fn add(&mut self, grid: &PillarGrid, point: &[f32]) -> Option<PillarPoint> {
        let [x, y, z, ..] = *point else { return None };
        let place = grid.cell([x, y, z])?;
        let [middle_x, middle_y] = grid.middle(place);
        let cell = place[1] * grid.columns() as u32 + place[0];
        let number = self.numbers.get_mut(cell as usize)?;
        if *number == 0 {
            self.cells.push(cell);
            self.sums.push([0.0; 4]);
            *number = self.cells.len() as u32;
        }
        let pillar = *number - 1;
        let half = grid.side / 2.0;
        let height = 2.0 * (z - grid.z[0]) / (grid.z[1] - grid.z[0]) - 1.0;
        let [dx, dy] = [(x - middle_x) / half, (y - middle_y) / half];
        if let Some(sums) = self.sums.get_mut(pillar as usize) {
            *sums = [sums[0] + 1.0, sums[1] + dx, sums[2] + dy, sums[3] + height];
        }
        let far = (grid.x[1] - grid.x[0]).max(grid.y[1] - grid.y[0]);
        Some(PillarPoint { pillar, features: [dx, dy, height, 2.0 * (x * x + y * y).sqrt() / far - 1.0] })
    }

    /// Returns the cell (row-major) of every pillar.
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// Returns the statistics of every pillar: the logarithm of the number of its points, and their mean.
    pub fn statistics(&self) -> impl ExactSizeIterator<Item = [f32; Self::STATISTICS]> + '_ {
        self.sums.iter().map(|[count, x, y, z]| [0.25 * count.ln(), x / count, y / count, z / count])
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Random;

    use super::*;

    const GRID: PillarGrid = PillarGrid { x: [0.0, 8.0], y: [-4.0, 4.0], z: [-3.0, 1.0], side: 0.5 };

    #[test]
    fn points_by_hand() {
        let mut voxeliser = Voxeliser::default();
        voxeliser.begin(&GRID);
        // Column 2, row 8; the centre is 1.25, 0.25.
        let first = voxeliser.add(&GRID, &[1.25, 0.25, -1.0, 0.9]).unwrap();
        assert_eq!((first.pillar, &first.features[..3]), (0, &[0.0, 0.0, 0.0][..]));
        assert!((first.features[3] - (2.0 * 1.25f32.hypot(0.25) / 8.0 - 1.0)).abs() < 1e-6);
        assert_eq!(voxeliser.add(&GRID, &[5.0, 0.0, 0.0]).unwrap().pillar, 1);
        assert_eq!(voxeliser.add(&GRID, &[1.375, 0.125, 0.0]).unwrap().features[..3], [0.5, -0.5, 0.5]);
        assert_eq!(voxeliser.add(&GRID, &[1.0, 0.0]), None);
        assert_eq!(voxeliser.cells(), [8 * 16 + 2, 8 * 16 + 10]);
        let [first, second] = voxeliser.statistics().collect::<Vec<_>>()[..] else { panic!() };
        assert_eq!(first, [0.25 * 2f32.ln(), 0.25, -0.25, 0.25]);
        assert_eq!(second[0], 0.0);
        voxeliser.begin(&GRID);
        assert_eq!(voxeliser.add(&GRID, &[5.0, 0.0, 0.0]).unwrap().pillar, 0);
        assert_eq!(voxeliser.cells(), [8 * 16 + 10]);
    }

    /// Clouds of 0, 1 and 5 million points, some of them not finite.
    #[test]
    fn any_number_of_any_points() {
        let mut voxeliser = Voxeliser::default();
        let mut random = Random::new(3);
        for count in [0, 1, 5_000_000] {
            voxeliser.begin(&GRID);
            let mut inside = 0;
            for at in 0..count {
                let mut number = || match at % 97 {
                    0 => f32::NAN,
                    1 => f32::INFINITY,
                    2 => f32::NEG_INFINITY,
                    3 => f32::MAX,
                    _ => random.uniform(-5.0, 9.0),
                };
                let point = [number(), number(), number()];
                let taken = voxeliser.add(&GRID, &point);
                inside += usize::from(taken.is_some());
                assert!(taken.is_none_or(|taken| taken.features.iter().all(|part| part.is_finite())));
            }
            assert!(voxeliser.cells().len() <= GRID.cells());
            let all: f32 = voxeliser.statistics().map(|statistics| (4.0 * statistics[0]).exp()).sum();
            assert!((all - inside as f32).abs() <= 1e-3 * inside as f32);
            assert!(voxeliser.statistics().flatten().all(|statistics| statistics.is_finite()));
        }
        assert_eq!(voxeliser.cells().len(), GRID.cells());
    }
}
