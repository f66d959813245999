//! Description of the network in a container: its input image and its anchors.

use opendr_engine::model::Manifest;
use opendr_engine::{Error, Result};
use opendr_vision::{LetterboxAlign, Preprocess};
use serde::{Deserialize, Serialize};

use super::anchors::Anchors;

opendr_engine::choices! {
    /// How an image is resized to the network's input.
    pub enum Resizing {
        /// Stretches both axes to the input, which changes the aspect ratio.
        Stretch = "stretch",
        /// Keeps the aspect ratio and pads the rest.
        Letterbox = "letterbox",
    }
}

/// The network's input, RGB and `[1, 3, height, width]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImageLayout {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Whether the image keeps its aspect ratio, with padding.
    pub letterbox: bool,
    /// Level of the padding, 0..=255.
    pub pad: f32,
    /// Mean of red, green and blue, subtracted from the levels (0..=255).
    pub mean: [f32; 3],
    /// Standard deviation of red, green and blue, by which the levels are divided then.
    pub std: [f32; 3],
}

/// Input and anchors, as in a container's `inputs`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Layout {
    /// The image.
    pub image: ImageLayout,
    /// The anchors.
    pub anchors: Anchors,
}

/// Maximum side of an input, in pixels.
const LARGEST: usize = 4096;

impl ImageLayout {
    /// Creates a square input of `size` pixels with values from -1 to 1.
    pub fn new(size: usize, fitting: Resizing) -> Self {
        let letterbox = fitting == Resizing::Letterbox;
        Self { width: size, height: size, letterbox, pad: 127.5, mean: [127.5; 3], std: [127.5; 3] }
    }

    /// Returns width and height.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// Returns the pre-processing of images.
    pub fn preprocess(&self) -> Preprocess {
        let plain = Preprocess::new(self.width, self.height).normalise(self.mean, self.std);
        if self.letterbox { plain.letterbox(LetterboxAlign::Centre, self.pad) } else { plain }
    }

    fn check(&self) -> Result<()> {
        let sides = self.size().iter().all(|side| (1..=LARGEST).contains(side));
        let levels = self.mean.iter().chain([&self.pad]).all(|level| level.is_finite());
        if sides && levels && self.std.iter().all(|std| *std > 0.0 && std.is_finite()) {
            return Ok(());
        }
        Err(Error::format(format!(
            "an input needs sides of 1 to {LARGEST} pixels, finite levels and positive deviations; the model has {self:?}"
        )))
    }
}

impl Layout {
    /// Reads a container's `inputs`.
    ///
    /// # Errors
    /// `Format` when they are not of this learner, or invalid.
    pub fn from_manifest(manifest: &Manifest) -> Result<Self> {
        let layout: Self = manifest.read_inputs("its image and its anchors")?;
        layout.image.check()?;
        layout.anchors.check()?;
        Ok(layout)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest(layout: &Layout) -> Manifest {
        let mut manifest = Manifest::new("single_shot_detector", "");
        manifest.write_inputs(layout).unwrap();
        manifest
    }

    #[test]
    fn a_layout_survives_the_manifest() {
        let image = ImageLayout::new(320, Resizing::Letterbox);
        let layout = Layout { image, anchors: Anchors::new(&[16, 32], &[3.0], &[1.0, 0.5]) };
        assert_eq!(Layout::from_manifest(&manifest(&layout)).unwrap(), layout);
    }

    #[test]
    fn invalid_layouts_are_refused() {
        let good = Layout {
            image: ImageLayout::new(320, Resizing::Stretch),
            anchors: Anchors::new(&[16], &[3.0], &[1.0]),
        };
        for break_it in [
            |layout: &mut Layout| layout.image.width = 1 << 20,
            |layout: &mut Layout| layout.image.std[1] = 0.0,
            |layout: &mut Layout| layout.anchors.levels[0].stride = 0,
        ] {
            let mut broken = good.clone();
            break_it(&mut broken);
            assert!(Layout::from_manifest(&manifest(&broken)).is_err());
        }
        assert!(Layout::from_manifest(&Manifest::new("single_shot_detector", "")).is_err());
    }
}
