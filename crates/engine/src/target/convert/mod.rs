//! Targets to and from the forms of data sets. One file per form.

mod coco;
mod kitti;
mod kitti_file;
mod kitti_text;
mod mot;
mod table;

pub use coco::CocoAnnotation;
pub use kitti::KittiColumns;
