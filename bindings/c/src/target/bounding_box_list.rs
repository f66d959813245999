//! Boxes in an image: 2D detection.

use std::ffi::c_char;

use opendr::Result;
use opendr::target::{BoundingBox, BoundingBoxList, Classes};

use crate::pointer::slice;
use crate::status::{guard, guard_value, opendr_status};
use crate::target::list::{self, List};
use crate::target::{check_finite, class_of_name, name_of_class};
use crate::texts::Texts;
use crate::value::opendr_bounding_box_list;

/// A point in an image, pixels.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_point {
    /// Pixels from the left edge.
    pub x: f32,
    /// Pixels from the upper edge.
    pub y: f32,
}

/// A box in an image. Masks (segments) are in the JSON of the list.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_bounding_box {
    /// Class index; -1 when there is only a label.
    pub class_index: i64,
    /// Name of the class; NULL when unknown. In an item given to a list, it is used when class_index is -1.
    pub label: *const c_char,
    /// Left edge, pixels.
    pub left: f32,
    /// Upper edge, pixels.
    pub top: f32,
    /// Pixels to the right edge.
    pub width: f32,
    /// Pixels to the lower edge.
    pub height: f32,
    /// Score, 0 to 1.
    pub confidence: f32,
    /// Points of the object (eyes, nose, corners of the mouth of a face).
    pub landmarks: *const opendr_point,
    /// Number of landmarks.
    pub landmark_count: usize,
}

/// Creates a list of items, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_bounding_box_list_create(
    items: *const opendr_bounding_box,
    count: usize,
    list: *mut *mut opendr_bounding_box_list,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::create::<BoundingBoxList, _>(items, count, list) })
}

/// Returns the number of boxes; 0 if the handle is not such a list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_bounding_box_list_count(list: *const opendr_bounding_box_list) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || unsafe { list::count::<BoundingBoxList, _>(list) })
}

/// Writes an item of the list into item; its pointers are valid as long as the list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_bounding_box_list_get(
    list: *const opendr_bounding_box_list,
    index: usize,
    item: *mut opendr_bounding_box,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::get::<BoundingBoxList, _>(list, index, item) })
}

impl List for BoundingBoxList {
    type Item = BoundingBox;
    type Plain = opendr_bounding_box;

    fn items(&self) -> &[BoundingBox] {
        &self.boxes
    }

    fn plain(&self, item: &BoundingBox, texts: &Texts) -> opendr_bounding_box {
        opendr_bounding_box::new(item, &self.classes, texts)
    }

    unsafe fn item(plain: &opendr_bounding_box) -> Result<BoundingBox> {
        // SAFETY: the caller's promise.
        unsafe { plain.to_bounding_box() }
    }
}

impl opendr_bounding_box {
    pub(super) fn new(found: &BoundingBox, classes: &Classes, texts: &Texts) -> Self {
        let (class_index, label) = class_of_name(&found.name, classes, texts);
        let BoundingBox { left, top, width, height, confidence, .. } = *found;
        // Points have the same memory layout as pairs.
        let (landmarks, landmark_count) = (found.landmarks.as_ptr().cast(), found.landmarks.len());
        Self { class_index, label, left, top, width, height, confidence, landmarks, landmark_count }
    }

    /// # Safety
    /// Its pointers are valid.
    pub(super) unsafe fn to_bounding_box(self) -> Result<BoundingBox> {
        let Self { left, top, width, height, confidence, .. } = self;
        check_finite(&[left, top, width, height, confidence], "a box")?;
        // SAFETY: the caller's promise.
        let (name, landmarks) = unsafe {
            (
                name_of_class(self.class_index, self.label)?,
                slice(self.landmarks, self.landmark_count, "the landmarks of a box")?,
            )
        };
        landmarks.iter().try_for_each(|point| check_finite(&[point.x, point.y], "a landmark"))?;
        let landmarks = landmarks.iter().map(|point| [point.x, point.y]).collect();
        Ok(BoundingBox { landmarks, ..BoundingBox::new(name, left, top, width, height, confidence) })
    }
}
