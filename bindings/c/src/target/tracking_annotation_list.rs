//! Boxes with an identity: 2D tracking.

use opendr::Result;
use opendr::target::{TrackingAnnotation, TrackingAnnotationList};

use crate::status::{guard, guard_value, opendr_status};
use crate::target::list::{self, List};
use crate::target::{known, opendr_bounding_box};
use crate::texts::Texts;
use crate::value::opendr_tracking_annotation_list;

/// The box of a tracked object in one frame.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_tracking_annotation {
    /// The box.
    pub bounding_box: opendr_bounding_box,
    /// Identity of the object, the same in every frame; -1 when unknown.
    pub id: i64,
    /// Index of the frame in its video; -1 if it has none.
    pub frame: i64,
}

/// Creates a list of items, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tracking_annotation_list_create(
    items: *const opendr_tracking_annotation,
    count: usize,
    list: *mut *mut opendr_tracking_annotation_list,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::create::<TrackingAnnotationList, _>(items, count, list) })
}

/// Returns the number of tracks; 0 if the handle is not such a list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tracking_annotation_list_count(
    list: *const opendr_tracking_annotation_list,
) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || unsafe { list::count::<TrackingAnnotationList, _>(list) })
}

/// Writes an item of the list into item; its pointers are valid as long as the list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tracking_annotation_list_get(
    list: *const opendr_tracking_annotation_list,
    index: usize,
    item: *mut opendr_tracking_annotation,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::get::<TrackingAnnotationList, _>(list, index, item) })
}

impl List for TrackingAnnotationList {
    type Item = TrackingAnnotation;
    type Plain = opendr_tracking_annotation;

    fn items(&self) -> &[TrackingAnnotation] {
        &self.annotations
    }

    fn plain(&self, item: &TrackingAnnotation, texts: &Texts) -> opendr_tracking_annotation {
        let bounding_box = opendr_bounding_box::new(&item.bounding_box, &self.classes, texts);
        opendr_tracking_annotation { bounding_box, id: item.id, frame: item.frame.unwrap_or(-1) }
    }

    unsafe fn item(plain: &opendr_tracking_annotation) -> Result<TrackingAnnotation> {
        // SAFETY: the caller's promise.
        let bounding_box = unsafe { plain.bounding_box.to_bounding_box() }?;
        Ok(TrackingAnnotation { bounding_box, id: plain.id, frame: known(plain.frame) })
    }
}
