//! Coverage of pixels by an area, and the painting of such an area.

use crate::draw::canvas::{Canvas, Corners};
use crate::draw::palette::Colour;

/// Coverage of each pixel of a rectangle of the image, 0 to 255.
#[derive(Debug)]
pub(super) struct Coverage {
    pub left: usize,
    pub top: usize,
    pub width: usize,
    /// `[height, width]`.
    pub values: Vec<u8>,
}

impl Coverage {
    /// Returns an empty coverage of the part of `corners` inside the image; `None` when that part is empty.
    pub(super) fn within(canvas: &Canvas<'_>, corners: Corners) -> Option<Self> {
        let [x0, y0, x1, y1] = canvas.clip_corners(corners)?;
        let (left, top) = (x0 as usize, y0 as usize);
        let (width, height) = (x1.ceil() as usize - left, y1.ceil() as usize - top);
        Some(Self { left, top, width, values: vec![0; width * height] })
    }

    /// Covers rows `from..to` of column `x` of the image, clipped to the rectangle.
    pub(super) fn fill_column(&mut self, x: usize, from: usize, to: usize) {
        let Some(x) = x.checked_sub(self.left).filter(|x| *x < self.width) else { return };
        let rows = from.saturating_sub(self.top)..to.saturating_sub(self.top);
        let column = self.values.iter_mut().skip(x).step_by(self.width.max(1));
        column.take(rows.end).skip(rows.start).for_each(|value| *value = 255);
    }

    /// Paints the area translucent, and its border opaque: `thickness` pixels wide (at least 1), inside the area.
    pub(super) fn paint(&self, canvas: &mut Canvas<'_>, colour: Colour, opacity: f32, thickness: f32) {
        let radius = (thickness.round() as isize).max(1);
        let slant = (radius * 181 + 128) >> 8;
        let (width, height) = (canvas.width(), canvas.height());
        let least_around = |x: usize, y: usize| {
            let circle = [[radius, 0], [0, radius], [slant, slant], [slant, -slant]];
            let values = circle.into_iter().flat_map(|[dx, dy]| [[dx, dy], [-dx, -dy]]).map(|[dx, dy]| {
                // At the border of the image the area counts as continued.
                let x = x.saturating_add_signed(dx).min(width - 1);
                let y = y.saturating_add_signed(dy).min(height - 1);
                self.at(x, y)
            });
            values.min().unwrap_or(0)
        };
        for (y, values) in (self.top..).zip(self.values.chunks_exact(self.width.max(1))) {
            for (x, &covered) in (self.left..).zip(values) {
                if covered > 0 {
                    let inner = least_around(x, y).min(covered);
                    let weight = (f32::from(covered - inner) + opacity * f32::from(inner)) / 255.0;
                    canvas.blend(x, y, colour, weight);
                }
            }
        }
    }

    /// Returns the coverage of a pixel of the image.
    fn at(&self, x: usize, y: usize) -> u8 {
        match (x.checked_sub(self.left), y.checked_sub(self.top)) {
            (Some(x), Some(y)) if x < self.width => self.values.get(y * self.width + x).copied().unwrap_or(0),
            _ => 0,
        }
    }
}
