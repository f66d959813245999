//! 3D boxes with an identity: 3D tracking.

use opendr::Result;
use opendr::target::{TrackingAnnotation3D, TrackingAnnotation3DList};

use crate::status::{guard, guard_value, opendr_status};
use crate::target::list::{self, List};
use crate::target::{known, opendr_bounding_box_3d};
use crate::texts::Texts;
use crate::value::opendr_tracking_annotation_3d_list;

/// The 3D box of a tracked object at one time.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_tracking_annotation_3d {
    /// The box.
    pub bounding_box_3d: opendr_bounding_box_3d,
    /// Identity of the object, the same at every time; -1 when unknown.
    pub id: i64,
    /// Index of the cloud in its recording; -1 if it has none.
    pub frame: i64,
}

/// Creates a list of items, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tracking_annotation_3d_list_create(
    items: *const opendr_tracking_annotation_3d,
    count: usize,
    list: *mut *mut opendr_tracking_annotation_3d_list,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::create::<TrackingAnnotation3DList, _>(items, count, list) })
}

/// Returns the number of tracks; 0 if the handle is not such a list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tracking_annotation_3d_list_count(
    list: *const opendr_tracking_annotation_3d_list,
) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || unsafe { list::count::<TrackingAnnotation3DList, _>(list) })
}

/// Writes an item of the list into item; its pointers are valid as long as the list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tracking_annotation_3d_list_get(
    list: *const opendr_tracking_annotation_3d_list,
    index: usize,
    item: *mut opendr_tracking_annotation_3d,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::get::<TrackingAnnotation3DList, _>(list, index, item) })
}

impl List for TrackingAnnotation3DList {
    type Item = TrackingAnnotation3D;
    type Plain = opendr_tracking_annotation_3d;

    fn items(&self) -> &[TrackingAnnotation3D] {
        &self.annotations
    }

    fn plain(&self, item: &TrackingAnnotation3D, texts: &Texts) -> opendr_tracking_annotation_3d {
        let bounding_box_3d = opendr_bounding_box_3d::new(&item.bounding_box_3d, &self.classes, texts);
        opendr_tracking_annotation_3d { bounding_box_3d, id: item.id, frame: item.frame.unwrap_or(-1) }
    }

    unsafe fn item(plain: &opendr_tracking_annotation_3d) -> Result<TrackingAnnotation3D> {
        // SAFETY: the caller's promise.
        let bounding_box_3d = unsafe { plain.bounding_box_3d.to_bounding_box_3d() }?;
        Ok(TrackingAnnotation3D { bounding_box_3d, id: plain.id, frame: known(plain.frame) })
    }
}
