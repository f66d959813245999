//! Input and anchors of a training, from its parameters.

use opendr_engine::model::Model;
use opendr_engine::{Error, Result};

use super::anchors::Anchors;
use super::layout::{ImageLayout, Layout, Resizing};

/// Parameters of the input and of the anchors.
pub(crate) struct LayoutOptions<'a> {
    /// Side of the network's input, in pixels.
    pub img_size: usize,
    /// How images are resized to that side.
    pub fitting: Resizing,
    /// Stride of the finest level, in pixels.
    pub stride: usize,
    /// Sides of the anchors of each level, in strides of the level.
    pub anchor_scales: &'a [f32],
    /// Aspect ratios of the anchors.
    pub aspect_ratios: &'a [f32],
}

/// Strides of the levels.
const STRIDES: [usize; 4] = [8, 16, 32, 64];

impl LayoutOptions<'_> {
    /// Returns the layout; a further training keeps the anchors of `base`.
    ///
    /// # Errors
    /// `InvalidParam` when the side is not a multiple of 32; `Format` for a base without a layout.
    pub fn layout(&self, base: Option<&Model>) -> Result<Layout> {
        if !self.img_size.is_multiple_of(32) {
            let below = self.img_size / 32 * 32;
            return Err(Error::invalid_param(format!(
                "img_size = {} is not a multiple of 32; give {below} or {}",
                self.img_size,
                below + 32
            )));
        }
        let anchors = match base {
            Some(model) => Layout::from_manifest(model.manifest())?.anchors,
            None => {
                let strides: Vec<_> = STRIDES.into_iter().filter(|stride| *stride >= self.stride).collect();
                Anchors::new(&strides, self.anchor_scales, self.aspect_ratios)
            }
        };
        anchors.check()?;
        Ok(Layout { image: ImageLayout::new(self.img_size, self.fitting), anchors })
    }
}
