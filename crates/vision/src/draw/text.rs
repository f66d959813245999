//! Text in the built-in font.

use crate::draw::canvas::{Canvas, Point};
use crate::draw::glyphs::{CAP_HEIGHT, DESCENT, glyph};
use crate::draw::palette::Colour;

/// Maximum length of a text; longer ones are cut, because labels come from model files.
const MAX_LETTERS: usize = 80;

/// Gap between two letters, in grid units.
const GAP: f32 = 1.1;

/// Width of the pen, in grid units.
const PEN: f32 = 1.05;

/// A line of text with its layout.
#[derive(Debug)]
pub(super) struct Text {
    /// Polylines in grid units; `y` 0 is the upper end of capitals.
    strokes: Vec<Vec<Point>>,
    /// Width in grid units, pen included.
    columns: f32,
    unit: f32,
}

impl Text {
    /// Lays out `text`; `unit` is the side of a grid unit in pixels: capitals are 8 units high, pen included.
    pub(super) fn new(text: &str, unit: f32) -> Self {
        let mut strokes = Vec::new();
        let mut columns = 0.0;
        for letter in text.chars().take(MAX_LETTERS) {
            let (glyph, width) = glyph(letter);
            strokes.extend(glyph.into_iter().map(|mut stroke| {
                stroke.iter_mut().for_each(|point| point[0] += columns);
                stroke
            }));
            columns += width + 1.0 + GAP;
        }
        Self { strokes, columns: (columns - GAP).max(0.0), unit }
    }

    /// Returns the side of a grid unit, in pixels.
    pub(super) fn unit(&self) -> f32 {
        self.unit
    }

    /// Returns the pixels from the first letter's left to the last one's right edge.
    pub(super) fn width(&self) -> f32 {
        self.columns * self.unit
    }

    /// Returns the pixels from the upper edge of capitals to the base line's lower edge.
    pub(super) fn height(&self) -> f32 {
        (CAP_HEIGHT + 1.0) * self.unit
    }

    /// Draws the text with its left-top corner at `corner`.
    pub(super) fn draw(&self, canvas: &mut Canvas<'_>, corner: Point, colour: Colour) {
        let (left, top) = (corner[0].round(), corner[1].round());
        let (width, height) =
            (self.width().ceil() as usize + 1, (self.height() + DESCENT * self.unit) as usize + 2);
        let mask = self.mask(width, height);
        for (row, cover) in mask.chunks_exact(width).enumerate() {
            for (column, cover) in cover.iter().enumerate() {
                let (x, y) = (left + column as f32, top + row as f32);
                if *cover > 0.0 && x >= 0.0 && y >= 0.0 {
                    canvas.blend(x as usize, y as usize, colour, *cover);
                }
            }
        }
    }

    /// Returns the coverage of each pixel by the pen, 0..=1. Strokes that cross do not add up.
    fn mask(&self, width: usize, height: usize) -> Vec<f32> {
        let radius = (self.unit * PEN).max(1.0) / 2.0;
        let mut mask = vec![0.0_f32; width * height];
        let in_pixels = |point: &Point| point.map(|part| (part + 0.5) * self.unit);
        for stroke in &self.strokes {
            let dot = [stroke[0], stroke[0]];
            let lines = if stroke.len() == 1 { &dot[..] } else { stroke };
            for line in lines.windows(2) {
                cover(&mut mask, width, in_pixels(&line[0]), in_pixels(&line[1]), radius);
            }
        }
        mask
    }
}

fn cover(mask: &mut [f32], width: usize, from: Point, to: Point, radius: f32) {
    let reach = radius + 0.5;
    let span = |axis: usize, end: usize| {
        let (a, b) = (from[axis].min(to[axis]) - reach, from[axis].max(to[axis]) + reach);
        (a.max(0.0) as usize).min(end)..(b.ceil().max(0.0) as usize).min(end)
    };
    let along = [to[0] - from[0], to[1] - from[1]];
    let length_squared = (along[0] * along[0] + along[1] * along[1]).max(f32::MIN_POSITIVE);
    for y in span(1, mask.len() / width) {
        for x in span(0, width) {
            let away = [x as f32 + 0.5 - from[0], y as f32 + 0.5 - from[1]];
            let part = ((away[0] * along[0] + away[1] * along[1]) / length_squared).clamp(0.0, 1.0);
            let distance = (away[0] - part * along[0]).hypot(away[1] - part * along[1]);
            let covered = &mut mask[y * width + x];
            *covered = covered.max((radius + 0.5 - distance).clamp(0.0, 1.0));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_capitals_lie_on_pixels() {
        let text = Text::new("I", 1.0);
        assert_eq!((text.width(), text.height()), (3.0, 8.0));
        let mask = text.mask(4, 10);
        assert!(mask[..3].iter().all(|covered| *covered > 0.95), "{mask:?}");
        assert!((1..7).all(|row| mask[row * 4] < 0.05 && mask[row * 4 + 1] > 0.95), "{mask:?}");
    }

    #[test]
    fn long_and_empty_texts_are_bounded() {
        assert!(Text::new(&"W".repeat(1_000_000), 2.0).width() < 1500.0);
        assert_eq!(Text::new("", 2.0).width(), 0.0);
    }
}
