//! The camera over the table.

use super::{GRASP_HEIGHT, Grasp, HALF_VIEW};
use crate::planar::Convex;
use crate::planar::vector::Vector2;

/// A pinhole camera that looks straight down on the middle of the table, its columns along x and its rows against y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    size: usize,
}

/// Height of the camera over the table, m.
const HEIGHT: f64 = 0.7;

/// What a ray meets first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hit {
    /// Height over the table, m.
    pub height: f64,
    /// Unit normal of a side; none for the top.
    pub side: Option<Vector2>,
}

impl Camera {
    /// Creates a camera with square images of `size` pixels a side, which show the table within [`HALF_VIEW`].
    pub fn new(size: usize) -> Self {
        Self { size }
    }

    /// Returns width and height of the images.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Returns the field of view of the columns and of the rows, in radians.
    pub fn field_of_view(&self) -> f64 {
        2.0 * (HALF_VIEW / HEIGHT).atan()
    }

    /// Returns the height over the table, m.
    pub fn height(&self) -> f64 {
        HEIGHT
    }

    fn focal_length(&self) -> f64 {
        0.5 * self.size as f64 * HEIGHT / HALF_VIEW
    }

    /// Returns the pixel (column, row) of a place at a height over the table, m.
    pub fn pixel(&self, [x, y]: Vector2, height: f64) -> [f32; 2] {
        let (scale, middle) = (self.focal_length() / (HEIGHT - height), 0.5 * self.size as f64);
        [middle + scale * x, middle - scale * y].map(|part| part as f32)
    }

    /// Returns the place on the table, m, at this height whose pixel is `(column, row)`.
    pub fn place(&self, [column, row]: [f32; 2], height: f64) -> Vector2 {
        let (scale, middle) = ((HEIGHT - height) / self.focal_length(), 0.5 * self.size as f64);
        [(f64::from(column) - middle) * scale, (middle - f64::from(row)) * scale]
    }

    /// Returns the pixels of the jaws of a grasp before they close, left then right along its direction.
    pub fn jaws(&self, grasp: &Grasp) -> [[f32; 2]; 2] {
        let (sine, cosine) = crate::sine_cosine::sine_cosine(grasp.angle);
        [-0.5, 0.5].map(|side| {
            let reach = side * grasp.width;
            self.pixel([grasp.place[0] + reach * cosine, grasp.place[1] + reach * sine], GRASP_HEIGHT)
        })
    }

    /// Returns the grasp whose jaws are at these pixels.
    pub fn grasp(&self, jaws: [[f32; 2]; 2]) -> Grasp {
        let [left, right] = jaws.map(|jaw| self.place(jaw, GRASP_HEIGHT));
        let across = [right[0] - left[0], right[1] - left[1]];
        Grasp {
            place: [0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1])],
            angle: across[1].atan2(across[0]),
            width: (across[0] * across[0] + across[1] * across[1]).sqrt(),
        }
    }

    /// Returns the distance of the camera from something at a height, along its axis, m.
    pub(super) fn depth(height: f64) -> f64 {
        HEIGHT - height
    }

    /// Returns where the ray of a pixel meets an extruded polygon.
    pub(super) fn hit(&self, pixel: [f32; 2], prism: &Convex, top: f64) -> Option<Hit> {
        // On the ray, places are `foot * (HEIGHT - height) / HEIGHT`; the share goes from that of the top to 1 on the table.
        let foot = self.place(pixel, 0.0);
        let (mut enter, mut leave, mut side) = ((HEIGHT - top) / HEIGHT, 1.0, None);
        for [start, end] in prism.edges() {
            let along = [end[0] - start[0], end[1] - start[1]];
            let outward = [along[1], -along[0]];
            let offset = outward[0] * start[0] + outward[1] * start[1];
            let slope = outward[0] * foot[0] + outward[1] * foot[1];
            if slope > 0.0 {
                leave = f64::min(leave, offset / slope);
            } else if slope < 0.0 {
                let share = offset / slope;
                if share > enter {
                    (enter, side) = (share, Some(crate::planar::vector::unit(outward)));
                }
            } else if offset < 0.0 {
                return None;
            }
        }
        (enter <= leave).then_some(Hit { height: HEIGHT * (1.0 - enter), side })
    }
}
