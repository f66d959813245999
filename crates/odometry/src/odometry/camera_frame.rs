//! What a camera delivers.

use opendr_engine::data::{Image, Pixels};
use opendr_engine::{Error, Result};

use crate::geometry::PinholeCamera;

/// Kind of camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CameraKind {
    /// One camera; the scale of its motion is not observable.
    Mono,
    /// A rectified stereo pair.
    Stereo,
    /// A camera with the depth of each pixel.
    Depth,
}

/// One frame of a camera. The time is that of the (left) image's header.
#[derive(Debug, Clone, Copy)]
pub enum CameraFrame<'a> {
    /// The image of a single camera.
    Mono(&'a Image),
    /// A rectified pair of equal size.
    Stereo {
        /// Image of the left camera.
        left: &'a Image,
        /// Image of the right camera.
        right: &'a Image,
    },
    /// An image with its depths.
    Depth {
        /// The image.
        image: &'a Image,
        /// Depth along the optical axis: `f32` in metres or `u16` in millimetres; 0 where it is unknown.
        depth: &'a Image,
    },
}

impl<'a> CameraFrame<'a> {
    /// Returns the kind of camera.
    pub fn kind(&self) -> CameraKind {
        match self {
            Self::Mono(_) => CameraKind::Mono,
            Self::Stereo { .. } => CameraKind::Stereo,
            Self::Depth { .. } => CameraKind::Depth,
        }
    }

    /// Returns the image that is followed.
    pub fn image(&self) -> &'a Image {
        match self {
            Self::Mono(image) | Self::Stereo { left: image, .. } | Self::Depth { image, .. } => image,
        }
    }

    pub(super) fn check(&self, camera: &PinholeCamera, kind: CameraKind) -> Result<()> {
        if self.kind() != kind {
            return Err(Error::invalid_input(format!(
                "a frame of a {:?} camera for the odometry of a {kind:?} camera; pass the frames it was created for",
                self.kind()
            )));
        }
        let second = match self {
            Self::Mono(_) => None,
            Self::Stereo { right, .. } => Some(*right),
            Self::Depth { depth, .. } => Some(*depth),
        };
        for image in [Some(self.image()), second].into_iter().flatten() {
            let size = [image.width(), image.height()];
            if size != camera.size {
                return Err(Error::invalid_input(format!(
                    "an image of {size:?} pixels for a camera of {:?}; pass images of the camera's size",
                    camera.size
                )));
            }
        }
        match self {
            Self::Depth { depth, .. } if depth.channels() != 1 || matches!(depth.pixels(), Pixels::U8(_)) => {
                Err(Error::invalid_input(
                    "the depth is no image of one channel of u16 or f32; pass millimetres as u16 or metres as f32",
                ))
            }
            _ => Ok(()),
        }
    }
}

/// Returns the depth at a place in metres; `None` where it is unknown or differs between neighbours, as at edges.
pub(super) fn depth_at(depth: &Image, place: [f32; 2]) -> Option<f64> {
    let [x, y] = place.map(|at| at.round().max(0.0) as usize);
    let width = depth.width();
    if x == 0 || y == 0 || x + 1 >= width || y + 1 >= depth.height() {
        return None;
    }
    let at = |x: usize, y: usize| match depth.pixels() {
        Pixels::F32(metres) => f64::from(metres[y * width + x]),
        Pixels::U16(millimetres) => f64::from(millimetres[y * width + x]) / 1000.0,
        Pixels::U8(_) => 0.0,
    };
    let around = [at(x, y), at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1)];
    let (low, high) = around
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), depth| (low.min(*depth), high.max(*depth)));
    let mean = around.iter().sum::<f64>() / 5.0;
    (low > 0.0 && high.is_finite() && high - low < 0.15 * low).then_some(mean)
}
