//! Overlap of boxes: axis-aligned ones in an image, rotated rectangles and quadrilaterals on a plane, and 3D boxes that stand on it.
//!
//! Metrics, trackers and 3D non-maximum suppression use these functions.

mod polygon;
mod quadrilateral;
mod rotated;
mod upright;

pub use quadrilateral::Quadrilateral;
pub use rotated::{RotatedRectangle, UprightBox3D};
pub use upright::{box_diou, box_giou, box_ioa, box_iou};
