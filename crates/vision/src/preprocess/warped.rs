//! The kernel of turned crops: any sample type, any strides.

use opendr_engine::data::ImageView;

use crate::preprocess::Border;
use crate::preprocess::band::Row;
use crate::preprocess::sample::Written;
use crate::preprocess::strided::{Finish, LUMINANCE, Level};

/// Positions of a row's pixels in the picture, in pixels times 2^32 from the centre of the picture's first pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) start: [i64; 2],
    pub(super) step: [i64; 2],
}

/// The four samples around a position and their weights.
struct Quad {
    /// Offsets of the left-top, right-top, left-bottom and right-bottom pixel; `None` outside of the picture.
    pixels: [Option<usize>; 4],
    /// Weight of the right and of the bottom ones.
    weights: [f32; 2],
}

/// Pixel strides and sizes of the picture.
struct Grid {
    size: [i64; 2],
    strides: [usize; 2],
    repeat: bool,
}

impl Grid {
    fn quad(&self, [x, y]: [i64; 2]) -> Quad {
        let (left, top) = (x >> 32, y >> 32);
        // 24 bits are what a float holds.
        let weights = [x, y].map(|position| (position as u32 >> 8) as f32 * (1.0 / 16_777_216.0));
        let offset = |x: i64, y: i64| y as usize * self.strides[0] + x as usize * self.strides[1];
        let inside = |at: i64, axis: usize| at >= 0 && at < self.size[axis];
        if left >= 0 && top >= 0 && left + 1 < self.size[0] && top + 1 < self.size[1] {
            let first = offset(left, top);
            let [down, right] = self.strides;
            return Quad {
                pixels: [first, first + right, first + down, first + down + right].map(Some),
                weights,
            };
        }
        let pixels = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[right, down]| {
            let (x, y) = (left + right, top + down);
            if self.repeat {
                return Some(offset(x.clamp(0, self.size[0] - 1), y.clamp(0, self.size[1] - 1)));
            }
            (inside(x, 0) && inside(y, 1)).then(|| offset(x, y))
        });
        Quad { pixels, weights }
    }
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
    let (repeat, outside) = match border {
        Border::Level(level) => (false, level),
        Border::Repeat => (true, 0.0),
    };
    let grid = Grid { size: [view.width() as i64, view.height() as i64], strides: [down, right], repeat };
    let Finish { channels, scale, bias, luminance } = *finish;
    let levels = |quad: &Quad| {
        let mix = |from: f32, to: f32, weight: f32| from + (to - from) * weight;
        channels.map(|channel| {
            let [a, b, c, d] = quad.pixels.map(|pixel| match pixel {
                Some(pixel) => samples.get(pixel + channel).map_or(outside, |sample| sample.level()),
                None => outside,
            });
            mix(mix(a, b, quad.weights[0]), mix(c, d, quad.weights[0]), quad.weights[1])
        })
    };
    let mut position = line.start;
    let mut next = || {
        let quad = grid.quad(position);
        position = [position[0].wrapping_add(line.step[0]), position[1].wrapping_add(line.step[1])];
        levels(&quad)
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
            *pixel = std::array::from_fn(|c| value(levels, c));
        }
    } else {
        for ((x, y), z) in first.iter_mut().zip(second.iter_mut()).zip(third.iter_mut()) {
            let levels = next();
            (*x, *y, *z) = (value(levels, 0), value(levels, 1), value(levels, 2));
        }
    }
}
