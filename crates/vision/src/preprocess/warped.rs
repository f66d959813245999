//! The kernel of rotated crops, for any sample type and any strides.

use opendr_engine::data::ImageView;

use crate::preprocess::band::Row;
use crate::preprocess::border::Border;
use crate::preprocess::sample::Written;
use crate::preprocess::strided::{Finish, LUMINANCE, Level};

/// Positions of a row's pixels in the image, in pixels times 2^32 from the centre of the image's first pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) start: [i64; 2],
    pub(super) step: [i64; 2],
}

/// Pixel strides and size of the image.
struct Grid {
    size: [i64; 2],
    strides: [usize; 2],
    border: Border,
}

impl Grid {
    fn offset(&self, x: i64, y: i64) -> usize {
        y as usize * self.strides[0] + x as usize * self.strides[1]
    }

    /// Returns the offset of a pixel whose right, lower and diagonal neighbours are inside the image too.
    fn inside(&self, left: i64, top: i64) -> Option<usize> {
        let is_inside = left >= 0 && top >= 0 && left + 1 < self.size[0] && top + 1 < self.size[1];
        is_inside.then(|| self.offset(left, top))
    }

    /// Returns the offset of a pixel; `None` outside the image.
    fn pixel(&self, x: i64, y: i64) -> Option<usize> {
        let [nearest_x, nearest_y] = [x.clamp(0, self.size[0] - 1), y.clamp(0, self.size[1] - 1)];
        (self.border == Border::Replicate || (nearest_x, nearest_y) == (x, y))
            .then(|| self.offset(nearest_x, nearest_y))
    }
}

/// Blends four levels: left and right above, left and right below.
#[inline(always)]
fn blend([a, b, c, d]: [f32; 4], weights: [f32; 2]) -> f32 {
    let mix = |from: f32, to: f32, weight: f32| from + (to - from) * weight;
    mix(mix(a, b, weights[0]), mix(c, d, weights[0]), weights[1])
}

/// Blends the pixels of `view` (whose samples are `samples`) along `line` into `row`.
pub(super) fn warp_row<S: Level, W: Written>(
    samples: &[S],
    view: &ImageView<'_>,
    line: Line,
    border: Border,
    finish: &Finish,
    row: &mut Row<'_, W>,
) {
    let [down, right, _] = view.strides();
    let grid = Grid { size: [view.width() as i64, view.height() as i64], strides: [down, right], border };
    let outside = if let Border::Constant(level) = border { level } else { 0.0 };
    let Finish { channels, scale, bias, luminance } = *finish;
    let level = |at: usize| samples.get(at).map_or(outside, |sample| sample.level());
    let mut position = line.start;
    // Loops over arrays instead of their `map`, which is not inlined here and takes most of the time.
    let mut next = || {
        let [left, top] = [position[0] >> 32, position[1] >> 32];
        // An `f32` holds 24 bits.
        let share = |position: i64| (position as u32 >> 8) as f32 * (1.0 / 16_777_216.0);
        let weights = [share(position[0]), share(position[1])];
        position = [position[0].wrapping_add(line.step[0]), position[1].wrapping_add(line.step[1])];
        let mut levels = [0.0; 3];
        if let Some(first) = grid.inside(left, top) {
            for (mixed, channel) in levels.iter_mut().zip(channels) {
                let at = first + channel;
                *mixed = blend(
                    [level(at), level(at + right), level(at + down), level(at + down + right)],
                    weights,
                );
            }
        } else {
            let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| grid.pixel(left + x, top + y));
            for (mixed, channel) in levels.iter_mut().zip(channels) {
                let corners = corners.map(|pixel| pixel.map_or(outside, |pixel| level(pixel + channel)));
                *mixed = blend(corners, weights);
            }
        }
        levels
    };
    let value = |levels: [f32; 3], c: usize| W::from_value(levels[c] * scale[c] + bias[c]);
    let Row { planes: [first, second, third], interleaved, channels: count } = row;
    if *count == 1 {
        for sample in first.iter_mut() {
            let [red, green, blue] = next();
            let level =
                if luminance { red * LUMINANCE[0] + green * LUMINANCE[1] + blue * LUMINANCE[2] } else { red };
            *sample = value([level; 3], 0);
        }
    } else if *interleaved {
        for pixel in first.as_chunks_mut::<3>().0 {
            let levels = next();
            *pixel = [value(levels, 0), value(levels, 1), value(levels, 2)];
        }
    } else {
        for ((x, y), z) in first.iter_mut().zip(second.iter_mut()).zip(third.iter_mut()) {
            let levels = next();
            (*x, *y, *z) = (value(levels, 0), value(levels, 1), value(levels, 2));
        }
    }
}
