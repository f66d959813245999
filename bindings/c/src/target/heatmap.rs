//! Maps of class indices or scores.

use std::ptr;

use opendr::target::{Heatmap, HeatmapValues};
use opendr::{Error, Result};

use crate::handle::Out;
use crate::pointer::{place, reference, slice};
use crate::status::{guard, opendr_status};
use crate::value::{AnyValue, opendr_heatmap};

/// The elements of a heatmap in row-major order: either labels or scores, the other is NULL.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_heatmap_fields {
    /// Class indices.
    pub labels: *const u32,
    /// Scores.
    pub scores: *const f32,
    /// Number of elements.
    pub length: usize,
    /// Length of each axis, e.g. height and width.
    pub shape: *const usize,
    /// Number of axes, 1 to 8.
    pub axes: usize,
}

/// Creates a heatmap; the elements are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_heatmap_create(
    fields: *const opendr_heatmap_fields,
    heatmap: *mut *mut opendr_heatmap,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, fields) = unsafe { (Out::new(heatmap, "heatmap")?, reference(fields, "fields")?) };
        // SAFETY: the rules at the top of opendr.h.
        out.set(AnyValue::from(unsafe { fields.to_heatmap() }?));
        Ok(())
    })
}

/// Writes pointers to the elements of a heatmap, valid as long as the heatmap.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_heatmap_read(
    heatmap: *const opendr_heatmap,
    fields: *mut opendr_heatmap_fields,
) -> opendr_status {
    guard(|| {
        let place = place(fields, "fields")?;
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { AnyValue::of(heatmap, "heatmap") }?;
        let heatmap = value.typed::<Heatmap>("heatmap")?;
        let (labels, scores, length) = match heatmap.values() {
            HeatmapValues::Labels(labels) => (labels.as_ptr(), ptr::null(), labels.len()),
            HeatmapValues::Scores(scores) => (ptr::null(), scores.as_ptr(), scores.len()),
        };
        let (shape, axes) = (heatmap.shape().as_ptr(), heatmap.shape().len());
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(opendr_heatmap_fields { labels, scores, length, shape, axes }) };
        Ok(())
    })
}

impl opendr_heatmap_fields {
    /// # Safety
    /// Its pointers are valid.
    unsafe fn to_heatmap(self) -> Result<Heatmap> {
        // SAFETY: the caller's promise.
        let shape = unsafe { slice(self.shape, self.axes, "shape") }?;
        let expected = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        if expected != Some(self.length) {
            return Err(Error::invalid_input(format!(
                "a heatmap of shape {shape:?} cannot have {} elements; give one per position",
                self.length
            )));
        }
        // SAFETY: the caller's promise.
        unsafe {
            match (self.labels.is_null(), self.scores.is_null()) {
                (false, true) => {
                    Heatmap::from_labels(slice(self.labels, self.length, "labels")?.to_vec(), shape)
                }
                (true, false) => {
                    Heatmap::from_scores(slice(self.scores, self.length, "scores")?.to_vec(), shape)
                }
                _ => Err(Error::invalid_input("a heatmap has either labels or scores; give one of them")),
            }
        }
    }
}
