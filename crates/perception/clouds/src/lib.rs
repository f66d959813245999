//! Point clouds: 3D object detection, pillars, range images.
//!
//! [`object_detection_3d`] has the learner [`VoxelObjectDetection3d`](object_detection_3d::VoxelObjectDetection3d)
//! (PointPillars), whose input is a [`Scan`](object_detection_3d::Scan). [`pillars`] sorts points into a grid on the ground,
//! [`range_image`] projects a scan of a spinning lidar to an image; both work without a learner. The feature `training` adds
//! `fit`. Tracking in point clouds is in the crate `opendr-tracking`, panoptic segmentation of scans in `opendr-panoptic`.
//!
//! Begin with `VoxelObjectDetection3d`.
//!
//! ```
//! use opendr_clouds::pillars::{PillarGrid, Voxeliser};
//!
//! let grid = PillarGrid { x: [0.0, 8.0], y: [-4.0, 4.0], z: [-3.0, 1.0], side: 0.5 };
//! let mut voxeliser = Voxeliser::default();
//! voxeliser.begin(&grid);
//! let point = voxeliser.add(&grid, &[1.2, 0.4, -1.0, 0.3]).expect("a point on the grid");
//! assert_eq!((point.pillar, voxeliser.cells().len()), (0, 1));
//! ```

pub mod object_detection_3d;
pub mod pillars;
pub mod range_image;
