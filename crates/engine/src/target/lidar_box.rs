//! 3D bounding boxes in the frame of a lidar, and their conversion to and from the camera frame.

use crate::data::Calibration;
use crate::overlap::{RotatedRectangle, UprightBox3D};
use crate::target::BoundingBox3D;

/// A 3D bounding box with a vertical axis in a lidar's frame: x forward, y left, z up, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LidarBox {
    /// Center of the base.
    pub center: [f64; 3],
    /// Length, width and height.
    pub size: [f64; 3],
    /// Heading of the front: from x towards y, in radians.
    pub yaw: f64,
}

/// Minimum depth of a corner that is projected to the image, in metres.
const NEAREST: f64 = 0.1;

impl LidarBox {
    /// Converts to a base rectangle with an extent along z.
    pub fn upright_box(&self) -> UprightBox3D {
        let ([x, y, z], [length, width, height]) = (self.center, self.size);
        let floor = RotatedRectangle { center: [x, y], size: [length, width], angle: self.yaw };
        UprightBox3D { base: floor, vertical: [z, z + height] }
    }

    /// Returns the eight corners, those of the base first.
    pub fn corners(&self) -> [[f64; 3]; 8] {
        let (sin, cos) = self.yaw.sin_cos();
        std::array::from_fn(|corner| {
            let side = |bit: usize, size: f64| if corner >> bit & 1 == 0 { size / 2.0 } else { -size / 2.0 };
            let (along, across) = (side(0, self.size[0]), side(1, self.size[1]));
            let up = if corner < 4 { 0.0 } else { self.size[2] };
            let [x, y, z] = self.center;
            [x + cos * along - sin * across, y + sin * along + cos * across, z + up]
        })
    }

    /// Converts to the camera frame, without name and score.
    ///
    /// `bbox2d` encloses the projected corners, clipped to `image_shape` (`[height, width]`) if it is given, and is -1 for a
    /// box behind the camera. `truncated` is the fraction outside the image, -1 without `image_shape`. The occlusion is
    /// unknown (3).
    pub fn to_camera(&self, calibration: &Calibration, image_shape: Option<[usize; 2]>) -> BoundingBox3D {
        let [length, width, height] = self.size;
        let location = calibration.camera_from_lidar(self.center);
        let zero = calibration.camera_from_lidar([0.0; 3]);
        let (sin, cos) = self.yaw.sin_cos();
        let front = calibration.camera_from_lidar([cos, sin, 0.0]);
        let rotation_y = (zero[2] - front[2]).atan2(front[0] - zero[0]);
        let (bbox2d, truncated) = self.in_image(calibration, image_shape);
        BoundingBox3D {
            truncated: truncated as f32,
            occluded: 3,
            alpha: wrapped(rotation_y - location[0].atan2(location[2])) as f32,
            bbox2d: bbox2d.map(|edge| edge as f32),
            dimensions: [length, height, width].map(|side| side as f32),
            location: location.map(|coordinate| coordinate as f32),
            rotation_y: rotation_y as f32,
            ..BoundingBox3D::default()
        }
    }

    /// Converts from the camera frame; `None` if a number is not finite.
    pub fn from_camera(found: &BoundingBox3D, calibration: &Calibration) -> Option<Self> {
        let zero = calibration.camera_from_lidar([0.0; 3]);
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| {
            let end = calibration.camera_from_lidar(axis);
            [0, 1, 2].map(|row| end[row] - zero[row])
        });
        // The inverse of a rotation is its transpose, whose rows these are.
        let back = |point: [f64; 3]| axes.map(|[x, y, z]| x * point[0] + y * point[1] + z * point[2]);
        let location = found.location.map(f64::from);
        let center = back([0, 1, 2].map(|axis| location[axis] - zero[axis]));
        let (sin, cos) = f64::from(found.rotation_y).sin_cos();
        let front = back([cos, 0.0, -sin]);
        let [length, height, width] = found.dimensions.map(f64::from);
        let found = Self { center, size: [length, width, height], yaw: front[1].atan2(front[0]) };
        found
            .center
            .iter()
            .chain(&found.size)
            .chain([&found.yaw])
            .all(|part| part.is_finite())
            .then_some(found)
    }

    fn in_image(&self, calibration: &Calibration, image_shape: Option<[usize; 2]>) -> ([f64; 4], f64) {
        let mut edges = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        for corner in self.corners() {
            let point = calibration.camera_from_lidar(corner);
            let Some([x, y]) = calibration.image_from_camera(point).filter(|_| point[2] > NEAREST) else {
                continue;
            };
            edges = [edges[0].min(x), edges[1].min(y), edges[2].max(x), edges[3].max(y)];
        }
        if !edges.iter().all(|edge| edge.is_finite()) {
            return ([-1.0; 4], 1.0);
        }
        let Some([height, width]) = image_shape else { return (edges, -1.0) };
        let area = |[x0, y0, x1, y1]: [f64; 4]| (x1 - x0) * (y1 - y0);
        let most = [width, height, width, height].map(|side| side.saturating_sub(1) as f64);
        let inside = [0, 1, 2, 3].map(|edge| edges[edge].clamp(0.0, most[edge]));
        let truncated = if area(edges) > 0.0 { 1.0 - area(inside) / area(edges) } else { 1.0 };
        (if area(inside) > 0.0 { inside } else { [-1.0; 4] }, truncated)
    }
}

/// Wraps an angle to [-pi, pi].
fn wrapped(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn car_ahead() {
        // 10 metres ahead, 2 to the left, looking ahead: in the camera 2 to the left, and -90 degrees about y.
        let car = LidarBox { center: [10.0, 2.0, -1.7], size: [4.0, 1.6, 1.5], yaw: 0.0 };
        let found = car.to_camera(&Calibration::nominal(), Some([375, 1242]));
        assert_eq!((found.dimensions, found.location), ([4.0, 1.5, 1.6], [-2.0, 1.7, 10.0]));
        assert!((f64::from(found.rotation_y) + std::f64::consts::FRAC_PI_2).abs() < 1e-6);
        // Its nearest corners are 8 metres ahead; the left edge is 2.8 to the left there.
        assert!((f64::from(found.bbox2d[0]) - (609.6 - 721.5 * 2.8 / 8.0)).abs() < 1e-3);
        assert!((f64::from(found.bbox2d[3]) - (172.9 + 721.5 * 1.7 / 8.0)).abs() < 1e-3);
        assert!(found.truncated.abs() < 1e-6);
    }

    #[test]
    fn round_trip_through_the_camera_frame() {
        let mut calibration = Calibration::nominal();
        calibration.tr_velo_to_cam = [[0.0, -1.0, 0.0, 0.1], [0.0, 0.0, -1.0, -0.08], [1.0, 0.0, 0.0, -0.27]];
        let (sin, cos) = 0.01f64.sin_cos();
        calibration.r0_rect = [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]];
        for yaw in [-3.0, -1.0, 0.3, 2.5] {
            let car = LidarBox { center: [20.0, -3.0, -1.6], size: [4.2, 1.7, 1.5], yaw };
            let again = LidarBox::from_camera(&car.to_camera(&calibration, None), &calibration).unwrap();
            let apart = car.center.iter().zip(again.center).chain(car.size.iter().zip(again.size));
            assert!(apart.map(|(a, b)| (a - b).abs()).all(|apart| apart < 1e-5), "{again:?}");
            assert!(wrapped(car.yaw - again.yaw).abs() < 1e-5);
            assert!(car.upright_box().iou(&again.upright_box()) > 0.999);
        }
    }

    #[test]
    fn boxes_behind_the_camera_have_no_image_box() {
        let behind = LidarBox { center: [-10.0, 2.0, -1.7], size: [4.0, 1.6, 1.5], yaw: 0.0 };
        let found = behind.to_camera(&Calibration::nominal(), Some([375, 1242]));
        assert_eq!((found.bbox2d, found.truncated), ([-1.0; 4], 1.0));
        let broken = BoundingBox3D { location: [f32::NAN; 3], ..BoundingBox3D::default() };
        assert_eq!(LidarBox::from_camera(&broken, &Calibration::nominal()), None);
    }
}
