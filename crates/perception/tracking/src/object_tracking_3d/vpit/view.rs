//! Views: pseudo images of the pillars around a position, in the object's frame.

use opendr_clouds::pillars::{Voxeliser, scatter};
use opendr_engine::data::PointCloud;

use super::layout::{CHANNELS, VIEW, VpitLayout};

/// Voxelises views; its memory is reused.
#[derive(Default)]
pub(super) struct ViewPainter {
    /// Points near a position, relative to it.
    near: Vec<[f32; 3]>,
    voxeliser: Voxeliser,
    pillars: Vec<f32>,
    heights: Vec<f32>,
}

/// Number of values of a view.
pub(super) const VIEW_LEN: usize = CHANNELS * VIEW * VIEW;
/// Minimum number of an object's points for its height.
const LEAST_POINTS: usize = 5;
/// Height above the bottom of a box below which points are ground, in metres.
const GROUND: f32 = 0.25;

impl ViewPainter {
    /// Selects the points of any view with its centre at `center`, in the lidar's frame.
    pub fn gather(&mut self, layout: &VpitLayout, cloud: &PointCloud, center: [f64; 3]) {
        let center = center.map(|part| part as f32);
        let [low, high] = layout.heights;
        let reach = layout.pillar * VIEW as f32 / 2.0 * std::f32::consts::SQRT_2;
        self.near.clear();
        self.near.extend(cloud.points().filter_map(|point| {
            let [x, y, z, ..] = *point else { return None };
            let [x, y, z] = [x - center[0], y - center[1], z - center[2]];
            // Comparisons with NaN are false.
            ((x.abs() < reach) & (y.abs() < reach) & (z >= low) & (z < high)).then_some([x, y, z])
        }));
    }

    /// Returns whether any point was selected.
    pub fn has_points(&self) -> bool {
        !self.near.is_empty()
    }

    /// Voxelises the selected points in a frame with x along `yaw`, `[channels, rows, columns]`: rows from right to left,
    /// columns from back to front.
    pub fn paint(&mut self, layout: &VpitLayout, yaw: f64, canvas: &mut [f32]) {
        let grid = layout.grid();
        let (sin, cos) = (yaw.sin() as f32, yaw.cos() as f32);
        self.voxeliser.begin(&grid);
        for [x, y, z] in &self.near {
            self.voxeliser.add(&grid, &[cos * x + sin * y, cos * y - sin * x, *z]);
        }
        self.pillars.clear();
        for values in self.voxeliser.statistics() {
            self.pillars.push(1.0);
            self.pillars.extend(values);
        }
        scatter(&self.pillars, CHANNELS, self.voxeliser.cells(), canvas);
    }

    /// Returns the 90 % quantile of the heights of the points in a box of this length and width, at `offset` from the
    /// centre of the selection. `None` when it has few points.
    pub fn top(&mut self, [length, width]: [f64; 2], offset: [f64; 2], yaw: f64) -> Option<f32> {
        let (sin, cos) = (yaw.sin() as f32, yaw.cos() as f32);
        let [dx, dy] = offset.map(|part| part as f32);
        let (ahead, aside) = ((length / 2.0) as f32, (width / 2.0) as f32);
        self.heights.clear();
        self.heights.extend(self.near.iter().filter_map(|[x, y, z]| {
            let (x, y) = (x - dx, y - dy);
            let is_within = (cos * x + sin * y).abs() < ahead && (cos * y - sin * x).abs() < aside;
            (is_within && *z > GROUND).then_some(*z)
        }));
        if self.heights.len() < LEAST_POINTS {
            return None;
        }
        let at = self.heights.len() * 9 / 10;
        Some(*self.heights.select_nth_unstable_by(at, f32::total_cmp).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAYOUT: VpitLayout = VpitLayout { pillar: 0.2, heights: [-0.5, 3.0], scale: 1.0, bias: 0.0 };

    #[test]
    fn a_view_rotates_with_its_object() {
        let mut painter = ViewPainter::default();
        // One metre in front of an object at (10, 5) along y, one point far away and one that is not finite.
        let points = vec![10.0, 6.0, 0.5, 30.0, 5.0, 0.0, f32::NAN, 5.0, 0.0];
        let cloud = PointCloud::new(points, [3, 3]).unwrap();
        painter.gather(&LAYOUT, &cloud, [10.0, 5.0, 0.0]);
        let mut canvas = vec![9.0; VIEW_LEN];
        painter.paint(&LAYOUT, std::f64::consts::FRAC_PI_2 + 0.05, &mut canvas);
        let there: Vec<_> = (0..VIEW * VIEW).filter(|at| canvas[*at] == 1.0).collect();
        // 1 m in front is the pillar from 1.0 or up to it, a little to the right.
        assert_eq!(there.len(), 1);
        let [row, column] = [there[0] / VIEW, there[0] % VIEW];
        assert!((36..=37).contains(&column) && row == 31, "{row} {column}");
        assert!(canvas[VIEW * VIEW..].iter().all(|number| number.is_finite()));
        painter.gather(&LAYOUT, &cloud, [f64::NAN, 0.0, 0.0]);
        painter.paint(&LAYOUT, 0.0, &mut canvas);
        assert!(canvas.iter().all(|number| *number == 0.0));
    }

    #[test]
    fn heights_are_those_of_the_box() {
        let mut painter = ViewPainter::default();
        let points: Vec<f32> = (0..20).flat_map(|at| [3.0, 0.1, at as f32 * 0.1]).collect();
        let cloud = PointCloud::new(points, [20, 3]).unwrap();
        painter.gather(&LAYOUT, &cloud, [1.0, 0.0, 0.0]);
        let top = painter.top([1.0, 1.0], [2.0, 0.0], 0.3).unwrap();
        assert!((1.7..=1.9).contains(&top), "{top}");
        assert_eq!(painter.top([1.0, 1.0], [0.0, 0.0], 0.0), None);
    }
}
