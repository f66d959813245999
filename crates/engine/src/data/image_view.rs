//! Strided views of images, the input of kernels.

use crate::data::pixel_format::PixelFormat;

/// Borrowed samples of one type.
#[derive(Debug, Clone, Copy)]
pub enum Samples<'a> {
    /// 8 bits per sample.
    U8(&'a [u8]),
    /// 16 bits per sample.
    U16(&'a [u16]),
    /// Floats.
    F32(&'a [f32]),
}

impl Samples<'_> {
    fn len(&self) -> usize {
        match self {
            Self::U8(data) => data.len(),
            Self::U16(data) => data.len(),
            Self::F32(data) => data.len(),
        }
    }
}

/// A strided view of an image or a part of it.
///
/// Sample `(x, y, c)` is at `y * strides[0] + x * strides[1] + c * strides[2]`, strides in samples.
#[derive(Debug, Clone, Copy)]
pub struct ImageView<'a> {
    samples: Samples<'a>,
    width: usize,
    height: usize,
    format: PixelFormat,
    strides: [usize; 3],
}

impl<'a> ImageView<'a> {
    /// Creates a view. Callers guarantee that its last sample is within `samples`.
    pub(crate) fn from_parts(
        samples: Samples<'a>,
        width: usize,
        height: usize,
        format: PixelFormat,
        strides: [usize; 3],
    ) -> Self {
        debug_assert!(
            (height - 1) * strides[0] + (width - 1) * strides[1] + (format.channels() - 1) * strides[2]
                < samples.len()
        );
        Self { samples, width, height, format, strides }
    }

    /// Returns the width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns the order of the channels.
    pub fn format(&self) -> PixelFormat {
        self.format
    }

    /// Returns the samples, starting with the first of the view.
    pub fn samples(&self) -> Samples<'a> {
        self.samples
    }

    /// Returns the distances in samples to the next row, pixel and channel.
    pub fn strides(&self) -> [usize; 3] {
        self.strides
    }

    /// Returns the part of the view from `(x, y)` on, clipped to the view; `None` if nothing is left.
    #[must_use]
    pub fn crop(&self, x: usize, y: usize, width: usize, height: usize) -> Option<Self> {
        let width = width.min(self.width.checked_sub(x)?);
        let height = height.min(self.height.checked_sub(y)?);
        if width == 0 || height == 0 {
            return None;
        }
        let start = y * self.strides[0] + x * self.strides[1];
        let samples = match self.samples {
            Samples::U8(data) => Samples::U8(&data[start..]),
            Samples::U16(data) => Samples::U16(&data[start..]),
            Samples::F32(data) => Samples::F32(&data[start..]),
        };
        Some(Self { samples, width, height, ..*self })
    }

    /// Returns one sample as `u8`: the high byte of `u16`; floats as 0..=1, saturated, NaN as 0.
    ///
    /// # Panics
    /// Panics if the position is outside the memory of the view.
    #[inline]
    pub fn sample_u8(&self, x: usize, y: usize, channel: usize) -> u8 {
        let at = y * self.strides[0] + x * self.strides[1] + channel * self.strides[2];
        match self.samples {
            Samples::U8(data) => data[at],
            Samples::U16(data) => (data[at] >> 8) as u8,
            Samples::F32(data) => (data[at] * 255.0 + 0.5) as u8,
        }
    }

    /// Returns a copy as `[height, width, channels]` in `format`; see [`crate::data::Image::hwc_u8`].
    pub fn hwc_u8(&self, format: PixelFormat) -> Vec<u8> {
        let mut out = Vec::with_capacity(self.width * self.height * format.channels());
        if let (Samples::U8(data), true) =
            (self.samples, format == self.format && self.strides[1..] == [format.channels(), 1])
        {
            for row in 0..self.height {
                out.extend_from_slice(&data[row * self.strides[0]..][..self.width * format.channels()]);
            }
            return out;
        }
        let [red, green, blue] = self.format.rgb_offsets();
        let opacity = (self.format.channels() == 4).then_some(3);
        for y in 0..self.height {
            for x in 0..self.width {
                let rgb = [red, green, blue].map(|channel| self.sample_u8(x, y, channel));
                let alpha = opacity.map_or(255, |channel| self.sample_u8(x, y, channel));
                match format {
                    PixelFormat::Grey => out.push(grey_from_rgb(rgb)),
                    PixelFormat::Rgb => out.extend(rgb),
                    PixelFormat::Bgr => out.extend([rgb[2], rgb[1], rgb[0]]),
                    PixelFormat::Rgba => out.extend([rgb[0], rgb[1], rgb[2], alpha]),
                    PixelFormat::Bgra => out.extend([rgb[2], rgb[1], rgb[0], alpha]),
                }
            }
        }
        out
    }

    /// Returns a copy as `[channels, height, width]`, RGB, opacity last; grey has one channel.
    pub fn chw_u8(&self) -> Vec<u8> {
        let rgb = self.format.rgb_offsets();
        let channels = self.format.channels();
        let mut out = Vec::with_capacity(self.width * self.height * channels);
        for channel in 0..channels {
            let source = rgb.get(channel).copied().unwrap_or(channel);
            for y in 0..self.height {
                out.extend((0..self.width).map(|x| self.sample_u8(x, y, source)));
            }
        }
        out
    }
}

/// Returns the luminance by ITU-R BT.601 with the weights of OpenCV and Pillow; equal channels are unchanged.
pub(crate) fn grey_from_rgb([red, green, blue]: [u8; 3]) -> u8 {
    ((u32::from(red) * 19595 + u32::from(green) * 38470 + u32::from(blue) * 7471 + 0x8000) >> 16) as u8
}

#[cfg(test)]
mod tests {
    use crate::data::{Image, Layout, PixelFormat};

    #[test]
    fn crop_is_clipped_at_the_border() {
        let image = Image::new((0..12).collect::<Vec<u8>>(), 4, 3, PixelFormat::Grey, Layout::Hwc).unwrap();
        let crop = image.view().crop(2, 1, 9, 9).unwrap();
        assert_eq!((crop.width(), crop.height()), (2, 2));
        assert_eq!(crop.hwc_u8(PixelFormat::Grey), [6, 7, 10, 11]);
        assert!(image.view().crop(4, 0, 1, 1).is_none());
        assert!(image.view().crop(0, 7, 1, 1).is_none());
    }

    #[test]
    fn floats_saturate() {
        let image =
            Image::new(vec![-1.0f32, 0.5, 2.0, f32::NAN], 4, 1, PixelFormat::Grey, Layout::Hwc).unwrap();
        assert_eq!(image.chw_u8(), [0, 128, 255, 0]);
    }
}
