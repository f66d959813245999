//! Pre-processing of an image to the input of a network.

use std::mem::MaybeUninit;

use opendr::data::{Image, PixelFormat};
use opendr::vision::{ChannelOrder, LetterboxAlign, Preprocess};
use opendr::{Error, Result};

use crate::data::{FORMATS, LAYOUTS, from_number};
use crate::pointer::{place, reference, slice};
use crate::status::{guard, opendr_status};
use crate::value::{opendr_image, typed};

/// Pre-processing of an image: resizing, (sample - mean) / std per channel, and the layout of the result.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_preprocess {
    /// Width of the input in pixels.
    pub width: usize,
    /// Height of the input in pixels.
    pub height: usize,
    /// The channels of the input: OPENDR_GREY, OPENDR_RGB or OPENDR_BGR.
    pub format: i32,
    /// One of opendr_layout.
    pub layout: i32,
    /// Mean of each channel, for samples of 0 to 255; greyscale uses the first.
    pub mean: [f32; 3],
    /// Standard deviation of each channel, for samples of 0 to 255; not 0.
    pub std: [f32; 3],
    /// Sample value of the padding (letterbox, with the image in the centre); NaN stretches the image instead.
    pub pad: f32,
}

/// Writes the network input for an image into numbers: length numbers, width * height * channels.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_image_preprocess(
    image: *const opendr_image,
    how: *const opendr_preprocess,
    numbers: *mut f32,
    length: usize,
) -> opendr_status {
    guard(|| {
        let place = place(numbers, "numbers")?;
        // SAFETY: the rules at the top of opendr.h.
        let (image, how) = unsafe {
            slice(numbers.cast::<MaybeUninit<f32>>(), length, "numbers")?;
            (typed::<Image, _>(image, "image")?, reference(how, "how")?)
        };
        let preprocess = how.to_preprocess()?;
        if length != preprocess.len() {
            return Err(Error::invalid_input(format!(
                "numbers has room for {length} numbers, and the input has the shape {:?}; give room for all",
                preprocess.shape()
            )));
        }
        let mut input = vec![0.0f32; length];
        preprocess.run_into(image.view(), &mut input)?;
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.copy_from_nonoverlapping(input.as_ptr(), length) };
        Ok(())
    })
}

impl opendr_preprocess {
    fn to_preprocess(self) -> Result<Preprocess> {
        let format = from_number(&FORMATS, self.format, |known| *known as i32, "format")?;
        let layout = from_number(&LAYOUTS, self.layout, |known| *known as i32, "layout")?;
        let order = match format {
            PixelFormat::Grey => ChannelOrder::Grey,
            PixelFormat::Rgb => ChannelOrder::Rgb,
            PixelFormat::Bgr => ChannelOrder::Bgr,
            PixelFormat::Rgba | PixelFormat::Bgra => {
                return Err(Error::invalid_input(
                    "a network's input has no alpha channel; give OPENDR_GREY, OPENDR_RGB or OPENDR_BGR",
                ));
            }
        };
        let is_valid = |std: &f32| std.is_finite() && *std != 0.0;
        if !self.mean.iter().all(|mean| mean.is_finite()) || !self.std.iter().all(is_valid) {
            return Err(Error::invalid_input(format!(
                "mean {:?} or std {:?} is invalid; give finite numbers, and no std of 0",
                self.mean, self.std
            )));
        }
        let preprocess = Preprocess::new(self.width, self.height)
            .order(order)
            .layout(layout)
            .normalise(self.mean, self.std);
        match self.pad {
            stretched if stretched.is_nan() => Ok(preprocess),
            pad if pad.is_finite() => Ok(preprocess.letterbox(LetterboxAlign::Centre, pad)),
            pad => Err(Error::invalid_input(format!("pad is {pad}; give a value of 0 to 255, or NaN"))),
        }
    }
}
