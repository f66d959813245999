//! Corners of an image, which can be tracked.

use super::pyramid::Pyramid;

/// Side of the cells that have at most one corner, in pixels.
const CELL: usize = 16;
/// Pixels to each side of a corner in its window.
const REACH: usize = 3;
/// Distance of corners to the edge of the image, in pixels, as points closer to it leave soon.
const MARGIN: usize = 8;
/// Minimum of the smaller eigenvalue of the gradients' covariance, in squared levels per pixel.
const SHARPNESS: f32 = 20.0;

/// Corners of one frame, in pixels of the pyramid's largest level.
#[derive(Debug, Default)]
pub(super) struct Corners {
    points: Vec<[f32; 2]>,
    /// Products of gradients xx, xy, yy per pixel.
    products: Vec<[f32; 3]>,
}

impl Corners {
    pub fn points(&self) -> &[[f32; 2]] {
        &self.points
    }

    /// Selects the sharpest corner of every cell, of those for which `is_background` is true.
    pub fn pick(&mut self, pyramid: &Pyramid, is_background: impl Fn([f32; 2]) -> bool) {
        let [plane, ..] = &pyramid.planes;
        let [width, height] = plane.size;
        self.points.clear();
        if width < 2 * MARGIN + CELL || height < 2 * MARGIN + CELL {
            return;
        }
        self.products.clear();
        self.products.resize(width * height, [0.0; 3]);
        for y in 1..height - 1 {
            for x in 1..width - 1 {
                let at = y * width + x;
                let across = (plane.levels[at + 1] - plane.levels[at - 1]) * 0.5;
                let down = (plane.levels[at + width] - plane.levels[at - width]) * 0.5;
                self.products[at] = [across * across, across * down, down * down];
            }
        }
        for top in (MARGIN..height - MARGIN - CELL + 1).step_by(CELL) {
            for left in (MARGIN..width - MARGIN - CELL + 1).step_by(CELL) {
                let mut best = (SHARPNESS, None);
                for (y, x) in (top..top + CELL)
                    .step_by(2)
                    .flat_map(|y| (left..left + CELL).step_by(2).map(move |x| (y, x)))
                {
                    let sharpness = self.sharpness(width, x, y);
                    if sharpness > best.0 {
                        best = (sharpness, Some([x as f32, y as f32]));
                    }
                }
                self.points.extend(best.1.filter(|point| is_background(*point)));
            }
        }
    }

    /// Returns the smaller eigenvalue of the mean of the products around a pixel.
    fn sharpness(&self, width: usize, x: usize, y: usize) -> f32 {
        let mut sum = [0.0; 3];
        for row in y - REACH..=y + REACH {
            let begin = row * width + x - REACH;
            for product in &self.products[begin..=begin + 2 * REACH] {
                sum = [sum[0] + product[0], sum[1] + product[1], sum[2] + product[2]];
            }
        }
        let count = ((2 * REACH + 1) * (2 * REACH + 1)) as f32;
        let [xx, xy, yy] = sum.map(|sum| sum / count);
        (xx + yy) / 2.0 - ((xx - yy) / 2.0).hypot(xy)
    }
}
