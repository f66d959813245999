//! What is measured in images: corners, their motion, their disparity and their descriptors.

mod corners;
mod descriptor;
mod disparity;
mod flow;
mod pyramid;
#[cfg(test)]
mod tests;

pub(crate) use corners::CornerFinder;
pub(crate) use descriptor::{Descriptor, Sampling, distance};
pub(crate) use disparity::find_disparity;
pub(crate) use flow::{Match, follow};
pub(crate) use pyramid::{Level, Pyramid};
