//! Labels: text on a ground of its class's colour, placed where it hides least.

use crate::draw::canvas::{Canvas, Corners};
use crate::draw::palette::{Colour, ink_on};
use crate::draw::text::Text;

/// Above which number of labels the older ones are no longer kept clear of.
const REMEMBERED: usize = 128;

/// The labels of one picture; they keep off each other where they can.
#[derive(Debug, Default)]
pub(super) struct Labels {
    placed: Vec<Corners>,
}

impl Labels {
    /// Draws `text` (`short` where the picture is too narrow for it) at a box that has `corners` and lines of
    /// `thickness`.
    pub(super) fn draw(
        &mut self,
        canvas: &mut Canvas<'_>,
        [text, short]: [&str; 2],
        corners: Corners,
        [unit, thickness]: [f32; 2],
        colour: Colour,
    ) {
        let padding = 2.0 * unit;
        let mut laid_out = Text::new(text, unit);
        if laid_out.width() + 2.0 * padding > canvas.width() as f32 {
            laid_out = Text::new(short, unit);
        }
        let size = [laid_out.width() + 2.0 * padding, laid_out.height() + 2.5 * padding].map(f32::ceil);
        let Some(chip) = self.place(canvas, corners, size, thickness) else { return };
        canvas.fill_rounded(chip, unit, colour, 0.9);
        laid_out.draw(canvas, [chip[0] + padding, chip[1] + padding], ink_on(colour));
        self.placed.push(chip);
    }

    /// Above the box, inside its upper edge, or below it: the first place that is in the picture and free.
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
            let recent = self.placed.iter().rev().take(REMEMBERED);
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
