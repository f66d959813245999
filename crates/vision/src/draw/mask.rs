//! Objects by their pixels: translucent, with an outline.

use opendr_engine::data::Image;
use opendr_engine::target::{Rle, Segmentation};

use crate::draw::canvas::Canvas;
use crate::draw::palette::Colour;
use crate::draw::style::Style;

/// Colours the pixels of an object, which are given in pixels of `image`; it becomes RGB `u8` where it is not.
pub fn draw_mask(image: &mut Image, mask: &Segmentation, colour: Colour, style: &Style) {
    let mut canvas = Canvas::over(image);
    let thickness = style.thickness(&canvas);
    cover(&mut canvas, mask, colour, style.opacity, thickness);
}

pub(super) fn cover(
    canvas: &mut Canvas<'_>,
    mask: &Segmentation,
    colour: Colour,
    opacity: f32,
    thickness: f32,
) {
    match mask {
        Segmentation::Rle(rle) => cover_runs(canvas, rle, colour, opacity),
        Segmentation::Polygons(polygons) => {
            let mut inside = Inside::new(canvas);
            polygons.iter().for_each(|polygon| inside.add(polygon));
            inside.cover(canvas, colour, opacity);
            for polygon in polygons {
                for [from, to] in edges(polygon) {
                    canvas.line(from, to, (thickness / 2.0).max(1.0), colour, 1.0);
                }
            }
        }
    }
}

/// Runs go down the columns: each is a stroke of one column's pixels.
fn cover_runs(canvas: &mut Canvas<'_>, rle: &Rle, colour: Colour, opacity: f32) {
    let rows = rle.size()[0] as usize;
    let mut at = 0usize;
    for (index, run) in rle.counts().iter().enumerate() {
        let end = at + *run as usize;
        while index % 2 == 1 && at < end && at / rows < canvas.width() {
            let column_end = (at / rows + 1) * rows;
            let x = (at / rows) as f32;
            let (first, last) = ((at % rows) as f32, (end.min(column_end) - at / rows * rows) as f32);
            canvas.fill([x, first, x + 1.0, last], colour, opacity);
            at = column_end;
        }
        at = end;
    }
}

/// The sides of an outline `[x0, y0, x1, y1, ...]`, the closing one included.
fn edges(polygon: &[f32]) -> impl Iterator<Item = [[f32; 2]; 2]> {
    let points = polygon.as_chunks::<2>().0;
    points.iter().zip(points.iter().cycle().skip(1)).map(|(from, to)| [*from, *to])
}

/// Which pixels lie inside outlines, by where each row enters and leaves them (even-odd rule).
struct Inside {
    width: usize,
    height: usize,
    /// Pixels of finished outlines.
    covered: Vec<bool>,
    /// Whether a pixel is the first one beyond a side.
    crossings: Vec<bool>,
}

impl Inside {
    fn new(canvas: &Canvas<'_>) -> Self {
        let (width, height) = (canvas.width(), canvas.height());
        let area = vec![false; width * height];
        Self { width, height, covered: area.clone(), crossings: area }
    }

    fn add(&mut self, polygon: &[f32]) {
        if polygon.len() < 6 || !polygon.iter().all(|part| part.is_finite()) {
            return;
        }
        self.crossings.fill(false);
        for [[x0, y0], [x1, y1]] in edges(polygon) {
            // Rows whose middle the side crosses.
            let row = |y: f32| (y - 0.5).ceil().clamp(0.0, self.height as f32) as usize;
            for y in row(y0.min(y1))..row(y0.max(y1)) {
                let part = (y as f32 + 0.5 - y0) / (y1 - y0);
                let x = (x0 + part * (x1 - x0) - 0.5).ceil().max(0.0) as usize;
                if x < self.width {
                    self.crossings[y * self.width + x] ^= true;
                }
            }
        }
        for (covered, crossings) in
            self.covered.chunks_exact_mut(self.width).zip(self.crossings.chunks_exact(self.width))
        {
            let mut inside = false;
            for (covered, crossing) in covered.iter_mut().zip(crossings) {
                inside ^= crossing;
                *covered |= inside;
            }
        }
    }

    fn cover(&self, canvas: &mut Canvas<'_>, colour: Colour, opacity: f32) {
        for (y, row) in self.covered.chunks_exact(self.width).enumerate() {
            for (x, _) in row.iter().enumerate().filter(|(_, covered)| **covered) {
                canvas.blend(x, y, colour, opacity);
            }
        }
    }
}
