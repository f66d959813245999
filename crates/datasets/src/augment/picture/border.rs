//! What becomes of what lies beyond the border of a picture.

/// How pictures are filled up, and how much of an object must stay inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Border {
    /// Level of `u8` samples where nothing of the picture lies.
    pub level: u8,
    /// Class number of a label map there: one that training ignores.
    pub label: u32,
    /// Boxes are cut at the border; those with less than this share of their area inside are dropped, 0..=1.
    pub min_visible: f32,
}

impl Border {
    /// The label that training ignores (Pascal VOC's, Cityscapes').
    pub const IGNORED: u32 = 255;

    /// Grey that means nothing to a network, ignored labels, and this share of a box.
    pub fn keeping(min_visible: f32) -> Self {
        Self { level: 114, label: Self::IGNORED, min_visible }
    }
}

impl Default for Border {
    fn default() -> Self {
        Self::keeping(0.0)
    }
}
