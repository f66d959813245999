//! Images with detected boxes.

use opendr::data::ImageWithDetections;

use crate::handle::Out;
use crate::status::{guard, opendr_status};
use crate::value::{AnyValue, opendr_bounding_box_list, opendr_image, opendr_image_with_detections, typed};

/// Creates an image with boxes; the caller keeps image and boxes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_image_with_detections_create(
    image: *const opendr_image,
    boxes: *const opendr_bounding_box_list,
    both: *mut *mut opendr_image_with_detections,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, image, boxes) =
            unsafe { (Out::new(both, "both")?, typed(image, "image")?, typed(boxes, "boxes")?) };
        out.set(AnyValue::from(ImageWithDetections::new(Clone::clone(image), Clone::clone(boxes))));
        Ok(())
    })
}

/// Creates new handles of the image and of the boxes, which must be freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_image_with_detections_read(
    both: *const opendr_image_with_detections,
    image: *mut *mut opendr_image,
    boxes: *mut *mut opendr_bounding_box_list,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (image, boxes) = unsafe { (Out::new(image, "image")?, Out::new(boxes, "boxes")?) };
        // SAFETY: the rules at the top of opendr.h.
        let both = unsafe { typed::<ImageWithDetections, _>(both, "both") }?;
        image.set(AnyValue::from(both.image.clone()));
        boxes.set(AnyValue::from(both.boxes.clone()));
        Ok(())
    })
}
