//! A picture with boxes found before, for learners that look at these again.

use std::fmt;

use crate::Header;
use crate::data::{Data, Image};
use crate::target::BoundingBoxList;

/// A picture with boxes in it.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageWithDetections {
    /// When and where it was taken; those of picture and boxes do not count.
    pub header: Header,
    /// The picture.
    pub image: Image,
    /// The boxes (OpenDR's `boundingBoxList`).
    pub boxes: BoundingBoxList,
}

impl ImageWithDetections {
    /// The picture with its boxes; the header is the picture's.
    pub fn new(image: Image, boxes: BoundingBoxList) -> Self {
        Self { header: image.header.clone(), image, boxes }
    }
}

impl Data for ImageWithDetections {}

/// OpenDR's text; `{:#}` gives the picture's size, then the boxes.
impl fmt::Display for ImageWithDetections {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            return write!(f, "{:#}{:#}", self.image, self.boxes);
        }
        write!(f, "ImageWithDetections {}{}", self.image, self.boxes)
    }
}
