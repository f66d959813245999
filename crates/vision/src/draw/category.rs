//! Drawing of the class of an image.

use opendr_engine::data::Image;
use opendr_engine::target::Category;

use crate::draw::label::draw_in_corner;
use crate::draw::style::Style;

/// Writes class and score into the left-top corner of `image`, which is converted to RGB `u8` where needed.
pub fn draw_category(image: &mut Image, category: &Category, style: &Style) {
    let mut text = match &category.description {
        Some(description) => description.to_string(),
        None => format!("class {}", category.class),
    };
    if let Some(confidence) = category.confidence.filter(|_| style.show_confidences) {
        text += &format!(" {confidence:.2}");
    }
    draw_in_corner(image, &text, category.class, style);
}
