//! Luminance at several scales.

use opendr_engine::data::{Image, Pixels};

/// Luminance of an image, 0 to 255, each level with half the side of the one before.
#[derive(Debug, Clone, Default)]
pub(crate) struct Pyramid {
    levels: Vec<Level>,
}

/// One level: rows of `width` numbers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Level {
    pub luminance: Vec<f32>,
    pub width: usize,
    pub height: usize,
}

/// Number of levels: motions of some 100 pixels remain within the window of the coarsest.
const LEVELS: usize = 4;

impl Pyramid {
    /// Computes the levels of an image; memory is used again.
    pub fn fill(&mut self, image: &Image) {
        self.levels.resize_with(LEVELS, Level::default);
        let first = &mut self.levels[0];
        (first.width, first.height) = (image.width(), image.height());
        first.luminance.clear();
        first.luminance.resize(first.width * first.height, 0.0);
        fill_luminance(image, &mut first.luminance);
        for at in 1..LEVELS {
            let (finer, coarser) = self.levels.split_at_mut(at);
            coarser[0].halve(&finer[at - 1]);
        }
    }

    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// Returns the level of the image's own size.
    pub fn finest(&self) -> &Level {
        &self.levels[0]
    }
}

fn fill_luminance(image: &Image, luminance: &mut [f32]) {
    let view = image.view();
    let [row_step, column_step, channel_step] = view.strides();
    let channels = image.channels();
    let offsets = image.format().rgb_offsets();
    let rows = luminance.chunks_exact_mut(image.width()).enumerate();
    match image.pixels() {
        Pixels::U8(bytes) if channels >= 3 && channel_step == 1 => {
            for (y, row) in rows {
                let pixels = bytes[y * row_step..].chunks_exact(column_step);
                for (value, pixel) in row.iter_mut().zip(pixels) {
                    let [r, g, b] = offsets.map(|at| u32::from(pixel[at]));
                    // ITU-R BT.601 with 16 bits.
                    *value = ((19_595 * r + 38_470 * g + 7_471 * b + 0x8000) >> 16) as f32;
                }
            }
        }
        Pixels::U8(bytes) if channels == 1 => {
            for (y, row) in rows {
                let pixels = &bytes[y * row_step..];
                row.iter_mut().zip(pixels).for_each(|(value, byte)| *value = f32::from(*byte));
            }
        }
        _ => {
            for (y, row) in rows {
                for (x, value) in row.iter_mut().enumerate() {
                    let [r, g, b] = offsets.map(|at| f32::from(view.sample_u8(x, y, at)));
                    *value = 0.299 * r + 0.587 * g + 0.114 * b;
                }
            }
        }
    }
}

impl Level {
    /// Becomes half of `finer`, by means of 2x2 pixels: the centre of a pixel is between those of four.
    fn halve(&mut self, finer: &Self) {
        (self.width, self.height) = (finer.width / 2, finer.height / 2);
        self.luminance.clear();
        for y in 0..self.height {
            let rows = [2 * y, 2 * y + 1].map(|row| &finer.luminance[row * finer.width..][..2 * self.width]);
            let pairs = rows[0].chunks_exact(2).zip(rows[1].chunks_exact(2));
            self.luminance.extend(pairs.map(|(a, b)| 0.25 * (a[0] + a[1] + b[0] + b[1])));
        }
    }
}
