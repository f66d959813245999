//! Cameras of the operating system.

// Pure conversions, built and tested everywhere.
#[cfg_attr(not(all(target_os = "linux", target_pointer_width = "64")), allow(dead_code))]
mod mjpeg;
#[cfg_attr(not(all(target_os = "linux", target_pointer_width = "64")), allow(dead_code))]
mod yuyv;

#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
mod v4l2;
#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
pub(crate) use v4l2::Camera;

#[cfg(not(all(target_os = "linux", target_pointer_width = "64")))]
mod unsupported;
#[cfg(not(all(target_os = "linux", target_pointer_width = "64")))]
pub(crate) use unsupported::Camera;
