//! Overlap of rotated rectangles on a plane, and of 3D boxes with a vertical axis.

use super::polygon::Polygon;

/// A rectangle on a plane, rotated about its center.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotatedRectangle {
    /// Center of the rectangle.
    pub center: [f64; 2],
    /// Length and width: the sides along its first and second axis.
    pub size: [f64; 2],
    /// Rotation from the plane's first axis towards its second, in radians.
    pub angle: f64,
}

impl RotatedRectangle {
    /// Returns length times width; 0 if a side is not positive.
    pub fn area(&self) -> f64 {
        let [length, width] = self.size;
        if length > 0.0 && width > 0.0 { length * width } else { 0.0 }
    }

    /// Returns the area of the intersection with `other`, exact except for rounding.
    ///
    /// `other` is moved into the frame of `self` and clipped by four axis-parallel lines (I. E. Sutherland,
    /// G. W. Hodgman, "Reentrant polygon clipping", Communications of the ACM 17, 1974).
    pub fn intersection_area(&self, other: &Self) -> f64 {
        if self.area() == 0.0 || other.area() == 0.0 || self.is_apart(other) {
            return 0.0;
        }
        let (sin, cos) = self.angle.sin_cos();
        let offset = [other.center[0] - self.center[0], other.center[1] - self.center[1]];
        let center = [cos * offset[0] + sin * offset[1], cos * offset[1] - sin * offset[0]];
        let in_own_frame = Self { center, size: other.size, angle: other.angle - self.angle };
        let mut polygon = Polygon::new(in_own_frame.corners());
        for axis in 0..2 {
            let limit = self.size[axis] / 2.0;
            polygon = polygon.below(axis, limit, 1.0).below(axis, limit, -1.0);
        }
        polygon.area()
    }

    /// Returns the intersection over union; 0 for a rectangle without area.
    pub fn iou(&self, other: &Self) -> f64 {
        let shared = self.intersection_area(other);
        if shared > 0.0 { shared / (self.area() + other.area() - shared) } else { 0.0 }
    }

    /// Returns the corners, counter-clockwise if the second axis is a quarter turn from the first.
    fn corners(&self) -> [[f64; 2]; 4] {
        let (sin, cos) = self.angle.sin_cos();
        [[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]].map(|[along, across]| {
            let (along, across) = (along * self.size[0], across * self.size[1]);
            [self.center[0] + cos * along - sin * across, self.center[1] + sin * along + cos * across]
        })
    }

    /// Returns whether the circumscribed circles of the two do not intersect.
    fn is_apart(&self, other: &Self) -> bool {
        let reach = |size: [f64; 2]| size[0].hypot(size[1]) / 2.0;
        let distance = (other.center[0] - self.center[0]).hypot(other.center[1] - self.center[1]);
        distance > reach(self.size) + reach(other.size)
    }
}

/// A 3D box with a vertical axis, rotated about that axis only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UprightBox3D {
    /// Base of the box, on the ground plane.
    pub base: RotatedRectangle,
    /// Lower and upper end along the vertical axis.
    pub vertical: [f64; 2],
}

impl UprightBox3D {
    /// Creates a box from KITTI's camera frame (x right, y down, z forward), as in
    /// [`BoundingBox3D`](crate::target::BoundingBox3D): length, height and width, the center of the base, the rotation about
    /// y. The ground plane is x and z; the vertical axis points up.
    pub fn from_kitti([length, height, width]: [f64; 3], [x, y, z]: [f64; 3], rotation_y: f64) -> Self {
        // A rotation about y, which points down, goes from z to x.
        let base = RotatedRectangle { center: [x, z], size: [length, width], angle: -rotation_y };
        Self { base, vertical: [-y, height - y] }
    }

    /// Returns the area of the base times the height; 0 if a side is not positive.
    pub fn volume(&self) -> f64 {
        self.base.area() * (self.vertical[1] - self.vertical[0]).max(0.0)
    }

    /// Returns the intersection over union of the volumes, given the intersection area of the bases; 0 for a box without
    /// volume.
    pub fn iou_with_base_intersection(&self, other: &Self, shared_floor: f64) -> f64 {
        let ([low, high], [other_low, other_high]) = (self.vertical, other.vertical);
        let shared = shared_floor * (high.min(other_high) - low.max(other_low)).max(0.0);
        if shared > 0.0 { shared / (self.volume() + other.volume() - shared) } else { 0.0 }
    }

    /// Returns the intersection over union of the volumes; 0 for a box without volume.
    pub fn iou(&self, other: &Self) -> f64 {
        self.iou_with_base_intersection(other, self.base.intersection_area(&other.base))
    }
}

#[cfg(test)]
mod tests;
