//! Labels: text on a background of its class's colour, placed to hide little.

use opendr_engine::data::Image;

use crate::draw::canvas::{Canvas, Corners, Point};
use crate::draw::palette::{Colour, colour_of_index, ink_on};
use crate::draw::style::Style;
use crate::draw::text::Text;

/// Maximum number of labels that a new label avoids; older ones are ignored.
const MAX_AVOIDED: usize = 128;

/// Space between the text and the edge of its background, in grid units of the font.
const PADDING: f32 = 2.0;

/// Draws `text` on a background of `colour` with its left-top corner at `corner`; returns `[width, height]`.
pub(super) fn draw_chip(
    canvas: &mut Canvas<'_>,
    text: &Text,
    [left, top]: Point,
    colour: Colour,
) -> [f32; 2] {
    let [width, height] = chip_size(text);
    let padding = PADDING * text.unit();
    canvas.fill_rounded([left, top, left + width, top + height], text.unit(), colour, 0.9);
    text.draw(canvas, [left + padding, top + padding], ink_on(colour));
    [width, height]
}

/// Writes `text` into the left-top corner of `image`, in the colour of the style or of `index`. The image is converted to RGB `u8`
/// where needed.
pub(super) fn draw_in_corner(image: &mut Image, text: &str, index: i64, style: &Style) {
    let mut canvas = Canvas::over(image);
    let unit = style.letter_unit(&canvas);
    let colour = style.colour.unwrap_or_else(|| colour_of_index(index));
    draw_chip(&mut canvas, &Text::new(text, unit), [unit; 2], colour);
}

/// Returns the size of the background, with space for descenders.
fn chip_size(text: &Text) -> [f32; 2] {
    let padding = PADDING * text.unit();
    [text.width() + 2.0 * padding, text.height() + 2.5 * padding].map(f32::ceil)
}

/// The labels of one image, which avoid each other where they can.
#[derive(Debug, Default)]
pub(super) struct Labels {
    placed: Vec<Corners>,
}

impl Labels {
    /// Draws `text` (`short` where the image is too narrow for it) at a box with `corners` and lines of `thickness`.
    pub(super) fn draw(
        &mut self,
        canvas: &mut Canvas<'_>,
        [text, short]: [&str; 2],
        corners: Corners,
        [unit, thickness]: [f32; 2],
        colour: Colour,
    ) {
        let mut text = Text::new(text, unit);
        if chip_size(&text)[0] > canvas.width() as f32 {
            text = Text::new(short, unit);
        }
        let Some(chip) = self.place(canvas, corners, chip_size(&text), thickness) else { return };
        draw_chip(canvas, &text, [chip[0], chip[1]], colour);
        self.placed.push(chip);
    }

    /// Returns the first free position inside the image: above the box, inside its upper edge, or below it.
    fn place(
        &self,
        canvas: &Canvas<'_>,
        [x0, y0, x1, y1]: Corners,
        [width, height]: [f32; 2],
        thickness: f32,
    ) -> Option<Corners> {
        let (right, bottom) = (canvas.width() as f32, canvas.height() as f32);
        if !(x0 < right && y0 < bottom && x1 > 0.0 && y1 > 0.0) {
            return None;
        }
        let left = (x0 - thickness / 2.0).round().min(right - width).max(0.0);
        let half = thickness / 2.0;
        let tops = [y0 + half - height, (y0 - half).max(0.0), y1 - half, y1 + half - height];
        let chips = tops.map(|top| [left, top.round(), left + width, top.round() + height]);
        let fits = |chip: &&Corners| chip[1] >= 0.0 && chip[3] <= bottom;
        let free = |chip: &&Corners| {
            let recent = self.placed.iter().rev().take(MAX_AVOIDED);
            !recent.clone().any(|other| {
                chip[0] < other[2] && other[0] < chip[2] && chip[1] < other[3] && other[1] < chip[3]
            })
        };
        let chosen = chips.iter().filter(fits).find(free).or_else(|| chips.iter().find(fits)).copied();
        Some(chosen.unwrap_or_else(|| {
            let top = y0.round().clamp(0.0, (bottom - height).max(0.0));
            [left, top, left + width, top + height]
        }))
    }
}
