//! The input of a network from an image, in one pass: resize, letterbox or rotated crop, channel order,
//! normalisation, layout.
//!
//! # Dispatch
//! `u8` images with 3 or 4 interleaved channels run through AVX2 kernels where the CPU has AVX2 and FMA (detected at
//! run time). All other images, and all images on other CPUs, run through plain Rust, as do rotated crops.

mod band;
mod border;
mod dispatch;
mod geometry;
#[cfg(target_arch = "x86_64")]
mod kernels_x86;
mod packed;
mod plan;
mod sample;
mod source;
mod strided;
mod warped;

use std::sync::Arc;

use opendr_engine::data::{ImageView, Layout};
use opendr_engine::{Error, Result};

use crate::warp::Warp;
use crate::workers;
use band::{Band, MAX_BANDS, Row};
pub use border::Border;
use geometry::Placement;
pub use geometry::{InputGeometry, LetterboxAlign};
use plan::{Plan, Plans, Sizes};
pub use sample::InputSample;
use source::Source;
use strided::Finish;
pub(crate) use strided::LUMINANCE;
use warped::Line;

/// Number of pixels below which waking another thread costs more than it saves.
const PIXELS_ALONE: usize = 96 * 96;

/// Channels of a network's input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ChannelOrder {
    /// Red, green, blue.
    Rgb,
    /// Blue, green, red.
    Bgr,
    /// One channel: luminance by ITU-R BT.601.
    Grey,
}

impl ChannelOrder {
    /// Returns the number of channels.
    pub const fn channels(self) -> usize {
        match self {
            Self::Rgb | Self::Bgr => 3,
            Self::Grey => 1,
        }
    }
}

/// Conversion of images to the input of a network; built once per learner.
///
/// Scaling is bilinear with half-pixel centres and without antialiasing, as OpenCV's `INTER_LINEAR`. Images have
/// levels of 0..=255: `u8` unchanged, `u16` divided by 257, floats multiplied by 255; the alpha channel is dropped.
/// Tables for recent sizes are cached, so that a stream of images allocates nothing; clones share them.
///
/// ```
/// use opendr_engine::data::{Image, Layout};
/// use opendr_vision::{LetterboxAlign, ChannelOrder, Preprocess};
///
/// let nanodet = Preprocess::new(416, 416)
///     .letterbox(LetterboxAlign::Centre, 0.0)
///     .order(ChannelOrder::Bgr)
///     .normalise([103.53, 116.28, 123.675], [57.375, 57.12, 58.395]);
/// let frame = Image::from_rgb8(vec![128; 640 * 480 * 3], 640, 480)?;
/// let mut input = vec![0f32; nanodet.len()];
/// let geometry = nanodet.run_into(frame.view(), &mut input)?;
/// assert_eq!(geometry.image_from_input([208.0, 208.0]), [320.0, 240.0]);
/// # Ok::<(), opendr_engine::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Preprocess {
    size: [usize; 2],
    /// Anchor and level of the padding; `None` stretches.
    letterbox: Option<(LetterboxAlign, f32)>,
    border: Border,
    order: ChannelOrder,
    scale: [f32; 3],
    bias: [f32; 3],
    layout: Layout,
    threads: usize,
    plans: Arc<Plans>,
}

impl Preprocess {
    /// Creates the conversion to `width` x `height` pixels: stretched, RGB, CHW, levels of 0..=255.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            size: [width, height],
            letterbox: None,
            border: Border::Constant(0.0),
            order: ChannelOrder::Rgb,
            scale: [1.0; 3],
            bias: [0.0; 3],
            layout: Layout::Chw,
            threads: workers::available(),
            plans: Arc::default(),
        }
    }

    /// Keeps the image's aspect ratio; the padding has the level `pad` (0..=255, then normalised).
    #[must_use]
    pub fn letterbox(self, anchor: LetterboxAlign, pad: f32) -> Self {
        Self { letterbox: Some((anchor, pad)), ..self }
    }

    /// Fills the input; the image's aspect ratio changes.
    #[must_use]
    pub fn stretch(self) -> Self {
        Self { letterbox: None, ..self }
    }

    /// Sets the fill of [`Preprocess::warp_into`] outside the image; level 0 by default.
    #[must_use]
    pub fn border(self, border: Border) -> Self {
        Self { border, ..self }
    }

    /// Sets the channels of the input.
    #[must_use]
    pub fn order(self, order: ChannelOrder) -> Self {
        Self { order, ..self }
    }

    /// Normalises to `(level - mean) / std`, per channel in the input's order (grey uses the first).
    #[must_use]
    pub fn normalise(self, mean: [f32; 3], std: [f32; 3]) -> Self {
        let scale = std.map(|std| 1.0 / std);
        Self { scale, bias: std::array::from_fn(|c| -mean[c] * scale[c]), ..self }
    }

    /// Sets the order of the input's axes.
    #[must_use]
    pub fn layout(self, layout: Layout) -> Self {
        Self { layout, ..self }
    }

    /// Limits the threads per image; the default is the number of cores, at most 8.
    #[must_use]
    pub fn threads(self, threads: usize) -> Self {
        Self { threads: threads.max(1), ..self }
    }

    /// Returns the same conversion for another input size, for networks that accept several.
    #[must_use]
    pub fn with_size(&self, width: usize, height: usize) -> Self {
        Self { size: [width, height], ..self.clone() }
    }

    /// Returns width and height of the input.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns the input's shape with a batch of one: `[1, channels, height, width]`, or
    /// `[1, height, width, channels]`.
    pub fn shape(&self) -> [usize; 4] {
        let ([width, height], channels) = (self.size, self.order.channels());
        match self.layout {
            Layout::Chw => [1, channels, height, width],
            Layout::Hwc => [1, height, width, channels],
        }
    }

    /// Returns the number of samples of the input.
    pub fn len(&self) -> usize {
        self.shape().into_iter().fold(1, usize::saturating_mul)
    }

    /// Returns whether the input has no samples; nothing can run then.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Writes the input for `image` and returns the position of the image in it.
    ///
    /// # Errors
    /// `InvalidInput` when `out` does not have [`Preprocess::len`] samples, `InvalidParam` when the input has no
    /// pixels.
    pub fn run_into<T: InputSample>(&self, image: ImageView<'_>, out: &mut [T]) -> Result<InputGeometry> {
        if self.is_empty() || out.len() != self.len() {
            return Err(self.misfit(out.len()));
        }
        let source_size = [image.width(), image.height()];
        let placement = match self.letterbox {
            Some((anchor, _)) => Placement::letterbox(source_size, self.size, anchor),
            None => Placement::stretch(self.size),
        };
        let source = Source::new(image, self.finish(&image));
        let sizes =
            Sizes { source: source_size, target: [placement.width, placement.height], step: source.step() };
        self.plans.with(sizes, |plan| {
            source.prepare(plan);
            self.write(&source, plan, placement, out);
        });
        Ok(placement.geometry(source_size))
    }

    /// Writes the input for the crop `crop` of `image`: bilinear, without antialiasing, from any strides, in one
    /// pass. Order, normalisation, layout and border are those of `self`; a letterbox has no effect.
    ///
    /// ```
    /// use opendr_engine::data::Image;
    /// use opendr_vision::{Preprocess, Similarity};
    ///
    /// let frame = Image::from_rgb8(vec![128; 640 * 480 * 3], 640, 480)?;
    /// let crop = Similarity::rotated_square([320.0, 240.0], 100.0, 0.5, 224);
    /// let preprocess = Preprocess::new(224, 224).normalise([0.0; 3], [255.0; 3]);
    /// let mut input = vec![0f32; preprocess.len()];
    /// preprocess.warp_into(frame.view(), &crop, &mut input)?;
    /// assert!((input[0] - 128.0 / 255.0).abs() < 1e-6);
    /// # Ok::<(), opendr_engine::Error>(())
    /// ```
    ///
    /// # Errors
    /// `InvalidInput` when `out` does not have [`Preprocess::len`] samples, or when `crop` has numbers that are not
    /// finite, a scale of 0, or lies more than 2^29 pixels away; `InvalidParam` when the input has no pixels.
    pub fn warp_into<T: InputSample>(
        &self,
        image: ImageView<'_>,
        crop: impl Into<Warp>,
        out: &mut [T],
    ) -> Result<()> {
        if self.is_empty() || out.len() != self.len() {
            return Err(self.misfit(out.len()));
        }
        let [first, right, down] = crop.into().fixed_point(self.size)?;
        let source = Source::new(image, self.finish(&image));
        let position = |index: usize, from: [i64; 2], step: [i64; 2]| {
            [0, 1].map(|axis| from[axis] + index as i64 * step[axis])
        };
        self.for_each_row(out, self.size[0] * self.size[1], |number, row| {
            let start = position(number, first, down);
            row.fill_with(|range, mut part| {
                let line = Line { start: position(range.start, start, right), step: right };
                source.warp(line, self.border, &mut part);
            });
        });
        Ok(())
    }

    /// Calls the kernel for the rows of `out`, on several threads where `pixels` is large enough.
    fn for_each_row<T: InputSample>(
        &self,
        out: &mut [T],
        pixels: usize,
        write: impl Fn(usize, Row<'_, T>) + Sync,
    ) {
        let alone = self.threads == 1 || pixels < PIXELS_ALONE;
        let bands = if alone { 1 } else { MAX_BANDS.min(self.threads * 4) };
        let cut = Band::whole(out, self.size, self.order.channels(), self.layout).cut(bands);
        workers::run(bands, self.threads, &|index| {
            let Some(mut band) = cut[index].lock().ok().and_then(|mut band| band.take()) else { return };
            band.for_each_row(&write);
        });
    }

    fn finish(&self, image: &ImageView<'_>) -> Finish {
        let stride = image.strides()[2];
        let [red, green, blue] = image.format().rgb_offsets().map(|channel| channel * stride);
        let (channels, luminance) = match self.order {
            ChannelOrder::Rgb => ([red, green, blue], false),
            ChannelOrder::Bgr => ([blue, green, red], false),
            ChannelOrder::Grey => ([red, green, blue], image.format().channels() > 1),
        };
        Finish { channels, luminance, scale: self.scale, bias: self.bias }
    }

    fn write<T: InputSample>(&self, source: &Source<'_>, plan: &Plan, placement: Placement, out: &mut [T]) {
        let pad = self.letterbox.map_or(0.0, |(_, pad)| pad);
        let padding = std::array::from_fn(|c| pad * self.scale[c] + self.bias[c]);
        let Placement { x, y, width, height, .. } = placement;
        let columns = self.size[0];
        self.for_each_row(out, width * height, |number, mut row| {
            if number < y || number >= y + height {
                return row.fill(padding);
            }
            row.part(0..x).fill(padding);
            row.part(x + width..columns).fill(padding);
            row.part(x..x + width).fill_with(|range, mut part| {
                source.write(plan, number - y, range, &mut part);
            });
        });
    }

    #[cold]
    fn misfit(&self, samples: usize) -> Error {
        let shape = self.shape();
        if self.is_empty() {
            return Error::invalid_param(format!(
                "a network input of shape {shape:?} has no pixels; set width and height to at least 1"
            ));
        }
        Error::invalid_input(format!(
            "the input buffer has {samples} samples, but the shape {shape:?} needs {}",
            self.len()
        ))
    }
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod warp_tests;
