//! Drawing of targets.

use opendr::vision::draw::{Style, draw};
use opendr::{Error, Result, Value};

use crate::handle;
use crate::status::{guard, opendr_status};
use crate::value::{AnyValue, opendr_image, opendr_value};

/// Draws a target on an image; types that cannot be drawn leave it unchanged. Copies of the image are not changed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_draw(
    target: *const opendr_value,
    image: *mut opendr_image,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { draw_value(target, image) })
}

/// # Safety
/// Both are null or point to handles that are not used elsewhere meanwhile.
unsafe fn draw_value(target: *const opendr_value, image: *mut opendr_image) -> Result<()> {
    if target.cast::<opendr_image>() == image && !image.is_null() {
        return Err(Error::invalid_input("an image cannot be drawn on itself; give a target"));
    }
    // SAFETY: the caller's promise.
    let (target, image) =
        unsafe { (AnyValue::of(target, "target")?, handle::held_mut::<AnyValue, _>(image, "image")?) };
    match &mut image.value {
        Value::Image(image) => {
            draw(image, &target.value, &Style::default());
            Ok(())
        }
        other => {
            let given = other.as_value_ref().value_type().name();
            Err(Error::invalid_input(format!("image takes an Image, not a {given}; give one")))
        }
    }
}
