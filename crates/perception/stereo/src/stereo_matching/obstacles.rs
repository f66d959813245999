//! Boxes around obstacles on a floor, from a depth map.

use opendr_engine::target::BoundingBox3D;
use opendr_vision::components::{Components, Connectivity};
use opendr_vision::stereo::StereoCamera;

/// Criteria of an obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObstacleOptions {
    /// Height of the camera above the floor in metres.
    pub camera_height: f32,
    /// Pitch of the camera in radians, positive downwards.
    pub camera_pitch: f32,
    /// Minimum and maximum height above the floor in metres.
    pub heights: [f32; 2],
    /// Range ahead and to each side in metres.
    pub farthest: f32,
}

/// Detects obstacles; buffers are reused.
///
/// Points between the two heights are counted in the squares of a grid on the floor. Squares with at least a quarter of the
/// points that a surface of a square's size has at that distance are occupied, and connected occupied squares are an obstacle.
#[derive(Debug, Default)]
pub struct Obstacles {
    counts: Vec<u32>,
    components: Components,
    extents: Vec<Extent>,
}

/// Side of a square in metres.
const SIDE: f32 = 0.1;
/// Minimum share of a surface's points, and minimum number of points.
const SHARE: f32 = 0.25;
const LEAST: f32 = 4.0;

/// Extent of the points of an obstacle: x, y, z in metres, and pixels.
#[derive(Debug, Clone, Copy)]
struct Extent {
    low: [f32; 3],
    high: [f32; 3],
    pixels: [f32; 4],
}

impl Obstacles {
    /// Writes the obstacles in a depth map in metres, `width` per row, 0 for unknown: the nearest first, class 0, score 1, in
    /// the frame of a level camera at the same position: x right, y down, z ahead along the floor.
    pub fn find(
        &mut self,
        camera: &StereoCamera,
        depths: &[f32],
        width: usize,
        options: &ObstacleOptions,
        boxes: &mut Vec<BoundingBox3D>,
    ) {
        boxes.clear();
        let farthest = options.farthest.clamp(SIDE, 100.0);
        let rows = (farthest / SIDE).ceil() as usize;
        let columns = 2 * rows;
        let (sine, cosine) = options.camera_pitch.sin_cos();
        // Position and square of a pixel that may belong to an obstacle.
        let seen = |at: usize| {
            let (x, y) = (at % width, at / width);
            let [right, below, depth] = camera.point([x as f32 + 0.5, y as f32 + 0.5], depths[at]);
            let place = [right, below * cosine + depth * sine, depth * cosine - below * sine];
            let ahead = place[2];
            let height = options.camera_height - place[1];
            let [lowest, highest] = options.heights;
            let is_near = depth > 0.0 && ahead > 0.0 && ahead < farthest;
            let counts = is_near && height >= lowest && height <= highest;
            let column = (place[0] + farthest) / SIDE;
            let is_beside = !(column >= 0.0 && column < columns as f32);
            if !counts || is_beside {
                return None;
            }
            Some((place, ((ahead / SIDE) as usize).min(rows - 1) * columns + column as usize))
        };
        self.counts.clear();
        self.counts.resize(rows * columns, 0);
        for at in 0..depths.len() {
            if let Some((_, square)) = seen(at) {
                self.counts[square] += 1;
            }
        }
        let counts = &self.counts;
        let is_taken = |square: usize| {
            let depth = ((square / columns) as f32 + 0.5) * SIDE;
            let surface = (camera.focal_length * SIDE / depth).powi(2);
            counts[square] as f32 >= (SHARE * surface).max(LEAST)
        };
        let count = self.components.label([columns, rows], Connectivity::Eight, is_taken, |_, _| true);
        let nothing =
            Extent { low: [f32::MAX; 3], high: [f32::MIN; 3], pixels: [f32::MAX, f32::MAX, 0.0, 0.0] };
        self.extents.clear();
        self.extents.resize(count, nothing);
        for at in 0..depths.len() {
            let Some((place, square)) = seen(at) else { continue };
            let Some(number) = self.components.labels()[square].checked_sub(1) else { continue };
            let extent = &mut self.extents[number as usize];
            for (axis, place) in place.into_iter().enumerate() {
                extent.low[axis] = extent.low[axis].min(place);
                extent.high[axis] = extent.high[axis].max(place);
            }
            let [x, y] = [at % width, at / width].map(|at| at as f32);
            let [left, top, right, bottom] = extent.pixels;
            extent.pixels = [left.min(x), top.min(y), right.max(x + 1.0), bottom.max(y + 1.0)];
        }
        boxes.extend(self.extents.iter().map(Extent::bounding_box));
        boxes.sort_by(|one, other| one.location[2].total_cmp(&other.location[2]));
    }
}

impl Extent {
    fn bounding_box(&self) -> BoundingBox3D {
        let Self { low, high, pixels } = *self;
        let middle = |axis: usize| (low[axis] + high[axis]) / 2.0;
        BoundingBox3D {
            truncated: -1.0,
            occluded: -1,
            bbox2d: pixels,
            dimensions: [high[0] - low[0], high[1] - low[1], high[2] - low[2]],
            location: [middle(0), high[1], middle(2)],
            confidence: 1.0,
            ..BoundingBox3D::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: StereoCamera = StereoCamera {
        focal_length: 100.0,
        baseline: 0.1,
        principal_point: [80.0, 60.0],
        principal_point_offset: 0.0,
    };
    const OPTIONS: ObstacleOptions =
        ObstacleOptions { camera_height: 1.0, camera_pitch: 0.0, heights: [0.2, 2.0], farthest: 10.0 };

    /// Returns the depths of a floor, a near box on the left and a farther one on the right.
    fn depths() -> Vec<f32> {
        let depth = |at: usize| {
            let (x, y) = (at % 160, at / 160);
            match (x, y) {
                (10..40, 50..110) => 2.0,
                (100..120, 55..85) => 4.0,
                (_, 0..63) => 0.0,
                _ => 100.0 / (y as f32 + 0.5 - 60.0),
            }
        };
        (0..160 * 120).map(depth).collect()
    }

    #[test]
    fn two_boxes_on_the_floor_are_obstacles() {
        let mut boxes = Vec::new();
        Obstacles::default().find(&CAMERA, &depths(), 160, &OPTIONS, &mut boxes);
        let [near, far] = &boxes[..] else { panic!("{boxes:?}") };
        assert_eq!((near.location[2], far.location[2]), (2.0, 4.0));
        assert_eq!(near.bbox2d[..3], [10.0, 50.0, 40.0]);
        assert!(
            (near.dimensions[0] - 0.58).abs() < 0.01 && (near.location[0] + 1.1).abs() < 0.01,
            "{near:?}"
        );
        assert!((far.dimensions[0] - 0.76).abs() < 0.01 && (far.location[0] - 1.2).abs() < 0.01, "{far:?}");
    }

    /// A floor alone has no obstacle at any known pitch of the camera.
    #[test]
    fn a_floor_below_a_pitched_camera_is_no_obstacle() {
        let pitch = 0.3_f32;
        let depth = |at: usize| {
            let below = ((at / 160) as f32 + 0.5 - 60.0) / 100.0;
            1.0 / (below * pitch.cos() + pitch.sin())
        };
        let depths: Vec<f32> = (0..160 * 120).map(|at| depth(at).max(0.0)).collect();
        let mut boxes = Vec::new();
        let mut finder = Obstacles::default();
        finder.find(&CAMERA, &depths, 160, &ObstacleOptions { camera_pitch: pitch, ..OPTIONS }, &mut boxes);
        assert!(boxes.is_empty(), "{boxes:?}");
        finder.find(&CAMERA, &depths, 160, &OPTIONS, &mut boxes);
        assert!(!boxes.is_empty());
    }

    #[test]
    fn invalid_and_unknown_depths_are_no_obstacles() {
        let mut boxes = vec![BoundingBox3D::default()];
        let mut finder = Obstacles::default();
        for depth in [0.0, -3.0, f32::NAN, f32::INFINITY, 1e9] {
            finder.find(&CAMERA, &[depth; 160 * 120], 160, &OPTIONS, &mut boxes);
            assert!(boxes.is_empty(), "{depth}");
        }
        finder.find(&CAMERA, &[], 160, &OPTIONS, &mut boxes);
        assert!(boxes.is_empty());
        let wild = StereoCamera { focal_length: f32::NAN, ..CAMERA };
        finder.find(&wild, &depths(), 160, &OPTIONS, &mut boxes);
        assert!(boxes.is_empty());
    }
}
