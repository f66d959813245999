//! What a container of this learner says of its network: the picture that goes in, and the anchors that come out.

use opendr_engine::model::Manifest;
use opendr_engine::{Error, Result};
use opendr_vision::{Anchor, Preprocess};
use serde::{Deserialize, Serialize};

use super::anchors::Anchors;

opendr_engine::choices! {
    /// How a picture is brought to the size of the network's input.
    pub enum Fitting {
        /// Each axis by itself: every pixel of the input is used, shapes change.
        Stretch = "stretch",
        /// Shapes are kept, and the rest of the input is padding.
        Letterbox = "letterbox",
    }
}

/// The network's input, RGB and `[1, 3, height, width]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImageLayout {
    /// Pixels.
    pub width: usize,
    /// Pixels.
    pub height: usize,
    /// Whether the picture keeps its shape; the rest of the input is then padding.
    pub letterbox: bool,
    /// Level of the padding, 0..=255.
    pub pad: f32,
    /// Subtracted from the levels (0..=255) of red, green and blue.
    pub mean: [f32; 3],
    /// What the levels are divided by after that.
    pub std: [f32; 3],
}

/// Input and anchors, as they stand in a container's `inputs`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Layout {
    /// The picture.
    pub image: ImageLayout,
    /// The anchors.
    pub anchors: Anchors,
}

/// Largest side of an input, pixels.
const LARGEST: usize = 4096;

impl ImageLayout {
    /// A square input of `size` pixels with values from -1 to 1.
    pub fn new(size: usize, fitting: Fitting) -> Self {
        let letterbox = fitting == Fitting::Letterbox;
        Self { width: size, height: size, letterbox, pad: 127.5, mean: [127.5; 3], std: [127.5; 3] }
    }

    /// Width and height.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// What makes the input of a picture.
    pub fn preprocess(&self) -> Preprocess {
        let plain = Preprocess::new(self.width, self.height).normalise(self.mean, self.std);
        if self.letterbox { plain.letterbox(Anchor::Centre, self.pad) } else { plain }
    }

    fn check(&self) -> Result<()> {
        let sides = self.size().iter().all(|side| (1..=LARGEST).contains(side));
        let levels = self.mean.iter().chain([&self.pad]).all(|level| level.is_finite());
        if sides && levels && self.std.iter().all(|std| *std > 0.0 && std.is_finite()) {
            return Ok(());
        }
        Err(Error::format(format!(
            "an input has sides of 1 to {LARGEST} pixels, finite levels and positive deviations; the model says {self:?}"
        )))
    }
}

impl Layout {
    /// Reads a container's `inputs`.
    ///
    /// # Errors
    /// `Format` when they are not of this learner, or make no sense.
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
    fn a_container_says_everything() {
        let image = ImageLayout::new(320, Fitting::Letterbox);
        let layout = Layout { image, anchors: Anchors::new(&[16, 32], &[3.0], &[1.0, 0.5]) };
        assert_eq!(Layout::from_manifest(&manifest(&layout)).unwrap(), layout);
    }

    #[test]
    fn nonsense_is_refused() {
        let good = Layout {
            image: ImageLayout::new(320, Fitting::Stretch),
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
