//! Luminance of an image, in bytes.

use opendr_engine::data::{ImageView, Samples};

use crate::preprocess::LUMINANCE;

/// The luminance of blocks of an image; its memory is reused.
#[derive(Debug, Default)]
pub(super) struct Brightness {
    /// Sums of the samples of a row of blocks, per column.
    columns: Vec<u32>,
    /// ITU-R BT.601 luminance, 0..=255, row by row.
    pub levels: Vec<u8>,
}

impl Brightness {
    /// Computes the mean of each block of `side` x `side` pixels; `size` is the number of complete blocks.
    pub fn fill(&mut self, view: &ImageView<'_>, size: [usize; 2], side: usize) {
        let Self { columns, levels } = self;
        let [across, down] = size;
        let width = across * side;
        let [row, pixel, channel] = view.strides();
        let offsets = view.format().rgb_offsets();
        let bytes = match view.samples() {
            Samples::U8(bytes) if channel == 1 || view.format().channels() == 1 => Some(bytes),
            _ => None,
        };
        let (step, places) = if bytes.is_some() { (pixel, offsets) } else { (3, [0, 1, 2]) };
        let weights = LUMINANCE.map(|weight| weight / (side * side) as f32);
        levels.clear();
        for first in (0..down).map(|y| y * side) {
            columns.clear();
            columns.resize(width * step, 0);
            for y in first..first + side {
                match bytes {
                    Some(bytes) => {
                        let samples = columns.iter_mut().zip(&bytes[y * row..]);
                        samples.for_each(|(sum, sample)| *sum += u32::from(*sample));
                    }
                    None => {
                        for (x, sums) in columns.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                            let channels = offsets.map(|channel| view.sample_u8(x, y, channel));
                            sums.iter_mut().zip(channels).for_each(|(sum, sample)| *sum += u32::from(sample));
                        }
                    }
                }
            }
            levels.extend(columns.chunks_exact(side * step).map(|square| {
                let mut level = 0.5;
                for (place, weight) in places.into_iter().zip(weights) {
                    let sum: u32 = square.iter().skip(place).step_by(step).sum();
                    level += weight * sum as f32;
                }
                level as u8
            }));
        }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};

    use super::*;

    #[test]
    fn squares_are_means_in_every_layout() {
        let rgb: Vec<u8> = (0..5 * 4 * 3).map(|at| (at * 37 % 251) as u8).collect();
        let hwc = Image::new(rgb.clone(), 5, 4, PixelFormat::Rgb, Layout::Hwc).unwrap();
        let planes = Image::new(hwc.chw_u8(), 5, 4, PixelFormat::Rgb, Layout::Chw).unwrap();
        let bgr = Image::new(hwc.hwc_u8(PixelFormat::Bgr), 5, 4, PixelFormat::Bgr, Layout::Hwc).unwrap();
        let deep: Vec<u16> = rgb.iter().map(|level| u16::from(*level) * 257).collect();
        let deep = Image::new(Pixels::from(deep), 5, 4, PixelFormat::Rgb, Layout::Hwc).unwrap();
        for side in [1, 2, 3] {
            let size = [5 / side, 4 / side];
            let wanted = |index: usize| {
                let (x, y) = (index % size[0] * side, index / size[0] * side);
                let pixels = (0..side * side).map(|at| (y + at / side) * 5 + x + at % side);
                let light = |pixel: usize| -> f32 {
                    (0..3).map(|channel| f32::from(rgb[3 * pixel + channel]) * LUMINANCE[channel]).sum()
                };
                (pixels.map(light).sum::<f32>() / (side * side) as f32).round() as u8
            };
            let wanted: Vec<u8> = (0..size[0] * size[1]).map(wanted).collect();
            for image in [&hwc, &planes, &bgr, &deep] {
                let mut brightness = Brightness::default();
                brightness.fill(&image.view(), size, side);
                assert_eq!(brightness.levels, wanted, "{side} {:?}", image.layout());
            }
        }
        let grey = Image::new(vec![7_u8, 255, 0, 9], 2, 2, PixelFormat::Grey, Layout::Hwc).unwrap();
        let mut brightness = Brightness::default();
        brightness.fill(&grey.view(), [2, 2], 1);
        assert_eq!(brightness.levels, [7, 255, 0, 9]);
    }
}
