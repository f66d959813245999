//! Drawing of object masks: translucent, with an opaque border.

use opendr_engine::data::Image;
use opendr_engine::target::{Rle, Segmentation};

use crate::draw::canvas::Canvas;
use crate::draw::coverage::Coverage;
use crate::draw::palette::Colour;
use crate::draw::polygons::coverage_of_polygons;
use crate::draw::style::Style;

/// Draws the mask of an object, given in pixels of `image`, which is converted to RGB `u8` where needed.
///
/// The union of several polygons is drawn. A polygon that crosses itself is filled by the even-odd rule.
pub fn draw_mask(image: &mut Image, mask: &Segmentation, colour: Colour, style: &Style) {
    let mut canvas = Canvas::over(image);
    let thickness = style.thickness(&canvas);
    cover(&mut canvas, mask, style.colour.unwrap_or(colour), style.opacity, thickness);
}

pub(super) fn cover(
    canvas: &mut Canvas<'_>,
    mask: &Segmentation,
    colour: Colour,
    opacity: f32,
    thickness: f32,
) {
    let coverage = match mask {
        Segmentation::Polygons(polygons) => coverage_of_polygons(canvas, polygons),
        Segmentation::Rle(rle) => coverage_of_runs(canvas, rle),
    };
    if let Some(coverage) = coverage {
        coverage.paint(canvas, colour, opacity, thickness / 2.0);
    }
}

/// Returns the coverage of a run-length encoding, whose runs go down the columns.
fn coverage_of_runs(canvas: &Canvas<'_>, rle: &Rle) -> Option<Coverage> {
    let rows = rle.size()[0] as usize;
    let corners = strokes(rle).fold([usize::MAX, usize::MAX, 0, 0], |[x0, y0, x1, y1], stroke| {
        let Stroke { columns: [first, last], rows: [top, bottom] } = stroke;
        let [top, bottom] = if first == last { [top, bottom] } else { [0, rows] };
        [x0.min(first), y0.min(top), x1.max(last + 1), y1.max(bottom)]
    });
    let mut coverage = Coverage::within(canvas, corners.map(|edge| edge as f32))?;
    for Stroke { columns: [first, last], rows: [top, bottom] } in strokes(rle) {
        for x in first.max(coverage.left)..(last + 1).min(coverage.left + coverage.width) {
            let from = if x == first { top } else { 0 };
            let to = if x == last { bottom } else { rows };
            coverage.fill_column(x, from, to);
        }
    }
    Some(coverage)
}

/// A run of an object's pixels: from the first row in the first column to before the second row in the last column.
struct Stroke {
    columns: [usize; 2],
    rows: [usize; 2],
}

fn strokes(rle: &Rle) -> impl Iterator<Item = Stroke> {
    let rows = (rle.size()[0] as usize).max(1);
    let ends = rle.counts().iter().scan(0usize, |end, run| {
        *end += *run as usize;
        Some((*end - *run as usize, *end))
    });
    ends.skip(1).step_by(2).filter(|(start, end)| start < end).map(move |(start, end)| Stroke {
        columns: [start / rows, (end - 1) / rows],
        rows: [start % rows, (end - 1) % rows + 1],
    })
}
