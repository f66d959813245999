//! The demonstration: an image and the places of the jaws.

use opendr_engine::data::Image;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::Pose;
use opendr_engine::{Error, Result, ResultExt as _, Value};

use super::network::{SIDE, SQUARE, square};

/// A demonstrated grasp, as the network sees it.
#[derive(Debug, Clone)]
pub struct GraspExample {
    /// Levels of red, green and blue in 0..=1, `[3, SIDE, SIDE]`.
    pub(super) planes: Vec<f32>,
    /// Pixels of the left and the right jaw in it.
    pub(super) jaws: [[f32; 2]; 2],
}

impl GraspExample {
    /// Creates a demonstration from an image and the pixels of the left and the right jaw. The central square of the image is used.
    ///
    /// # Errors
    /// `InvalidInput` for jaws outside of the central square or at the same place.
    pub fn new(image: &Image, jaws: [[f32; 2]; 2]) -> Result<Self> {
        let crop = square(image);
        let mut planes = vec![0.0; 3 * SQUARE];
        super::network::levels(image, &crop, &mut planes)?;
        let seen = jaws.map(|jaw| crop.crop_from_image(jaw));
        let outside = |at: &f32| !(0.0..=SIDE as f32).contains(at);
        let [left, right] = seen;
        if seen.iter().flatten().any(outside) || (left[0] - right[0]).hypot(left[1] - right[1]) < 2.0 {
            return Err(Error::invalid_input(format!(
                "jaws at {jaws:?}; give two places that differ, in the central square of the image of {}x{} pixels",
                image.width(),
                image.height()
            )));
        }
        Ok(Self { planes, jaws: seen })
    }

    /// Reads the demonstration of a data set of one image with one pose of two key points, the left and the right jaw.
    ///
    /// # Errors
    /// Errors of the data set, `InvalidInput` for other data.
    pub fn from_dataset(dataset: &dyn DatasetIterator) -> Result<Self> {
        if dataset.len() != 1 {
            return Err(Error::invalid_input(format!(
                "a data set of {} images; give one image: the grasp is learned from a single demonstration",
                dataset.len()
            )));
        }
        let (sample, name) = (dataset.get(0)?, dataset.name(0));
        let image = sample.data.iter().find_map(|value| match value {
            Value::Image(image) => Some(image),
            _ => None,
        });
        let poses: &[Pose] = match &sample.target {
            Some(Value::PoseList(list)) => &list.poses,
            _ => &[],
        };
        let (Some(image), [pose]) = (image, poses) else {
            return Err(Error::invalid_input(format!(
                "{name}: {} annotated poses; give an image with one pose of two key points, the jaws",
                poses.len()
            )));
        };
        let [left, right] = &pose.keypoints[..] else {
            return Err(Error::invalid_input(format!(
                "{name}: a pose of {} key points; give two, the left and the right jaw",
                pose.keypoints.len()
            )));
        };
        Self::new(image, [[left.x, left.y], [right.x, right.y]]).context(|| name)
    }
}
