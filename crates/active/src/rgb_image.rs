//! Images of bytes in any format, as RGB bytes pixel after pixel.

use std::borrow::Cow;

use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};
use opendr_engine::{Error, Result};

/// Returns an image of bytes as RGB, pixel after pixel; it is copied only if it is in another format.
///
/// # Errors
/// `InvalidInput` for an image that is not of 8 bits, since the range of other samples is unknown.
pub fn rgb_image(image: &Image) -> Result<Cow<'_, Image>> {
    if !matches!(image.pixels(), Pixels::U8(_)) {
        return Err(Error::invalid_input("active perception takes images of 8 bits; convert the image"));
    }
    if image.layout() == Layout::Hwc && image.format() == PixelFormat::Rgb {
        return Ok(Cow::Borrowed(image));
    }
    let rgb = Image::from_rgb8(image.hwc_u8(PixelFormat::Rgb), image.width(), image.height())?;
    Ok(Cow::Owned(rgb))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_and_layouts_become_rgb() {
        let rgb = Image::from_rgb8(vec![1, 2, 3, 4, 5, 6], 2, 1).unwrap();
        assert!(matches!(rgb_image(&rgb).unwrap(), Cow::Borrowed(_)));
        let made = |pixels: Vec<u8>, format, layout| Image::new(pixels, 2, 1, format, layout).unwrap();
        for image in [
            made(vec![3, 2, 1, 6, 5, 4], PixelFormat::Bgr, Layout::Hwc),
            made(vec![1, 4, 2, 5, 3, 6], PixelFormat::Rgb, Layout::Chw),
            made(vec![1, 2, 3, 9, 4, 5, 6, 9], PixelFormat::Rgba, Layout::Hwc),
        ] {
            assert_eq!(*rgb_image(&image).unwrap(), rgb);
        }
        let grey = made(vec![7, 8], PixelFormat::Grey, Layout::Hwc);
        assert_eq!(*rgb_image(&grey).unwrap(), Image::from_rgb8(vec![7, 7, 7, 8, 8, 8], 2, 1).unwrap());
        let deep = Image::new(vec![1_u16; 6], 2, 1, PixelFormat::Rgb, Layout::Hwc).unwrap();
        assert!(rgb_image(&deep).is_err());
    }
}
