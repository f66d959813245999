//! Fill outside of images.

/// Fill of a rotated crop outside the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Border {
    /// A level, 0..=255, normalised like the image (OpenCV's `BORDER_CONSTANT`).
    Constant(f32),
    /// The image's outermost pixels (OpenCV's `BORDER_REPLICATE`).
    Replicate,
}
