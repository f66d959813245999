//! Drives through a rendered town with exact truth: what a car's camera, stereo camera or depth camera images, and where it was.
//!
//! A [`Drive`] has a course (straight, curves, or a loop around a block that returns to its start), a town along it with textured
//! ground, facades, parked cars, poles and trees, and a camera that pitches and rolls slightly. Poses are those of the left camera
//! in the frame of cameras (x right, y down, z ahead). The same options give the same drive.
//!
//! ```
//! use opendr_simulation::drive::{Course, Drive, DriveOptions};
//!
//! let drive = Drive::new(&DriveOptions { course: Course::Straight, length: 20.0, ..DriveOptions::default() })?;
//! let frame = drive.render(3)?;
//! assert_eq!((frame.left.width(), frame.left.height()), (640, 480));
//! assert!((drive.pose(3)[0][3] - drive.pose(0)[0][3]) > 1.0); // metres ahead
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod course;
mod finish;
mod frame;
mod options;
mod ride;
mod sensor;
#[cfg(test)]
mod tests;
mod town;

pub use frame::{Drive, DriveFrame};
pub use options::{Course, DriveOptions};
