//! Border of a transformed image.

/// Padding of images, and treatment of objects at the border.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Border {
    /// Level of padded `u8` samples.
    pub level: u8,
    /// Class index of padded label maps, which training ignores.
    pub label: u32,
    /// Smallest share of a box inside the image, 0 to 1. Boxes are clipped at the border; those with less are
    /// dropped.
    pub min_visible: f32,
}

impl Border {
    /// Class index that training ignores (of Pascal VOC and Cityscapes).
    pub const IGNORED: u32 = 255;

    /// Returns grey padding (level 114) and ignored labels, with a smallest share of boxes.
    pub fn with_min_visible(min_visible: f32) -> Self {
        Self { level: 114, label: Self::IGNORED, min_visible }
    }
}

impl Default for Border {
    fn default() -> Self {
        Self::with_min_visible(0.0)
    }
}
