//! An image with detections, for learners that process detections further.

use std::fmt;

use crate::Header;
use crate::data::{Data, Image};
use crate::target::BoundingBoxList;

/// An image with detected boxes.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageWithDetections {
    /// Time stamp and coordinate frame; the headers of image and boxes are ignored.
    pub header: Header,
    /// The image.
    pub image: Image,
    /// The boxes (OpenDR's `boundingBoxList`).
    pub boxes: BoundingBoxList,
}

impl ImageWithDetections {
    /// Creates the datum; its header is that of the image.
    pub fn new(image: Image, boxes: BoundingBoxList) -> Self {
        Self { header: image.header.clone(), image, boxes }
    }
}

impl Data for ImageWithDetections {}

/// Writes OpenDR's text; with `{:#}`, the size of the image, then the boxes.
impl fmt::Display for ImageWithDetections {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            return write!(f, "{:#}{:#}", self.image, self.boxes);
        }
        write!(f, "ImageWithDetections {}{}", self.image, self.boxes)
    }
}
