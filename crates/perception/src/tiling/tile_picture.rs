use opendr_engine::data::{Image, ImageView, Layout, PixelFormat, Samples};
use opendr_engine::{Error, Result};

use crate::regions::Region;

/// A part of a picture as a picture of its own; its memory is used again.
#[derive(Debug, Default)]
pub struct TilePicture {
    image: Option<Image>,
}

impl TilePicture {
    /// The pixels of `region`, 8 bits a sample: channels in the order of the picture, else RGB.
    ///
    /// # Errors
    /// `InvalidInput` when the region has no pixel in the picture.
    pub fn cut(&mut self, view: ImageView<'_>, region: &Region) -> Result<&Image> {
        let Region { x, y, width, height } = *region;
        let outside = || Error::invalid_input(format!("{region:?} lies outside of the picture"));
        let part = view.crop(x, y, width, height).ok_or_else(outside)?;
        let (width, height) = (part.width(), part.height());
        let format = part.format();
        let usable = self.image.as_ref().is_some_and(|image| {
            [image.width(), image.height()] == [width, height] && image.format() == format
        });
        let rows = match part.samples() {
            Samples::U8(samples) if part.strides()[1..] == [format.channels(), 1] => Some(samples),
            _ => None,
        };
        match (rows, self.image.as_mut().filter(|_| usable).and_then(Image::bytes_mut)) {
            (Some(samples), Some(bytes)) => {
                let stride = part.strides()[0];
                for (line, row) in bytes.chunks_exact_mut(width * format.channels()).zip(0..) {
                    line.copy_from_slice(&samples[row * stride..][..line.len()]);
                }
            }
            _ => {
                let format =
                    if rows.is_some() || format == PixelFormat::Grey { format } else { PixelFormat::Rgb };
                self.image = Some(Image::new(part.hwc_u8(format), width, height, format, Layout::Hwc)?);
            }
        }
        self.image.as_ref().ok_or_else(outside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_those_of_the_region() {
        let samples: Vec<u8> = (0..20 * 10 * 3).map(|at| (at % 251) as u8).collect();
        let image = Image::new(samples, 20, 10, PixelFormat::Bgr, Layout::Hwc).unwrap();
        let mut picture = TilePicture::default();
        for (x, y) in [(0, 0), (3, 2), (15, 6)] {
            let region = Region { x, y, width: 5, height: 4 };
            let part = picture.cut(image.view(), &region).unwrap();
            assert_eq!(part.format(), PixelFormat::Bgr);
            for (across, down) in [(0, 0), (4, 3), (2, 1)] {
                let wanted = image.view().sample_u8(x + across, y + down, 1);
                assert_eq!(part.view().sample_u8(across, down, 1), wanted);
            }
        }
        let cut = picture.cut(image.view(), &Region { x: 18, y: 9, width: 5, height: 5 }).unwrap();
        assert_eq!((cut.width(), cut.height()), (2, 1));
        assert!(picture.cut(image.view(), &Region { x: 20, y: 0, width: 5, height: 5 }).is_err());
    }

    #[test]
    fn other_samples_become_bytes() {
        let metres: Vec<f32> = (0..64).map(|at| at as f32 / 64.0).collect();
        let image = Image::new(metres, 8, 8, PixelFormat::Grey, Layout::Hwc).unwrap();
        let mut picture = TilePicture::default();
        for _ in 0..2 {
            let part = picture.cut(image.view(), &Region { x: 4, y: 4, width: 4, height: 4 }).unwrap();
            assert_eq!(part.view().sample_u8(0, 0, 0), image.view().sample_u8(4, 4, 0));
        }
    }
}
