//! Falls by a rule on poses over time.
//!
//! After OpenDR's learner of this name: a person has fallen when the body lies ([`Posture`]). A pose estimator detects and
//! tracks the persons. The first posture of a person is valid at once; another replaces it after `hold` seconds, so a
//! single wrong pose neither raises nor ends an alarm.

mod params;
mod pose_finder;
mod verdicts;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec, Targets};
use opendr_engine::model::Model;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, PoseList};
use opendr_engine::{Device, Result, Task};

pub use self::params::FallDetectorParams;
use self::pose_finder::{PoseFinder, PoseFinderState};
use self::verdicts::Verdicts;
use super::Posture;

/// Predictions for an image.
#[derive(Default, Targets)]
pub struct FallDetectorTargets {
    /// A box around each person: class 0 for an unknown posture, 1 for a fall, 2 for none.
    pub falls: BoundingBoxList,
    /// Poses of the persons, in the order of the boxes.
    pub poses: PoseList,
}

/// A loaded fall detector.
pub struct FallDetector {
    params: FallDetectorParams,
    poses: PoseFinder,
    classes: Classes,
}

/// State of a stream: its persons and their postures.
#[derive(Default)]
pub struct FallDetectorState {
    poses: PoseFinderState,
    verdicts: Verdicts,
}

impl Learner for FallDetector {
    const SPEC: Spec = Spec::new("fall_detector", Task::FallDetection)
        .class("FallDetectorLearner")
        .about("Detects fallen persons by a rule on their poses over time.")
        .without_effect(&[("pose_estimator", "the model contains its own")]);
    type Params = FallDetectorParams;
    type Input<'a> = &'a Image;
    type Target = FallDetectorTargets;
    type State = FallDetectorState;

    fn load(model: &Model, params: FallDetectorParams, device: Device) -> Result<Self> {
        let poses = PoseFinder::load(model, &params, device)?;
        let postures = [Posture::Unknown, Posture::Fallen, Posture::Upright];
        let classes = postures.iter().map(|posture| posture.name()).collect();
        Ok(Self { params, poses, classes })
    }

    fn params(&self) -> &FallDetectorParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut FallDetectorParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(
        &self,
        state: &mut FallDetectorState,
        image: &Image,
        target: &mut FallDetectorTargets,
    ) -> Result<()> {
        let FallDetectorTargets { falls, poses } = target;
        self.poses.follow(&self.params, &mut state.poses, image, poses)?;
        state.verdicts.begin_frame(&image.header);
        falls.boxes.clear();
        falls.classes.clone_from(&self.classes);
        for pose in &poses.poses {
            let observed = Posture::of(pose);
            let posture =
                pose.id.map_or(observed, |id| state.verdicts.update_posture(id, observed, self.params.hold));
            let [left, top, width, height] = pose.bounding_box().unwrap_or_default();
            let person = BoundingBox::new(class_of(posture), left, top, width, height, pose.confidence);
            falls.boxes.push(person);
        }
        state.verdicts.end_frame();
        Ok(())
    }
}

fn class_of(posture: Posture) -> i64 {
    match posture {
        Posture::Unknown => 0,
        Posture::Fallen => 1,
        Posture::Upright => 2,
    }
}
