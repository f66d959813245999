//! One demonstrated grasp.

use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};
use opendr_engine::{Random, Result};

use super::camera::Camera;
use super::scene::{Surroundings, render};
use super::{Grasp, GraspObject, PlanarGraspParams};
use crate::planar::Pose;

/// Levels of the sheet, from which every object differs.
const SHEET: [f32; 3] = [238.0, 238.0, 232.0];

/// A view of an object and the grasp that a person shows.
#[derive(Debug, Clone)]
pub struct GraspDemonstration {
    /// The object.
    pub object: GraspObject,
    /// Colour image.
    pub image: Image,
    /// Depth image, m.
    pub depth: Image,
    /// The grasp.
    pub grasp: Grasp,
    /// Pixels of the left and the right jaw: the key points `l_jaw` and `r_jaw` of a `grasp2`.
    pub jaws: [[f32; 2]; 2],
}

impl GraspDemonstration {
    /// Renders an object upright in the middle of a white sheet.
    ///
    /// # Errors
    /// `InvalidParam` for a parameter out of range.
    pub fn record(object: GraspObject, params: &PlanarGraspParams) -> Result<Self> {
        opendr_engine::params::Params::check(params)?;
        let size = params.size;
        let (mut colours, mut depths) = (vec![0.0; 3 * size * size], vec![0.0; size * size]);
        let mut random = Random::from_key([object as u64, 0xde30]);
        let surroundings = Surroundings::draw(0.0, &mut random).with_table(SHEET);
        let pose = Pose::default();
        render(params, &surroundings, (object, pose), &mut random, (&mut colours, &mut depths));
        let grasp = object.shown_grasp(&pose);
        let (image, depth) = (colour_image(&colours, size)?, depth_image(&depths, size)?);
        Ok(Self { object, image, depth, grasp, jaws: Camera::new(size).jaws(&grasp) })
    }
}

/// Returns the image of colour levels `[size, size, 3]`.
pub(super) fn colour_image(levels: &[f32], size: usize) -> Result<Image> {
    Image::from_rgb8(levels.iter().map(|level| *level as u8).collect(), size, size)
}

/// Returns the image of depths `[size, size]`, in metres.
pub(super) fn depth_image(depths: &[f32], size: usize) -> Result<Image> {
    Image::new(Pixels::from(depths.to_vec()), size, size, PixelFormat::Grey, Layout::Hwc)
}
