//! 3D boxes: 3D detection.

use std::ffi::c_char;

use opendr::Result;
use opendr::target::{BoundingBox3D, BoundingBox3DList, Classes};

use crate::status::{guard, guard_value, opendr_status};
use crate::target::list::{self, List};
use crate::target::{check_finite, class_of_name, name_of_class};
use crate::texts::Texts;
use crate::value::opendr_bounding_box_3d_list;

/// A 3D box in the camera frame of KITTI: x right, y down, z forward.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_bounding_box_3d {
    /// Class index; -1 when there is only a label.
    pub class_index: i64,
    /// Name of the class; NULL when unknown. In an item given to a list, it is used when class_index is -1.
    pub label: *const c_char,
    /// Fraction of the object outside the image, 0 to 1; -1 when unknown.
    pub truncated: f32,
    /// 0 visible, 1 partly occluded, 2 largely occluded, 3 or -1 unknown.
    pub occluded: i32,
    /// Observation angle of the object, radians.
    pub alpha: f32,
    /// The object in the image, corners x0, y0, x1, y1, pixels.
    pub bbox2d: [f32; 4],
    /// Length, height and width, metres.
    pub dimensions: [f32; 3],
    /// x, y, z of the centre of the bottom face, metres.
    pub location: [f32; 3],
    /// Rotation about the vertical axis, radians; 0 faces along x.
    pub rotation_y: f32,
    /// Score.
    pub confidence: f32,
}

/// Creates a list of items, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_bounding_box_3d_list_create(
    items: *const opendr_bounding_box_3d,
    count: usize,
    list: *mut *mut opendr_bounding_box_3d_list,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::create::<BoundingBox3DList, _>(items, count, list) })
}

/// Returns the number of boxes; 0 if the handle is not such a list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_bounding_box_3d_list_count(
    list: *const opendr_bounding_box_3d_list,
) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || unsafe { list::count::<BoundingBox3DList, _>(list) })
}

/// Writes an item of the list into item; its pointers are valid as long as the list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_bounding_box_3d_list_get(
    list: *const opendr_bounding_box_3d_list,
    index: usize,
    item: *mut opendr_bounding_box_3d,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::get::<BoundingBox3DList, _>(list, index, item) })
}

impl List for BoundingBox3DList {
    type Item = BoundingBox3D;
    type Plain = opendr_bounding_box_3d;

    fn items(&self) -> &[BoundingBox3D] {
        &self.boxes
    }

    fn plain(&self, item: &BoundingBox3D, texts: &Texts) -> opendr_bounding_box_3d {
        opendr_bounding_box_3d::new(item, &self.classes, texts)
    }

    unsafe fn item(plain: &opendr_bounding_box_3d) -> Result<BoundingBox3D> {
        // SAFETY: the caller's promise.
        unsafe { plain.to_bounding_box_3d() }
    }
}

impl opendr_bounding_box_3d {
    pub(super) fn new(found: &BoundingBox3D, classes: &Classes, texts: &Texts) -> Self {
        let (class_index, label) = class_of_name(&found.name, classes, texts);
        let BoundingBox3D {
            truncated,
            occluded,
            alpha,
            bbox2d,
            dimensions,
            location,
            rotation_y,
            confidence,
            ..
        } = *found;
        Self {
            class_index,
            label,
            truncated,
            occluded,
            alpha,
            bbox2d,
            dimensions,
            location,
            rotation_y,
            confidence,
        }
    }

    /// # Safety
    /// Its pointers are valid.
    pub(super) unsafe fn to_bounding_box_3d(self) -> Result<BoundingBox3D> {
        let Self { truncated, occluded, alpha, bbox2d, dimensions, location, rotation_y, confidence, .. } =
            self;
        check_finite(&[truncated, alpha, rotation_y, confidence], "a box")?;
        check_finite(&bbox2d, "the corners of a box")?;
        check_finite(&dimensions, "the size of a box")?;
        check_finite(&location, "the location of a box")?;
        // SAFETY: the caller's promise.
        let name = unsafe { name_of_class(self.class_index, self.label) }?;
        Ok(BoundingBox3D {
            name,
            truncated,
            occluded,
            alpha,
            bbox2d,
            dimensions,
            location,
            rotation_y,
            confidence,
        })
    }
}
