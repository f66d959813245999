//! From a picture to the numbers that a network takes.

use std::mem::MaybeUninit;

use opendr::data::{Image, PixelFormat};
use opendr::vision::{Anchor, ChannelOrder, Preprocess};
use opendr::{Error, Result};

use crate::data::{FORMATS, LAYOUTS, from_number};
use crate::pointer::{place, reference, slice};
use crate::status::{guard, opendr_status};
use crate::value::{opendr_image, typed};

/// How a picture becomes the input of a network: scaled, (level - mean) / std by channel, in the order of the axes.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_preprocess {
    /// Pixels of a row of the input.
    pub width: usize,
    /// Rows of the input.
    pub height: usize,
    /// The channels of the input: OPENDR_GREY, OPENDR_RGB or OPENDR_BGR.
    pub format: i32,
    /// One of opendr_layout.
    pub layout: i32,
    /// Of each channel, in levels of 0 to 255; grey has the first.
    pub mean: [f32; 3],
    /// Of each channel, in levels of 0 to 255, not 0.
    pub std: [f32; 3],
    /// The level beside a picture that keeps its aspect ratio and stands in the middle; NaN stretches it instead.
    pub pad: f32,
}

/// Writes the input of a network that is made of a picture: length numbers, width * height * channels.
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
                "{length} numbers for an input of shape {:?}; give room for as many as that has",
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
                    "a network's input has no opacity; give OPENDR_GREY, OPENDR_RGB or OPENDR_BGR",
                ));
            }
        };
        let is_sound = |std: &f32| std.is_finite() && *std != 0.0;
        if !self.mean.iter().all(|mean| mean.is_finite()) || !self.std.iter().all(is_sound) {
            return Err(Error::invalid_input(format!(
                "mean {:?} and std {:?} of the channels; give finite numbers, and no std of 0",
                self.mean, self.std
            )));
        }
        let preprocess = Preprocess::new(self.width, self.height)
            .order(order)
            .layout(layout)
            .normalise(self.mean, self.std);
        match self.pad {
            stretched if stretched.is_nan() => Ok(preprocess),
            pad if pad.is_finite() => Ok(preprocess.letterbox(Anchor::Centre, pad)),
            pad => Err(Error::invalid_input(format!("pad {pad}; give a level of 0 to 255, or NaN"))),
        }
    }
}
