//! Drawing style.

use crate::draw::canvas::Canvas;
use crate::draw::palette::Colour;

/// The style of drawn targets; the default suits images of any size.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// Factor on line thickness and text size, which otherwise depend on the image size.
    pub scale: f32,
    /// One colour for everything; `None` selects a colour per class or track.
    pub colour: Option<Colour>,
    /// Whether boxes and tracks have a label.
    pub labels: bool,
    /// Whether labels include the score.
    pub show_confidences: bool,
    /// Opacity of masks and heatmaps, 0..=1.
    pub opacity: f32,
    /// Joints below this score are not drawn.
    pub min_joint_confidence: f32,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            scale: 1.0,
            colour: None,
            labels: true,
            show_confidences: true,
            opacity: 0.5,
            min_joint_confidence: 0.0,
        }
    }
}

impl Style {
    /// Returns the line thickness on `canvas`, in whole pixels.
    pub(super) fn thickness(&self, canvas: &Canvas<'_>) -> f32 {
        (self.extent(canvas) * 0.003).round().clamp(1.0, 64.0)
    }

    /// Returns the side of the font's grid unit on `canvas`: whole or half pixels, so that strokes are crisp.
    pub(super) fn letter_unit(&self, canvas: &Canvas<'_>) -> f32 {
        ((self.extent(canvas) * 0.0022 * 2.0).round() / 2.0).clamp(1.0, 32.0)
    }

    /// Returns the mean side of the image, scaled. NaN and negative scales count as 1.
    fn extent(&self, canvas: &Canvas<'_>) -> f32 {
        let scale = if self.scale > 0.0 { self.scale.min(100.0) } else { 1.0 };
        (canvas.width() + canvas.height()) as f32 / 2.0 * scale
    }
}
