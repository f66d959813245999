use opendr_engine::data::{Image, ImageView, Layout, PixelFormat, Samples};
use opendr_engine::{Error, Result};
use opendr_perception_common::regions::Region;

use crate::Slot;

/// Level between parts.
const BETWEEN: u8 = 114;

/// A region of an image as an image of its own; its memory is reused.
#[derive(Debug, Default)]
pub struct TileImage {
    image: Option<Image>,
}

impl TileImage {
    /// Copies the pixels of `region` to 8 bits per sample: channels in the order of the image, or RGB.
    ///
    /// # Errors
    /// `InvalidInput` when the region has no pixel in the image.
    pub fn crop(&mut self, view: ImageView<'_>, region: &Region) -> Result<&Image> {
        let Region { x, y, width, height } = *region;
        let outside = || Error::invalid_input(format!("{region:?} is outside the image"));
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

    /// Copies the parts of several tiles side by side into a square of `side` pixels, RGB, with grey between them.
    ///
    /// # Errors
    /// `InvalidInput` when a part has pixels outside the image or the square.
    pub fn pack(&mut self, view: ImageView<'_>, slots: &[Slot], side: usize) -> Result<&Image> {
        let is_usable = |image: &Image| {
            [image.width(), image.height()] == [side, side] && image.format() == PixelFormat::Rgb
        };
        if !self.image.as_ref().is_some_and(is_usable) {
            self.image = Some(Image::from_rgb8(vec![BETWEEN; 3 * side * side], side, side)?);
        }
        let outside = || Error::invalid_input("a part of a tile is outside the image");
        let bytes = self.image.as_mut().and_then(Image::bytes_mut).ok_or_else(outside)?;
        bytes.fill(BETWEEN);
        let channels = view.format().rgb_offsets();
        for Slot { part: Region { x, y, width, height }, position: [left, top], .. } in slots {
            let part = view.crop(*x, *y, *width, *height).filter(|part| left + part.width() <= side);
            let part = part.ok_or_else(outside)?;
            for row in 0..part.height() {
                let begin = 3 * ((top + row) * side + left);
                let line = bytes.get_mut(begin..begin + 3 * part.width()).ok_or_else(outside)?;
                for (column, pixel) in line.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                    *pixel = channels.map(|channel| part.sample_u8(column, row, channel));
                }
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
        let mut picture = TileImage::default();
        for (x, y) in [(0, 0), (3, 2), (15, 6)] {
            let region = Region { x, y, width: 5, height: 4 };
            let part = picture.crop(image.view(), &region).unwrap();
            assert_eq!(part.format(), PixelFormat::Bgr);
            for (across, down) in [(0, 0), (4, 3), (2, 1)] {
                let expected = image.view().sample_u8(x + across, y + down, 1);
                assert_eq!(part.view().sample_u8(across, down, 1), expected);
            }
        }
        let cut = picture.crop(image.view(), &Region { x: 18, y: 9, width: 5, height: 5 }).unwrap();
        assert_eq!((cut.width(), cut.height()), (2, 1));
        assert!(picture.crop(image.view(), &Region { x: 20, y: 0, width: 5, height: 5 }).is_err());
    }

    #[test]
    fn parts_lie_where_they_are_put() {
        let samples: Vec<u8> = (0..20 * 10 * 3).map(|at| (at % 113) as u8).collect();
        let image = Image::new(samples, 20, 10, PixelFormat::Bgr, Layout::Hwc).unwrap();
        let slot = |x, y, at| Slot { tile: 0, part: Region { x, y, width: 4, height: 3 }, position: at };
        let slots = [slot(2, 5, [0, 0]), slot(16, 7, [8, 5])];
        let mut picture = TileImage::default();
        for _ in 0..2 {
            let put = picture.pack(image.view(), &slots, 12).unwrap().view();
            // Red is the last channel of the image.
            assert_eq!(put.sample_u8(1, 2, 0), image.view().sample_u8(3, 7, 2));
            assert_eq!(put.sample_u8(11, 7, 2), image.view().sample_u8(19, 9, 0));
            assert_eq!(put.sample_u8(6, 1, 0), BETWEEN);
        }
        assert!(picture.pack(image.view(), &[slot(2, 5, [9, 0])], 12).is_err());
        assert!(picture.pack(image.view(), &[slot(30, 5, [0, 0])], 12).is_err());
    }

    #[test]
    fn other_samples_become_bytes() {
        let metres: Vec<f32> = (0..64).map(|at| at as f32 / 64.0).collect();
        let image = Image::new(metres, 8, 8, PixelFormat::Grey, Layout::Hwc).unwrap();
        let mut picture = TileImage::default();
        for _ in 0..2 {
            let part = picture.crop(image.view(), &Region { x: 4, y: 4, width: 4, height: 4 }).unwrap();
            assert_eq!(part.view().sample_u8(0, 0, 0), image.view().sample_u8(4, 4, 0));
        }
    }
}
