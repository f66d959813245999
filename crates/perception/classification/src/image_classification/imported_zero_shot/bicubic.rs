//! Antialiased bicubic scaling (Keys 1981, with a = -1/2), as PIL and torchvision scale the images of CLIP.

use std::ops::Range;

use opendr_engine::data::{Image, ImageView, Layout};
use opendr_engine::{Error, Result};
use opendr_vision::{ChannelOrder, Preprocess};

/// Support of the kernel on either side, in pixels of the coarser of input and output.
const SUPPORT: f64 = 2.0;
/// Maximum number of pixels of the part of an image that is scaled.
const MAX_PIXELS: usize = 1 << 28;
/// Number of bits after the point of weights and sums, as in PIL. The absolute weights of a sample sum up to less than 2.
const BITS: u32 = 22;
/// What rounds a sum.
const HALF: i32 = 1 << (BITS - 1);

/// Scales images to the size of a network's input. Tables of the last size are kept, so that a stream allocates nothing.
#[derive(Default)]
pub struct Bicubic {
    sizes: Sizes,
    columns: Taps,
    rows: Taps,
    /// Copies the part of an image that is scaled.
    copy: Option<Preprocess>,
    part: Vec<u8>,
    /// The part with the columns of the output.
    narrow: Vec<u8>,
    /// Sums of a line of the output.
    sums: Vec<i32>,
    output: Option<Image>,
}

/// What the tables depend on.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sizes {
    /// Width and height of the image.
    pub image: [usize; 2],
    /// Width and height of the network's input.
    pub input: [usize; 2],
    /// Share of the largest part with the input's aspect ratio that is kept; 0 for the whole image.
    pub crop: f32,
}

impl Sizes {
    /// Returns width and height of the whole scaled image, of which the centre is the input.
    fn scaled(&self) -> [usize; 2] {
        let [image, input] = [self.image, self.input];
        if self.crop <= 0.0 {
            return input;
        }
        // The axis along which the image is the smaller one.
        let short = usize::from(input[1] as u64 * image[0] as u64 > input[0] as u64 * image[1] as u64);
        let long = 1 - short;
        let mut scaled = [0; 2];
        scaled[short] = (input[short] as f64 / f64::from(self.crop)).round() as usize;
        scaled[long] = (scaled[short] as f64 * image[long] as f64 / image[short] as f64) as usize;
        [scaled[0].max(input[0]), scaled[1].max(input[1])]
    }
}

/// The samples of one axis that each output sample is a weighted mean of.
#[derive(Default)]
struct Taps {
    /// First input sample, and range of the weights.
    places: Vec<(usize, Range<usize>)>,
    weights: Vec<i32>,
}

impl Taps {
    /// Computes the taps of the central `count` of `scaled` samples over `image` ones.
    fn fill(&mut self, image: usize, scaled: usize, count: usize) {
        self.places.clear();
        self.weights.clear();
        let scale = image as f64 / scaled as f64;
        let stretch = scale.max(1.0);
        let first = (scaled - count) / 2;
        for output in first..first + count {
            let centre = (output as f64 + 0.5) * scale;
            let begin = (centre - SUPPORT * stretch + 0.5).max(0.0) as usize;
            let end = ((centre + SUPPORT * stretch + 0.5) as usize).min(image);
            let weight = |input: usize| kernel((input as f64 + 0.5 - centre) / stretch);
            let sum: f64 = (begin..end).map(weight).sum();
            let start = self.weights.len();
            self.weights.extend((begin..end).map(|input| fixed(weight(input) / sum)));
            self.places.push((begin, start..self.weights.len()));
        }
    }

    /// Returns the range of the input that has taps.
    fn extent(&self) -> Range<usize> {
        let end = |(first, weights): &(usize, Range<usize>)| first + weights.len();
        let first = self.places.iter().map(|(first, _)| *first).min().unwrap_or_default();
        first..self.places.iter().map(end).max().unwrap_or_default()
    }

    /// Returns for each output sample its first input sample after `origin` and its weights.
    fn after(&self, origin: usize) -> impl Iterator<Item = (usize, &[i32])> {
        self.places.iter().map(move |(first, weights)| {
            (first - origin, self.weights.get(weights.clone()).unwrap_or_default())
        })
    }
}

fn kernel(distance: f64) -> f64 {
    const A: f64 = -0.5;
    let x = distance.abs();
    match x {
        _ if x < 1.0 => ((A + 2.0) * x - (A + 3.0)) * x * x + 1.0,
        _ if x < 2.0 => (((x - 5.0) * x + 8.0) * x - 4.0) * A,
        _ => 0.0,
    }
}

fn fixed(weight: f64) -> i32 {
    (weight * f64::from(1 << BITS)).round() as i32
}

/// Returns the level of a sum.
fn level(sum: i32) -> u8 {
    (sum >> BITS).clamp(0, 255) as u8
}

impl Bicubic {
    /// Returns the network's input for an image: RGB, 8 bits. Levels are rounded after each axis, as PIL does.
    ///
    /// # Errors
    /// `InvalidInput` for an image that is too large.
    pub fn run(&mut self, image: ImageView<'_>, input: [usize; 2], crop: f32) -> Result<&Image> {
        let sizes = Sizes { image: [image.width(), image.height()], input, crop };
        if self.sizes != sizes || self.output.is_none() {
            self.prepare(sizes)?;
        }
        let (columns, rows) = (self.columns.extent(), self.rows.extent());
        let part = image.crop(columns.start, rows.start, columns.len(), rows.len());
        let (Some(copy), Some(part), Some(output)) = (&self.copy, part, &mut self.output) else {
            return Err(Error::internal("the scaled part is not in the image"));
        };
        copy.run_into(part, &mut self.part)?;
        let lines = self.part.chunks_exact(3 * columns.len());
        for (line, narrow) in lines.zip(self.narrow.chunks_exact_mut(3 * input[0])) {
            for ((first, weights), pixel) in self.columns.after(columns.start).zip(narrow.as_chunks_mut().0) {
                *pixel = mean_of_pixels(line.get(3 * first..).unwrap_or_default(), weights);
            }
        }
        let width = 3 * input[0];
        let Some(samples) = output.bytes_mut() else { return Err(Error::internal("an image without bytes")) };
        for ((first, weights), line) in self.rows.after(rows.start).zip(samples.chunks_exact_mut(width)) {
            self.sums.fill(HALF);
            let lines = self.narrow.get(width * first..).unwrap_or_default().chunks_exact(width);
            for (weight, values) in weights.iter().zip(lines) {
                let values = self.sums.iter_mut().zip(values);
                values.for_each(|(sum, value)| *sum += weight * i32::from(*value));
            }
            line.iter_mut().zip(&self.sums).for_each(|(sample, sum)| *sample = level(*sum));
        }
        Ok(output)
    }

    fn prepare(&mut self, sizes: Sizes) -> Result<()> {
        let [width, height] = sizes.input;
        let scaled = sizes.scaled();
        self.columns.fill(sizes.image[0], scaled[0], width);
        self.rows.fill(sizes.image[1], scaled[1], height);
        let [columns, rows] = [self.columns.extent().len(), self.rows.extent().len()];
        if columns.saturating_mul(rows) > MAX_PIXELS {
            return Err(Error::invalid_input(format!("an image of {columns} x {rows} pixels is too large")));
        }
        self.copy = Some(Preprocess::new(columns, rows).order(ChannelOrder::Rgb).layout(Layout::Hwc));
        self.part.resize(3 * columns * rows, 0);
        self.narrow.resize(3 * width * rows, 0);
        self.sums.resize(3 * width, HALF);
        self.output = Some(Image::from_rgb8(vec![0; 3 * width * height], width, height)?);
        self.sizes = sizes;
        Ok(())
    }
}

/// Returns the weighted mean of pixels of three channels.
fn mean_of_pixels(pixels: &[u8], weights: &[i32]) -> [u8; 3] {
    let mut sums = [HALF; 3];
    for (weight, pixel) in weights.iter().zip(pixels.as_chunks::<3>().0) {
        for (sum, value) in sums.iter_mut().zip(pixel) {
            *sum += weight * i32::from(*value);
        }
    }
    sums.map(level)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a row of red levels.
    fn row(levels: &[u8]) -> Image {
        let samples = levels.iter().flat_map(|level| [*level, 0, 255]).collect();
        Image::from_rgb8(samples, levels.len(), 1).unwrap()
    }

    #[test]
    fn rows_are_those_of_pil() {
        let image = row(&[0, 10, 250, 30, 200, 255, 7, 90]);
        let scaled = |width: usize| {
            let mut bicubic = Bicubic::default();
            let image = bicubic.run(image.view(), [width, 1], 0.0).unwrap();
            image.hwc_u8(image.format()).chunks(3).map(|pixel| pixel[0]).collect::<Vec<_>>()
        };
        // PIL.Image.resize((width, 1), PIL.Image.BICUBIC) of Pillow 13.0.0.
        assert_eq!(scaled(8), [0, 10, 250, 30, 200, 255, 7, 90]);
        assert_eq!(scaled(3), [61, 164, 105]);
        assert_eq!(scaled(5), [0, 151, 129, 189, 49]);
        assert_eq!(scaled(13), [0, 0, 15, 192, 214, 40, 98, 213, 255, 179, 11, 47, 96]);
    }

    #[test]
    fn sizes_are_those_of_transformers() {
        let scaled = |image, input, crop| Sizes { image, input, crop }.scaled();
        assert_eq!(scaled([640, 480], [224, 224], 1.0), [298, 224]);
        assert_eq!(scaled([480, 641], [224, 224], 1.0), [224, 299]);
        assert_eq!(scaled([640, 480], [224, 224], 0.875), [341, 256]);
        assert_eq!(scaled([640, 480], [224, 224], 0.0), [224, 224]);
        assert_eq!(scaled([1, 4000], [224, 224], 1.0), [224, 896_000]);
        assert_eq!(scaled([640, 480], [64, 32], 1.0), [64, 48]);
    }
}
