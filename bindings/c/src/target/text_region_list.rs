//! Text in images.

use std::ffi::c_char;

use opendr::Result;
use opendr::target::{TextRegion, TextRegionList};

use crate::pointer::text;
use crate::status::{guard, guard_value, opendr_status};
use crate::target::check_finite;
use crate::target::list::{self, List};
use crate::texts::Texts;
use crate::value::opendr_text_region_list;

/// A line of text in an image.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_text_region {
    /// The text.
    pub text: *const c_char,
    /// Corners, pixels: x and y of each, clockwise from the top left one of the text.
    pub corners: [f32; 8],
    /// Score of the text, 0 to 1.
    pub confidence: f32,
}

/// Creates a list of items, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_text_region_list_create(
    items: *const opendr_text_region,
    count: usize,
    list: *mut *mut opendr_text_region_list,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::create::<TextRegionList, _>(items, count, list) })
}

/// Returns the number of regions; 0 if the handle is not such a list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_text_region_list_count(list: *const opendr_text_region_list) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || unsafe { list::count::<TextRegionList, _>(list) })
}

/// Writes an item of the list into item; its text is valid as long as the list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_text_region_list_get(
    list: *const opendr_text_region_list,
    index: usize,
    item: *mut opendr_text_region,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::get::<TextRegionList, _>(list, index, item) })
}

impl List for TextRegionList {
    type Item = TextRegion;
    type Plain = opendr_text_region;

    fn items(&self) -> &[TextRegion] {
        &self.regions
    }

    fn plain(&self, item: &TextRegion, texts: &Texts) -> opendr_text_region {
        let [[ax, ay], [bx, by], [cx, cy], [dx, dy]] = item.corners;
        opendr_text_region {
            text: texts.keep(&item.text),
            corners: [ax, ay, bx, by, cx, cy, dx, dy],
            confidence: item.confidence,
        }
    }

    unsafe fn item(plain: &opendr_text_region) -> Result<TextRegion> {
        // SAFETY: the caller's promise.
        let text = unsafe { text(plain.text, "the text of a region") }?;
        check_finite(&plain.corners, "the corners of a region")?;
        check_finite(&[plain.confidence], "the score of a region")?;
        let [ax, ay, bx, by, cx, cy, dx, dy] = plain.corners;
        Ok(TextRegion::new(text, [[ax, ay], [bx, by], [cx, cy], [dx, dy]], plain.confidence))
    }
}
