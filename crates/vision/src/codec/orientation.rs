//! EXIF orientation.

use std::sync::Arc;

use image::metadata::Orientation;
use opendr_engine::data::{Image, Layout, Pixels};
use opendr_engine::{Error, Result};

/// Side of the tiles in which pixels are moved: the rows of a tile stay in the cache while its columns are read.
const TILE: usize = 32;

/// Applies the EXIF orientation to a `u8`, `HWC` image.
pub(super) fn upright(image: Image, orientation: Orientation) -> Result<Image> {
    if orientation == Orientation::NoTransforms {
        return Ok(image);
    }
    let (stored, format) = ([image.width(), image.height()], image.format());
    let Pixels::U8(samples) = image.into_pixels() else {
        return Err(Error::internal("a decoded image does not have u8 samples"));
    };
    let samples = Arc::unwrap_or_clone(samples);
    let ([width, height], samples) = match format.channels() {
        1 => turned::<1>(samples, stored, orientation),
        3 => turned::<3>(samples, stored, orientation),
        _ => turned::<4>(samples, stored, orientation),
    };
    Image::new(samples, width, height, format, Layout::Hwc)
}

/// Returns size and samples of the turned image.
fn turned<const CHANNELS: usize>(
    mut samples: Vec<u8>,
    [width, height]: [usize; 2],
    orientation: Orientation,
) -> ([usize; 2], Vec<u8>) {
    if orientation == Orientation::Rotate180 {
        samples.as_chunks_mut::<CHANNELS>().0.reverse();
        return ([width, height], samples);
    }
    // Offset of the turned image's first pixel in the stored one, and of its next pixel and next row, in pixels.
    let (right, down) = (1, width as isize);
    let (last_column, last_row) = ((width - 1) as isize, ((height - 1) * width) as isize);
    let (origin, next_pixel, next_row) = match orientation {
        Orientation::NoTransforms => (0, right, down),
        Orientation::FlipHorizontal => (last_column, -right, down),
        Orientation::Rotate180 => (last_row + last_column, -right, -down),
        Orientation::FlipVertical => (last_row, right, -down),
        Orientation::Rotate90FlipH => (0, down, right),
        Orientation::Rotate90 => (last_row, -down, right),
        Orientation::Rotate270FlipH => (last_row + last_column, -down, -right),
        Orientation::Rotate270 => (last_column, down, -right),
    };
    let lies = matches!(
        orientation,
        Orientation::Rotate90
            | Orientation::Rotate270
            | Orientation::Rotate90FlipH
            | Orientation::Rotate270FlipH
    );
    let [width, height] = if lies { [height, width] } else { [width, height] };
    let stored = samples.as_chunks::<CHANNELS>().0;
    let mut seen = vec![[0u8; CHANNELS]; width * height];
    for (top, left) in (0..height).step_by(TILE).flat_map(|y| (0..width).step_by(TILE).map(move |x| (y, x))) {
        let right = width.min(left + TILE);
        for y in top..height.min(top + TILE) {
            let mut at = origin + y as isize * next_row + left as isize * next_pixel;
            for pixel in &mut seen[y * width + left..y * width + right] {
                *pixel = stored[at as usize];
                at += next_pixel;
            }
        }
    }
    ([width, height], seen.into_flattened())
}

#[cfg(test)]
mod tests {
    use image::{DynamicImage, ImageBuffer};
    use opendr_engine::data::PixelFormat;

    use super::*;

    #[test]
    fn pixels_go_where_the_image_crate_moves_them() {
        for (width, height) in [(70, 45), (1, 33), (64, 1), (1, 1)] {
            let samples: Vec<u8> = (0..width * height * 3).map(|index| (index * 7 / 3) as u8).collect();
            for orientation in (1..=8).filter_map(Orientation::from_exif) {
                let buffer = ImageBuffer::from_raw(width, height, samples.clone()).unwrap();
                let mut wanted = DynamicImage::ImageRgb8(buffer);
                wanted.apply_orientation(orientation);
                let (columns, rows) = (width as usize, height as usize);
                let stored =
                    Image::new(samples.clone(), columns, rows, PixelFormat::Rgb, Layout::Hwc).unwrap();
                let seen = upright(stored, orientation).unwrap();
                assert_eq!(seen.width(), wanted.width() as usize, "{orientation:?}");
                assert_eq!(seen.hwc_u8(PixelFormat::Rgb), wanted.as_bytes(), "{orientation:?}");
            }
        }
    }
}
