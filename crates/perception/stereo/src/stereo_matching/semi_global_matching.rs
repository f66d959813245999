//! Semi-global matching: disparities, depths and obstacles of a rectified stereo pair, without a network.
//!
//! [`opendr_vision::stereo`] implements the matching; [`StereoCamera::points`] converts depths to a point cloud.

use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec, Targets};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox3DList, Classes, Heatmap};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_vision::stereo::{StereoCamera, StereoMatcher, StereoOptions};

use super::obstacles::{ObstacleOptions, Obstacles};

/// Parameters of [`SemiGlobalMatching`].
#[derive(Debug, Clone, Params)]
pub struct SemiGlobalMatchingParams {
    /// Minimum disparity.
    #[param(default = 0, range = 0..=4096, unit = "px", live)]
    pub min_disparity: usize,
    /// Number of disparities; rounded up to a multiple of 16.
    #[param(default = 64, range = 1..=1024, unit = "px", live)]
    pub num_disparities: usize,
    /// Penalty of a disparity change of one pixel, in differing bits of the 62-bit census.
    #[param(default = 8, range = 0..=193, live)]
    pub p1: u32,
    /// Penalty of a larger disparity change.
    #[param(default = 40, range = 0..=193, live)]
    pub p2: u32,
    /// Margin by which the best disparity must be better than the second best.
    #[param(default = 5, range = 0..=99, unit = "%", live)]
    pub uniqueness_ratio: u32,
    /// Maximum difference in the left-right check; -1 for no check.
    #[param(default = 1, range = -1..=1000, unit = "px", live)]
    pub disp12_max_diff: i32,
    /// Maximum size of speckles, which are removed.
    #[param(default = 100, range = 0..=1_000_000, unit = "px", live)]
    pub speckle_window_size: u32,
    /// Maximum disparity difference between neighbours of one speckle.
    #[param(default = 1.0, range = 0.0..=1000.0, unit = "px", live)]
    pub speckle_range: f32,
    /// Whether holes are filled from the background in their row.
    #[param(default = false, live)]
    pub fill: bool,
    /// Factor by which the images are downscaled for matching: faster, coarser.
    #[param(default = 1, range = 1..=16, unit = "px", live)]
    pub shrink: usize,
    /// Focal length of the rectified pair. Required for depths.
    #[param(default = 0.0, range = 0.0..=1e6, unit = "px", live)]
    pub focal_length: f32,
    /// Distance between the cameras. Required for depths.
    #[param(default = 0.0, range = 0.0..=1000.0, unit = "m", live)]
    pub baseline: f32,
    /// Difference of the principal points' x, right minus left (Middlebury's doffs).
    #[param(default = 0.0, range = -1e4..=1e4, unit = "px", live)]
    pub disparity_offset: f32,
    /// Height of the cameras above the floor. Required for obstacles.
    #[param(default = 0.0, range = 0.0..=100.0, unit = "m", live)]
    pub camera_height: f32,
    /// Pitch of the cameras, positive downwards.
    #[param(default = 0.0, range = -89.0..=89.0, unit = "deg", live)]
    pub camera_pitch: f32,
    /// Minimum height of an obstacle above the floor.
    #[param(default = 0.2, range = 0.0..=100.0, unit = "m", live)]
    pub min_height: f32,
    /// Maximum height of an obstacle above the floor.
    #[param(default = 2.0, range = 0.0..=100.0, unit = "m", live)]
    pub max_height: f32,
    /// Maximum distance of an obstacle.
    #[param(default = 10.0, range = 0.1..=100.0, unit = "m", live)]
    pub max_distance: f32,
}

/// A rectified pair of equal size, in which corresponding points are in the same row.
#[derive(Inputs)]
pub struct SemiGlobalMatchingInputs<'a> {
    /// Image of the left camera.
    pub left: &'a Image,
    /// Image of the right camera.
    pub right: &'a Image,
}

/// Prediction for a pair.
#[derive(Default, Targets)]
pub struct SemiGlobalMatchingTargets {
    /// Disparity of each pixel of the left image in pixels; 0 where it is unknown.
    pub disparity: Heatmap,
    /// Depth of each pixel in metres; 0 where it is unknown. Empty without focal length and baseline.
    pub depth: Heatmap,
    /// Obstacles on the floor, nearest first, in the frame of a level camera at the same position. Empty without focal length,
    /// baseline and camera height.
    pub obstacles: BoundingBox3DList,
}

/// Learner of stereo matching.
pub struct SemiGlobalMatching {
    params: SemiGlobalMatchingParams,
    classes: Classes,
    work: Pool<Work>,
}

#[derive(Default)]
struct Work {
    matcher: StereoMatcher,
    obstacles: Obstacles,
}

impl Learner for SemiGlobalMatching {
    const SPEC: Spec = Spec::new("semi_global_matching", Task::StereoMatching)
        .class("SemiGlobalMatchingLearner")
        .about("Computes disparity, depth and obstacles of a stereo pair by semi-global matching.");
    type Params = SemiGlobalMatchingParams;
    type Input<'a> = SemiGlobalMatchingInputs<'a>;
    type Target = SemiGlobalMatchingTargets;
    type State = ();

    fn load(_: &Model, params: SemiGlobalMatchingParams, _: Device) -> Result<Self> {
        Ok(Self::with_params(params))
    }

    fn params(&self) -> &SemiGlobalMatchingParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut SemiGlobalMatchingParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(
        &self,
        _: &mut (),
        input: SemiGlobalMatchingInputs<'_>,
        targets: &mut SemiGlobalMatchingTargets,
    ) -> Result<()> {
        let SemiGlobalMatchingTargets { disparity, depth, obstacles } = targets;
        let Work { matcher, obstacles: finder } = &mut *self.work.take();
        let size @ [width, height] = [input.left.width(), input.left.height()];
        let disparities = disparity.scores_mut(&[height, width]);
        matcher.run_into(input.left, input.right, &self.options(), disparities)?;
        obstacles.boxes.clear();
        obstacles.classes.clone_from(&self.classes);
        let Some(camera) = self.camera(size) else {
            depth.scores_mut(&[0, 0]);
            return Ok(());
        };
        let depths = depth.scores_mut(&[height, width]);
        for (depth, disparity) in depths.iter_mut().zip(disparities) {
            *depth = camera.depth(*disparity);
        }
        if self.params.camera_height > 0.0 {
            finder.find(&camera, depths, width, &self.obstacle_options(), &mut obstacles.boxes);
        }
        Ok(())
    }
}

impl SemiGlobalMatching {
    /// Creates the learner; it needs no model.
    pub fn with_params(params: SemiGlobalMatchingParams) -> Self {
        Self { params, classes: ["obstacle"].into_iter().collect(), work: Pool::default() }
    }

    /// Returns the camera of images of `size`, with the principal point in the centre; `None` without focal length and
    /// baseline.
    pub fn camera(&self, size: [usize; 2]) -> Option<StereoCamera> {
        let SemiGlobalMatchingParams { focal_length: focal, baseline, disparity_offset: offset, .. } =
            self.params;
        let centre = size.map(|side| side as f32 / 2.0);
        (focal > 0.0 && baseline > 0.0).then_some(StereoCamera {
            focal_length: focal,
            baseline,
            principal_point: centre,
            principal_point_offset: offset,
        })
    }

    fn options(&self) -> StereoOptions {
        let params = &self.params;
        StereoOptions {
            min_disparity: params.min_disparity,
            disparities: params.num_disparities,
            p1: byte(params.p1),
            p2: byte(params.p2),
            uniqueness: byte(params.uniqueness_ratio),
            max_left_right_difference: u16::try_from(params.disp12_max_diff).ok(),
            speckle_size: params.speckle_window_size,
            speckle_range: params.speckle_range,
            fill: params.fill,
            downscale: params.shrink,
        }
    }

    fn obstacle_options(&self) -> ObstacleOptions {
        let params = &self.params;
        ObstacleOptions {
            camera_height: params.camera_height,
            camera_pitch: params.camera_pitch.to_radians(),
            heights: [params.min_height, params.max_height],
            farthest: params.max_distance,
        }
    }
}

fn byte(number: u32) -> u8 {
    u8::try_from(number).unwrap_or(u8::MAX)
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;
    use opendr_engine::data::{Layout, PixelFormat};

    use super::*;

    fn picture(width: usize, height: usize, shift: usize) -> Image {
        let level = |at: usize| {
            let (x, y) = ((at % width + shift) as u64, (at / width) as u64);
            ((x * 0x9E37_79B9 + y * 0x85EB_CA6B).wrapping_mul(0xC2B2_AE35_27D4_EB4F) >> 40) as u8
        };
        let levels: Vec<u8> = (0..width * height).map(level).collect();
        Image::new(levels, width, height, PixelFormat::Grey, Layout::Hwc).unwrap()
    }

    #[test]
    fn a_wall_is_a_metre_away_and_an_obstacle() {
        let mut params = SemiGlobalMatchingParams {
            focal_length: 100.0,
            baseline: 0.12,
            num_disparities: 32,
            ..SemiGlobalMatchingParams::default()
        };
        let (left, right) = (picture(200, 100, 0), picture(200, 100, 12));
        let mut targets = SemiGlobalMatchingTargets::default();
        let input = || SemiGlobalMatchingInputs { left: &left, right: &right };
        let mut matcher = SemiGlobalMatching::with_params(params.clone());
        matcher.infer_into(&mut (), input(), &mut targets).unwrap();
        let opendr_engine::target::HeatmapValues::Scores(depths) = targets.depth.values() else { panic!() };
        assert!(depths.iter().filter(|depth| (**depth - 1.0).abs() < 0.05).count() > 17_000);
        assert!(targets.obstacles.boxes.is_empty());
        params.camera_height = 0.4;
        matcher = SemiGlobalMatching::with_params(params);
        matcher.infer_into(&mut (), input(), &mut targets).unwrap();
        let [wall] = &targets.obstacles.boxes[..] else { panic!("{:?}", targets.obstacles) };
        assert!((wall.location[2] - 1.0).abs() < 0.2 && wall.dimensions[0] > 1.5, "{wall:?}");
    }

    #[test]
    fn without_a_calibration_there_are_no_depths_and_two_sizes_are_refused() {
        let matcher = SemiGlobalMatching::with_params(SemiGlobalMatchingParams::default());
        let (left, right) = (picture(80, 40, 0), picture(80, 41, 3));
        let mut targets = SemiGlobalMatchingTargets::default();
        let input = SemiGlobalMatchingInputs { left: &left, right: &left };
        matcher.infer_into(&mut (), input, &mut targets).unwrap();
        assert_eq!((targets.disparity.shape(), targets.depth.shape()), (&[40, 80][..], &[0, 0][..]));
        let input = SemiGlobalMatchingInputs { left: &left, right: &right };
        let error = matcher.infer_into(&mut (), input, &mut targets).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
    }
}
