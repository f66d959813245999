//! C-BIoU: association by the overlap of enlarged boxes, in two passes, without a motion model.
//!
//! F. Yang, S. Odashima, S. Masui, S. Jiang, "Hard to Track Objects with Irregular Motions and Similar Appearances? Make It
//! Easier by Buffering the Matching Space", WACV 2023; written from the paper. For objects that move fast, turn suddenly or
//! look alike (dancers, players, animals), for which the boxes of a Kalman filter no longer overlap the detections.

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::box_iou;
use opendr_engine::params::Params;
use opendr_engine::target::TrackingAnnotationList;
use opendr_engine::{Device, Result, Task};

use super::TrackerInputs;
use super::tracks::{Rules, Track, Tracks};
use crate::tracking::ValidBox;
use crate::tracking::camera_motion::SimilarityMotion;

/// Maximum number of detections from which the velocity of a track is computed.
const MAX_OBSERVATIONS: usize = 16;

/// Parameters of [`CBiou`].
#[derive(Debug, Clone, Params)]
pub struct CBiouParams {
    /// Score below which detections are ignored.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Enlargement of the boxes in the first pass, on each side, as a fraction of width and height.
    #[param(default = 0.3, range = 0.0..=2.0, live)]
    pub small_buffer: f32,
    /// Enlargement in the second pass, for the tracks and detections that the first one left.
    #[param(default = 0.4, range = 0.0..=2.0, live)]
    pub large_buffer: f32,
    /// Minimum IoU of the enlarged boxes of a track and its detection.
    #[param(default = 0.3, range = 0.01..=1.0, live)]
    pub iou_threshold: f32,
    /// Number of detections whose mean motion is extrapolated; 1 for none.
    #[param(default = 5, range = 1..=16, live)]
    pub motion_window: u32,
    /// Number of frames that a track is kept without a detection.
    #[param(default = 30, range = 0..=1000, live)]
    pub max_age: u32,
    /// Number of detections in a row that confirm a track; in the first frames of a stream, one.
    #[param(default = 3, range = 1..=100, live)]
    pub min_hits: u32,
    /// Whether only boxes of the same class match.
    #[param(default = true, live)]
    pub per_class: bool,
}

/// The C-BIoU tracker.
pub struct CBiou {
    params: CBiouParams,
}

/// The tracks of one stream.
#[derive(Default)]
pub struct CBiouState {
    tracks: Tracks<Motion>,
}

/// The last detections of a track.
struct Motion {
    /// Corners, newest first.
    observed: [[f64; 4]; MAX_OBSERVATIONS],
    /// Frames since each detection.
    ages: [u32; MAX_OBSERVATIONS],
    count: usize,
    expected: [f64; 4],
}

impl Learner for CBiou {
    const SPEC: Spec = Spec::new("c_biou", Task::ObjectTracking2d).class("CBiouLearner").about(
        "C-BIoU tracks the detections of any detector by the overlap of enlarged boxes, also through sudden motion.",
    );
    type Params = CBiouParams;
    type Input<'a> = TrackerInputs<'a>;
    type Target = TrackingAnnotationList;
    type State = CBiouState;

    fn load(_: &Model, params: CBiouParams, _: Device) -> Result<Self> {
        Ok(Self::with_params(params))
    }

    fn params(&self) -> &CBiouParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut CBiouParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut CBiouState,
        input: TrackerInputs<'_>,
        target: &mut TrackingAnnotationList,
    ) -> Result<()> {
        state.update(&self.params, &input)?;
        state.tracks.write(&input, target);
        Ok(())
    }
}

impl CBiou {
    /// Creates a tracker; there are no weights to load.
    pub const fn with_params(params: CBiouParams) -> Self {
        Self { params }
    }
}

impl CBiouState {
    /// Returns the number of tracks, including those without a detection in the last frame.
    pub fn track_count(&self) -> usize {
        self.tracks.list.len()
    }

    fn update(&mut self, params: &CBiouParams, input: &TrackerInputs<'_>) -> Result<()> {
        let rules = Rules { min_hits: params.min_hits, per_class: params.per_class };
        let window = params.motion_window as usize;
        let predict =
            |motion: &mut Motion, _: u32, camera: Option<&SimilarityMotion>| motion.predict(window, camera);
        self.tracks.begin_frame(input, f64::from(params.threshold), predict)?;
        for buffer in [params.small_buffer, params.large_buffer] {
            let gain = |track: &Track<Motion>, found: &ValidBox| {
                let overlap = buffered_iou(track.motion.expected, found.corners, f64::from(buffer));
                (overlap >= f64::from(params.iou_threshold)).then_some(overlap)
            };
            self.tracks.associate(rules, input, |_| true, gain, Motion::update);
        }
        self.tracks.list.retain(|track| track.life.away <= params.max_age);
        self.tracks.start(rules, input, |found| Some(Motion::new(found)));
        Ok(())
    }
}

impl Motion {
    fn new(found: &ValidBox) -> Self {
        let mut observed = [[0.0; 4]; MAX_OBSERVATIONS];
        observed[0] = found.corners;
        Self { observed, ages: [0; MAX_OBSERVATIONS], count: 1, expected: found.corners }
    }

    /// Extrapolates the mean motion of the last `window` detections to this frame.
    fn predict(&mut self, window: usize, camera: Option<&SimilarityMotion>) {
        for (corners, age) in self.observed.iter_mut().zip(&mut self.ages).take(self.count) {
            *age = age.saturating_add(1);
            if let Some(camera) = camera {
                *corners = camera.map_box(*corners);
            }
        }
        let last = self.observed[0];
        let first = self.count.min(window).max(1) - 1;
        let span = self.ages[first] - self.ages[0];
        self.expected = last;
        if span > 0 {
            let steps = f64::from(self.ages[0]) / f64::from(span);
            let moved: [f64; 4] =
                std::array::from_fn(|at| last[at] + (last[at] - self.observed[first][at]) * steps);
            // A box that shrinks has no area after a few frames.
            if moved[2] > moved[0] && moved[3] > moved[1] {
                self.expected = moved;
            }
        }
    }

    fn update(&mut self, found: &ValidBox, _: u32) {
        self.observed.rotate_right(1);
        self.ages.rotate_right(1);
        (self.observed[0], self.ages[0]) = (found.corners, 0);
        self.count = (self.count + 1).min(MAX_OBSERVATIONS);
    }
}

/// Returns the IoU of two boxes that are enlarged on each side by a fraction of their width and height.
fn buffered_iou(one: [f64; 4], other: [f64; 4], buffer: f64) -> f64 {
    box_iou(enlarged(one, buffer), enlarged(other, buffer))
}

fn enlarged([x0, y0, x1, y1]: [f64; 4], buffer: f64) -> [f64; 4] {
    let (width, height) = (buffer * (x1 - x0), buffer * (y1 - y0));
    [x0 - width, y0 - height, x1 + width, y1 + height]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(x: f64, side: f64) -> ValidBox {
        ValidBox { corners: [x, 0.0, x + side, side], confidence: 1.0, index: 0 }
    }

    /// Boxes of 10 that are 2 apart do not overlap; enlarged by 0.3 they are boxes of 16 that share 4 x 16 pixels.
    #[test]
    fn enlarged_boxes_overlap_before_the_boxes_do() {
        let (one, other) = (found(0.0, 10.0).corners, found(12.0, 10.0).corners);
        assert_eq!(buffered_iou(one, other, 0.0), 0.0);
        let expected = 64.0 / (2.0 * 256.0 - 64.0);
        assert!((buffered_iou(one, other, 0.3) - expected).abs() < 1e-12);
    }

    #[test]
    fn motion_is_the_mean_of_the_window() {
        let mut motion = Motion::new(&found(0.0, 10.0));
        for x in [4.0, 6.0, 8.0] {
            motion.predict(3, None);
            motion.update(&found(x, 10.0), 1);
        }
        motion.predict(3, None);
        assert_eq!(motion.expected, [10.0, 0.0, 20.0, 10.0]);
        motion.predict(3, None);
        assert_eq!(motion.expected[0], 12.0);
        motion.predict(1, None);
        assert_eq!(motion.expected[0], 8.0);
    }

    #[test]
    fn a_shrinking_box_keeps_its_last_size() {
        let mut motion = Motion::new(&found(0.0, 10.0));
        motion.predict(2, None);
        motion.update(&found(0.0, 4.0), 1);
        motion.predict(2, None);
        assert_eq!(motion.expected, [0.0, 0.0, 4.0, 4.0]);
    }
}
