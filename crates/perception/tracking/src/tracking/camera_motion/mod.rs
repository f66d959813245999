//! Estimation of the camera's motion between frames.
//!
//! Corners of the static background (J. Shi, C. Tomasi, "Good features to track", CVPR 1994) are tracked through an image
//! pyramid (B. D. Lucas, T. Kanade, IJCAI 1981; J.-Y. Bouguet, "Pyramidal implementation of the Lucas Kanade feature
//! tracker", 2001), and the similarity that most of them agree with is the camera's motion. Trackers move their predictions
//! by it.

mod consensus;
mod corners;
mod flow;
mod plane_motion;
mod pyramid;

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_vision::{ChannelOrder, Preprocess};

pub use plane_motion::SimilarityMotion;

use super::ValidBox;
use consensus::Consensus;
use corners::Corners;
use pyramid::Pyramid;

/// Longer side of the grey image from which the pyramid is built, in pixels.
const LONGER_SIDE: usize = 640;
/// Minimum side of images, in pixels.
const SMALLEST_SIDE: usize = 64;

/// Estimator of the motion of one camera, frame by frame. Its memory is reused.
#[derive(Debug, Default)]
pub struct CameraMotion {
    /// Size of the images, and their conversion to grey.
    preprocess: Option<([usize; 2], Preprocess)>,
    grey: Vec<f32>,
    before: Pyramid,
    now: Pyramid,
    /// Corners of the last frame.
    corners: Corners,
    consensus: Consensus,
}

impl CameraMotion {
    /// Returns the motion from the last frame to `image`. `objects` are boxes of moving objects in `image`, in pixels;
    /// corners in them are not tracked to the next frame.
    ///
    /// The result is [`SimilarityMotion::NONE`] for the first frame, after a change of the image size, and when too few corners
    /// agree.
    ///
    /// # Errors
    /// As [`Preprocess::run_into`].
    pub fn update(&mut self, image: &Image, objects: &[ValidBox]) -> Result<SimilarityMotion> {
        let size = [image.width(), image.height()];
        if size.into_iter().min() < Some(SMALLEST_SIDE) {
            *self = Self::default();
            return Ok(SimilarityMotion::NONE);
        }
        if self.preprocess.as_ref().is_none_or(|(known, _)| *known != size) {
            *self = Self::default();
        }
        let (_, preprocess) = self.preprocess.get_or_insert_with(|| (size, grey_of(size)));
        self.grey.resize(preprocess.len(), 0.0);
        preprocess.run_into(image.view(), &mut self.grey)?;
        std::mem::swap(&mut self.before, &mut self.now);
        self.now.fill(&self.grey, preprocess.size());
        let level = self.now.size();
        let scale = [0, 1].map(|axis| size[axis] as f32 / level[axis] as f32);
        let motion = match self.corners.points() {
            [] => SimilarityMotion::NONE,
            points => {
                self.consensus.begin();
                for point in points {
                    if let Some(found) = flow::follow(&self.before, &self.now, *point) {
                        // Pixel centres are at .5 in images, at 0 in the pyramid.
                        let full = |point: [f32; 2]| [0, 1].map(|axis| (point[axis] + 0.5) * scale[axis]);
                        self.consensus.add(full(*point), full(found));
                    }
                }
                self.consensus.motion(size)
            }
        };
        self.corners.pick(&self.now, |[x, y]| {
            let [x, y] = [(x + 0.5) * scale[0], (y + 0.5) * scale[1]].map(f64::from);
            let holds = |[x0, y0, x1, y1]: [f64; 4]| x >= x0 && x < x1 && y >= y0 && y < y1;
            !objects.iter().any(|object| holds(object.corners))
        });
        Ok(motion)
    }
}

fn grey_of(size: [usize; 2]) -> Preprocess {
    let longer = size[0].max(size[1]);
    let by = (LONGER_SIDE as f64 / longer as f64).min(1.0);
    let [width, height] = size.map(|side| ((side as f64 * by).round() as usize).max(1));
    Preprocess::new(width, height).order(ChannelOrder::Grey)
}

#[cfg(test)]
mod tests;
