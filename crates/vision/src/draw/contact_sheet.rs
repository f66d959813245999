//! Contact sheets: many images in one, each with a line of text.

use opendr_engine::Result;
use opendr_engine::data::{Image, PixelFormat};

use crate::draw::canvas::Canvas;
use crate::draw::palette::Colour;
use crate::draw::text::Text;
use crate::resize;

/// Gap between images, in pixels.
const GAP: usize = 8;
/// Side of the font's grid unit, in pixels.
const LETTER_UNIT: f32 = 1.0;
/// Height of the caption under an image, in pixels.
const CAPTION: usize = 16;
const GROUND: u8 = 250;
const INK: Colour = [40, 40, 40];

/// Arranges images in rows of `columns`, each scaled to fit a square of `side` pixels, with its caption below.
/// Captions that are too wide lose their beginning.
///
/// # Errors
/// `InvalidInput` for an empty image, or when there are no images.
pub fn contact_sheet(pictures: &[(Image, String)], columns: usize, side: usize) -> Result<Image> {
    let columns = columns.clamp(1, pictures.len().max(1));
    let rows = pictures.len().div_ceil(columns);
    let (across, down) = (side + GAP, side + CAPTION + GAP);
    let (width, height) = (GAP + columns * across, GAP + rows * down);
    let mut ground = vec![GROUND; width * height * 3];
    for (at, (picture, _)) in pictures.iter().enumerate() {
        let (left, top) = (GAP + at % columns * across, GAP + at / columns * down);
        let scale = side as f32 / picture.width().max(picture.height()).max(1) as f32;
        let fit = |length: usize| ((length as f32 * scale).round() as usize).clamp(1, side);
        let small = resize(picture, fit(picture.width()), fit(picture.height()))?;
        let (left, top) = (left + (side - small.width()) / 2, top + (side - small.height()) / 2);
        let rgb = small.hwc_u8(PixelFormat::Rgb);
        for (row, line) in rgb.chunks_exact(small.width() * 3).enumerate() {
            let start = ((top + row) * width + left) * 3;
            if let Some(place) = ground.get_mut(start..start + line.len()) {
                place.copy_from_slice(line);
            }
        }
    }
    let mut sheet = Image::from_rgb8(ground, width, height)?;
    let mut canvas = Canvas::over(&mut sheet);
    for (at, (_, caption)) in pictures.iter().enumerate() {
        let (left, top) = (GAP + at % columns * across, GAP + at / columns * down + side + 4);
        let text = fitting(caption, side as f32);
        text.draw(&mut canvas, [left as f32, top as f32], INK);
    }
    Ok(sheet)
}

/// Lays out the text and drops its beginning where it is too wide: the end of a path is more specific.
fn fitting(caption: &str, width: f32) -> Text {
    let whole = Text::new(caption, LETTER_UNIT);
    if whole.width() <= width {
        return whole;
    }
    let letters: Vec<char> = caption.chars().collect();
    let cut = (1..=letters.len()).map(|from| {
        let rest: String = letters[from..].iter().collect();
        Text::new(&format!("..{rest}"), LETTER_UNIT)
    });
    cut.into_iter().find(|text| text.width() <= width).unwrap_or_else(|| Text::new("", LETTER_UNIT))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_of_any_shape_are_arranged() {
        let picture = |width: usize, height: usize, grey: u8| {
            Image::from_rgb8(vec![grey; width * height * 3], width, height).unwrap()
        };
        let long = "a/very/long/path/that/does/not/fit/under/the/picture.jpg".to_owned();
        let pictures = [
            (picture(200, 10, 0), long),
            (picture(1, 300, 0), String::new()),
            (picture(64, 64, 0), "c".into()),
        ];
        let sheet = contact_sheet(&pictures, 2, 64).unwrap();
        assert_eq!([sheet.width(), sheet.height()], [8 + 2 * 72, 8 + 2 * 88]);
        let rgb = sheet.hwc_u8(PixelFormat::Rgb);
        let grey = |x: usize, y: usize| rgb[(y * sheet.width() + x) * 3];
        // Centres of the first row, and of the first image of the second.
        assert_eq!([grey(40, 40), grey(111, 40), grey(40, 128)], [0, 0, 0]);
        assert_eq!([grey(40, 10), grey(112, 128)], [GROUND, GROUND]);
    }
}
