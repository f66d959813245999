//! The map of a flight as cells around the drone.

use super::{HALF_TRACK, HALF_WIDTH, RANGE, SIDE};

/// An image of the depth camera at the height of the flight, and from where it was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Glimpse {
    pub place: [f32; 2],
    /// Sine and cosine of the yaw.
    pub sine: f32,
    pub cosine: f32,
    /// Metres ahead to the nearest thing in each column; [`RANGE`] where there is none.
    pub ahead: [f32; SIDE],
}

/// What is known of each cell: how near the nearest seen point is, and how far behind a front it lies.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MapRaster {
    /// Metres behind the front in the image in which that is least; below zero before it; NaN in no picture.
    shadow: Vec<f32>,
    /// Metres to the nearest point, at most [`FAR`].
    clearance: Vec<f32>,
    /// How far the drone is to the left of the middle.
    offset: f32,
}

/// The side of a cell, metres; cells before, behind, and to each side of the drone's.
pub(super) const CELL: f32 = 0.2;
pub(super) const AHEAD: usize = 50;
pub(super) const BEHIND: usize = 5;
pub(super) const ASIDE: usize = 25;
pub(super) const COLUMNS: usize = BEHIND + 1 + AHEAD;
pub(super) const ROWS: usize = 2 * ASIDE + 1;
pub(super) const CELLS: usize = COLUMNS * ROWS;
/// Cells of a patch to each side of its middle, and how many cells lie between two of them.
const PATCH: usize = 2;
const STRIDE: usize = 2;
const PATCH_CELLS: usize = (2 * PATCH + 1) * (2 * PATCH + 1);
/// Features of a cell: six of its own, clearance and shadow of the patch.
pub(super) const FEATURES: usize = 6 + 2 * PATCH_CELLS;
const FAR: f32 = 2.0;
/// Cells so far from any point, and seen to be so far before every front, are free; metres.
const CLEAR: f32 = 0.85;

impl Default for MapRaster {
    fn default() -> Self {
        Self { shadow: vec![f32::NAN; CELLS], clearance: vec![FAR; CELLS], offset: 0.0 }
    }
}

impl MapRaster {
    /// Draws the map around a drone at `place`, from pictures and from `points` around it, along the corridor and to the left.
    pub fn draw(&mut self, glimpses: &[Glimpse], points: &[[f32; 2]], place: [f32; 2]) {
        self.offset = place[1];
        for (cell, shadow) in self.shadow.iter_mut().enumerate() {
            let [ahead, left] = centre(cell);
            let at = [place[0] + ahead, place[1] + left];
            let behind = glimpses.iter().filter_map(|glimpse| glimpse.behind_front(at));
            *shadow = behind.reduce(f32::min).map_or(f32::NAN, |metres| metres.max(-1.0));
        }
        self.clearance.fill(FAR);
        for [ahead, left] in points {
            let (column, row) = (ahead / CELL + BEHIND as f32 + 0.5, left / CELL + ASIDE as f32 + 0.5);
            if (0.0..COLUMNS as f32).contains(&column) && (0.0..ROWS as f32).contains(&row) {
                self.clearance[column as usize * ROWS + row as usize] = 0.0;
            }
        }
        self.spread(1);
        self.spread(-1);
    }

    /// A pass of the chamfer distance (Rosenfeld and Pfaltz, 1966), from the first cell to the last or back.
    fn spread(&mut self, way: isize) {
        const DIAGONAL: f32 = CELL * std::f32::consts::SQRT_2;
        const BEFORE: [(isize, isize, f32); 4] =
            [(0, -1, CELL), (-1, 0, CELL), (-1, -1, DIAGONAL), (-1, 1, DIAGONAL)];
        for number in 0..CELLS {
            let cell = if way > 0 { number } else { CELLS - 1 - number };
            let (column, row) = (cell / ROWS, cell % ROWS);
            let mut least = self.clearance[cell];
            for (columns, rows, far) in BEFORE {
                let beside = column.checked_add_signed(way * columns).zip(row.checked_add_signed(way * rows));
                if let Some((column, row)) = beside.filter(|(column, row)| *column < COLUMNS && *row < ROWS) {
                    least = least.min(self.clearance[column * ROWS + row] + far);
                }
            }
            self.clearance[cell] = least;
        }
    }

    /// Returns the distance of a row from the middle of the corridor, positive to the left.
    pub fn side(&self, row: usize) -> f32 {
        self.offset + (row as f32 - ASIDE as f32) * CELL
    }

    /// Returns whether the cell and its neighbours were observed to be free.
    pub fn is_clear(&self, cell: usize) -> bool {
        self.clearance[cell] > CLEAR && self.shadow[cell] < -CLEAR
    }

    /// Writes the features of a cell.
    pub fn features(&self, cell: usize, features: &mut [f32; FEATURES]) {
        let (column, row, shadow) = (cell / ROWS, cell % ROWS, self.shadow[cell]);
        let (own, patch) = features.split_at_mut(6);
        own.copy_from_slice(&[
            if shadow.is_nan() { 0.0 } else { shadow.min(3.0) * 0.5 },
            f32::from(shadow.is_nan()),
            self.clearance[cell],
            f32::from(shadow < -0.1),
            self.side(row).abs() / HALF_TRACK,
            (column as f32 - BEHIND as f32) / AHEAD as f32,
        ]);
        let (clearances, shadows) = patch.split_at_mut(PATCH_CELLS);
        let near = |at: usize, number: usize, count: usize| {
            (at + STRIDE * number).saturating_sub(STRIDE * PATCH).min(count - 1)
        };
        for (at, (clearance, shadow)) in clearances.iter_mut().zip(shadows).enumerate() {
            let column = near(column, at / (2 * PATCH + 1), COLUMNS);
            let other = column * ROWS + near(row, at % (2 * PATCH + 1), ROWS);
            *clearance = (1.0 - 2.0 * self.clearance[other]).max(0.0);
            let behind = self.shadow[other];
            *shadow = if behind.is_nan() { 0.5 } else { (behind + 0.1).clamp(-0.5, 1.0) };
        }
    }
}

/// Metres from the drone to the centre of a cell, ahead and left.
pub(super) fn centre(cell: usize) -> [f32; 2] {
    [(cell / ROWS) as f32 - BEHIND as f32, (cell % ROWS) as f32 - ASIDE as f32].map(|cells| cells * CELL)
}

impl Glimpse {
    /// How far behind the nearest front a place lies; none where the image does not show its direction.
    fn behind_front(&self, [x, y]: [f32; 2]) -> Option<f32> {
        let (east, north) = (x - self.place[0], y - self.place[1]);
        let ahead = self.cosine * east + self.sine * north;
        let left = self.cosine * north - self.sine * east;
        let half = ahead * HALF_WIDTH;
        let is_shown = ahead > 0.05 && left.abs() < half;
        let column = (1.0 - left / half) * 0.5 * SIDE as f32;
        is_shown.then(|| ahead - self.ahead[(column as usize).min(SIDE - 1)])
    }
}

impl Default for Glimpse {
    fn default() -> Self {
        Self { place: [0.0; 2], sine: 0.0, cosine: 1.0, ahead: [RANGE; SIDE] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(ahead: f32, left: f32) -> usize {
        let (column, row) = (ahead / CELL + BEHIND as f32, left / CELL + ASIDE as f32);
        column.round() as usize * ROWS + row.round() as usize
    }

    #[test]
    fn fronts_throw_shadows() {
        let mut glimpse = Glimpse { place: [7.0, 1.0], ..Glimpse::default() };
        // A thing 3 m ahead in the left half of the image.
        glimpse.ahead[..SIDE / 2].fill(3.0);
        let mut raster = MapRaster::default();
        raster.draw(&[glimpse], &[[3.0, 0.6]], [7.0, 1.0]);
        assert!((raster.shadow[cell(5.0, 1.0)] - 2.0).abs() < 1e-3);
        assert!((raster.shadow[cell(2.2, 0.4)] + 0.8).abs() < 1e-3);
        assert_eq!(raster.shadow[cell(5.0, -1.0)], -1.0);
        assert!(raster.shadow[cell(-0.4, 0.0)].is_nan() && raster.shadow[cell(1.0, 2.0)].is_nan());
        assert_eq!(raster.clearance[cell(3.0, 0.6)], 0.0);
        assert!((raster.clearance[cell(3.0, -0.4)] - 1.0).abs() < 1e-3);
        assert!((raster.clearance[cell(2.0, 1.6)] - 2.0f32.sqrt()).abs() < 1e-3);
        assert!(raster.is_clear(cell(4.0, -0.8)) && !raster.is_clear(cell(3.0, 0.0)));
        assert!((raster.side(ASIDE + 5) - 2.0).abs() < 1e-6);
    }

    #[test]
    fn features_are_of_the_cell_and_its_patch() {
        let mut raster = MapRaster::default();
        let middle = cell(2.0, 0.0);
        raster.clearance[middle] = 0.0;
        raster.shadow[middle + 2] = 0.4;
        let mut features = [9.0; FEATURES];
        raster.features(middle, &mut features);
        assert_eq!(features[..4], [0.0, 1.0, 0.0, 0.0]);
        // The middle of the patch, and the shadow to its left.
        assert_eq!((features[6 + 12], features[6 + 11]), (1.0, 0.0));
        assert_eq!((features[31 + 13], features[31 + 12]), (0.5, 0.5));
        raster.shadow[middle + 2] = -0.3;
        raster.features(middle, &mut features);
        assert!((features[31 + 13] + 0.2).abs() < 1e-6);
    }
}
