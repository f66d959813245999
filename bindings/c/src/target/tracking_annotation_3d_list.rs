//! Boxes in space with an identity: 3D tracking.

use opendr::Result;
use opendr::target::{TrackingAnnotation3D, TrackingAnnotation3DList};

use crate::status::{guard, guard_value, opendr_status};
use crate::target::list::{self, List};
use crate::target::{known, opendr_bounding_box_3d};
use crate::texts::Texts;
use crate::value::opendr_tracking_annotation_3d_list;

/// A box of one object that is followed through space.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_tracking_annotation_3d {
    /// Where it is.
    pub bounding_box_3d: opendr_bounding_box_3d,
    /// The object's number, the same at every time; -1 when it is not known.
    pub id: i64,
    /// Number of the cloud in its recording; -1 when it has none.
    pub frame: i64,
}

/// Makes a list of items, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tracking_annotation_3d_list_create(
    items: *const opendr_tracking_annotation_3d,
    count: usize,
    list: *mut *mut opendr_tracking_annotation_3d_list,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::create::<TrackingAnnotation3DList, _>(items, count, list) })
}

/// How many tracks there are; 0 for what is no such list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tracking_annotation_3d_list_count(
    list: *const opendr_tracking_annotation_3d_list,
) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || unsafe { list::count::<TrackingAnnotation3DList, _>(list) })
}

/// Shows an item of the list; what it points to lives as long as the list.
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
