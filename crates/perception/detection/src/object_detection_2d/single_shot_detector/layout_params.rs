//! Input and anchors of a training, from its parameters.

use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result};

use super::anchors::Anchors;
use super::layout::{ImageLayout, Layout, Resizing};

/// Training parameters of the input and of the anchors, for networks of one or several sensors.
#[derive(Debug, Clone, Params)]
pub struct LayoutParams {
    /// Side of the network's input, a multiple of 32; OpenDR's default of 512 takes two and a half times as long.
    #[param(default = 320, range = 96..=1024, unit = "px")]
    pub img_size: usize,
    /// How images are resized to that side.
    #[param(former = "fitting")]
    pub resizing: Resizing,
    /// Stride of the finest level, 8 or 16. The coarser one suits larger objects and is faster.
    #[param(default = 8, range = 8..=16, unit = "px")]
    pub stride: usize,
    /// Aspect ratios (width over height) of the anchors.
    #[param(default = vec![0.4, 1.0, 2.0], range = 0.05..=20.0)]
    pub aspect_ratios: Vec<f32>,
    /// Sides of the anchors of each level, in strides of the level.
    #[param(default = vec![3.0, 4.25], range = 0.5..=32.0)]
    pub anchor_scales: Vec<f32>,
}

/// Strides of the levels.
const STRIDES: [usize; 4] = [8, 16, 32, 64];

impl LayoutParams {
    /// Returns the layout; a further training keeps the anchors of `base`.
    ///
    /// # Errors
    /// `InvalidParam` when the side is not a multiple of 32; `Format` for a base without a layout.
    pub fn resolve(&self, base: Option<&Model>) -> Result<Layout> {
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
                Anchors::new(&strides, &self.anchor_scales, &self.aspect_ratios)
            }
        };
        anchors.check()?;
        Ok(Layout { image: ImageLayout::new(self.img_size, self.resizing), anchors })
    }
}
