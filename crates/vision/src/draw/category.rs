//! Drawing of the class of an image.

use opendr_engine::data::Image;
use opendr_engine::target::Category;

use crate::draw::canvas::Canvas;
use crate::draw::label::draw_chip;
use crate::draw::palette::colour_of_index;
use crate::draw::style::Style;
use crate::draw::text::Text;

/// Writes class and score into the left-top corner of `image`, which is converted to RGB `u8` where needed.
pub fn draw_category(image: &mut Image, category: &Category, style: &Style) {
    let mut canvas = Canvas::over(image);
    let unit = style.letter_unit(&canvas);
    let mut text = match &category.description {
        Some(description) => description.to_string(),
        None => format!("class {}", category.class),
    };
    if let Some(confidence) = category.confidence.filter(|_| style.show_confidences) {
        text += &format!(" {confidence:.2}");
    }
    let colour = style.colour.unwrap_or_else(|| colour_of_index(category.class));
    draw_chip(&mut canvas, &Text::new(&text, unit), [unit; 2], colour);
}
