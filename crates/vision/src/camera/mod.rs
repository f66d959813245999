//! Cameras of the operating system.

// A pure conversion, built and tested everywhere.
#[cfg_attr(not(all(target_os = "linux", target_pointer_width = "64")), allow(dead_code))]
mod mjpeg;

#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
mod v4l2;
#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
pub(crate) use v4l2::Camera;

#[cfg(not(all(target_os = "linux", target_pointer_width = "64")))]
mod unsupported;
#[cfg(not(all(target_os = "linux", target_pointer_width = "64")))]
pub(crate) use unsupported::Camera;
