//! Conversion of targets to and from the formats of data sets. One file per format.

mod coco;
mod kitti;
mod kitti_file;
mod kitti_text;
mod mot;
mod table;

pub use coco::CocoAnnotation;
pub use kitti::KittiColumns;
