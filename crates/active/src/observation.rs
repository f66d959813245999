//! Observations of camera policies: a thumbnail, confidences and poses, nothing internal to the recogniser.

use opendr_engine::data::Image;
use opendr_engine::rig::{Achieved, ViewAxis, ViewPose};
use opendr_engine::target::ActionBase as _;
use opendr_engine::{Error, Result};

use crate::best_view::{BestView, BestViewBelief, BestViewEstimator, in_camera_frame};
use crate::fusion::Belief;

/// Width and height of the thumbnail in pixels.
const SIDE: usize = 12;
/// Numbers of belief, pose and motion, and of the direction to the best view.
const BELIEF: usize = 18;
const DIRECTION: usize = 9;

/// Turns views and beliefs into observations: luminance of 12 x 12 pixels with mean 0, then confidence and uncertainty of the
/// belief, information of the last and of the best view, the pose, the direction to the best view, the last motion and whether a
/// limit stopped it, the used share of the budget, and where an estimator is given the direction to the best view relative to the
/// camera with its certainty.
#[derive(Debug, Clone)]
pub struct Observer {
    axes: Vec<ViewAxis>,
    budget: usize,
    begin: ViewPose,
    thumbnail: [f32; SIDE * SIDE],
    last: Option<Achieved>,
    best_view: Option<(BestViewEstimator, BestViewBelief)>,
}

impl Observer {
    /// Length of an observation.
    pub const LEN: usize = SIDE * SIDE + BELIEF + DIRECTION;

    /// Creates an observer of a rig with these axes and a maximum number of motions. Without an estimator of the best view, its numbers
    /// are 0.
    pub fn new(axes: &[ViewAxis], budget: usize, estimator: Option<BestViewEstimator>) -> Self {
        Self {
            axes: axes.to_vec(),
            budget: budget.max(1),
            begin: ViewPose::default(),
            thumbnail: [0.0; SIDE * SIDE],
            last: None,
            best_view: estimator.map(|estimator| (estimator, BestViewBelief::default())),
        }
    }

    /// Begins an episode at a pose.
    pub fn reset(&mut self, pose: ViewPose) {
        self.begin = pose;
        self.last = None;
        if let Some((_, belief)) = &mut self.best_view {
            belief.reset();
        }
    }

    /// Sets the last motion.
    pub fn set_motion(&mut self, achieved: Achieved) {
        self.last = Some(achieved);
    }

    /// Adds the image of a view at a pose: sets the thumbnail, and updates the direction to the best view.
    ///
    /// # Errors
    /// Returns `InvalidInput` for an image that is not of 8 bits, `Internal` for an estimator whose outputs are not finite.
    pub fn add(&mut self, image: &Image, pose: ViewPose) -> Result<()> {
        if let Some((estimator, belief)) = &mut self.best_view {
            belief.add(pose, &estimator.estimate(image)?);
        }
        self.set_thumbnail(image)
    }

    fn set_thumbnail(&mut self, image: &Image) -> Result<()> {
        let (width, height) = (image.width(), image.height());
        let opendr_engine::data::Pixels::U8(pixels) = image.pixels() else {
            return Err(Error::invalid_input("a camera policy takes images of 8 bits; convert the image"));
        };
        let (channels, planes) = (image.channels(), image.layout() == opendr_engine::data::Layout::Chw);
        let colours = channels.min(3);
        for (at, luminance) in self.thumbnail.iter_mut().enumerate() {
            // At least one pixel each, for an image smaller than the thumbnail.
            let range = |number: usize, size: usize| {
                let begin = number * size / SIDE;
                begin..((number + 1) * size / SIDE).max(begin + 1)
            };
            let (mut sum, mut count) = (0u32, 0u32);
            for row in range(at / SIDE, height) {
                for column in range(at % SIDE, width) {
                    for channel in 0..colours {
                        let pixel = row * width + column;
                        let place = if planes {
                            channel * width * height + pixel
                        } else {
                            channels * pixel + channel
                        };
                        sum += u32::from(pixels[place]);
                    }
                    count += colours as u32;
                }
            }
            *luminance = sum as f32 / (255 * count) as f32;
        }
        let mean = self.thumbnail.iter().sum::<f32>() / (SIDE * SIDE) as f32;
        self.thumbnail.iter_mut().for_each(|luminance| *luminance = 3.0 * (*luminance - mean));
        Ok(())
    }

    /// Writes the observation, of [`Self::LEN`] numbers.
    pub fn observe(&self, pose: &ViewPose, belief: &Belief, observation: &mut [f32]) {
        let (thumbnail, numbers) = observation.split_at_mut(SIDE * SIDE);
        thumbnail.copy_from_slice(&self.thumbnail);
        let (best, information) = belief.most_informative().unwrap_or((pose, 0.0));
        let (turned, back) =
            ((pose.azimuth - self.begin.azimuth) as f32, (best.azimuth - pose.azimuth) as f32);
        let share = |axis: usize, position: f64| {
            let limits = self.axes.get(axis).map_or((0.0, 1.0), |axis| (axis.low, axis.high));
            (2.0 * (position - limits.0) / (limits.1 - limits.0) - 1.0) as f32
        };
        let mut last = [0.0; 4];
        let mut stopped = 0.0;
        if let Some(achieved) = &self.last {
            let axes = achieved.action.axes();
            last[..axes.len()].copy_from_slice(axes);
            stopped = if achieved.is_complete() { 0.0 } else { 1.0 };
        }
        let moves = belief.views().saturating_sub(1) as f32;
        let state: [f32; BELIEF] = [
            belief.best().1,
            belief.uncertainty(),
            belief.last_information(),
            information,
            share(1, pose.elevation),
            share(2, pose.distance),
            turned.sin(),
            turned.cos(),
            back.sin(),
            back.cos(),
            (best.elevation - pose.elevation) as f32,
            moves / self.budget as f32,
            last[0],
            last[1],
            last[2],
            last[3],
            stopped,
            if belief.views() > 1 { 1.0 } else { 0.0 },
        ];
        let (of_belief, of_best_view) = numbers.split_at_mut(BELIEF);
        of_belief.copy_from_slice(&state);
        match &self.best_view {
            Some((_, belief)) => of_best_view.copy_from_slice(&direction_numbers(&belief.best(), pose)),
            None => of_best_view.fill(0.0),
        }
    }
}

/// The direction to the best view relative to the camera at `pose`: certainty, direction and angles, and the mean of all directions.
fn direction_numbers(to: &BestView, pose: &ViewPose) -> [f32; DIRECTION] {
    let level = ViewPose { elevation: 0.0, ..*pose };
    let [[ahead, left, up], mean] = [to.direction, to.mean].map(|part| in_camera_frame(&level, part));
    let rise = up.clamp(-1.0, 1.0).asin() - pose.elevation as f32;
    [to.certainty, ahead, left, up, left.atan2(ahead), rise, mean[0], mean[1], mean[2]]
}
