//! The learner, for whatever it recognises.

use std::marker::PhantomData;

use opendr_engine::data::{Image, Observation};
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::rig::ViewPose;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result};

use super::container::ActiveContainer;
use super::kind::ActiveKind;
use super::params::ActiveParams;
use super::state::ActiveState;

/// Input of [`ActiveLearner`].
#[derive(Inputs)]
pub struct ActiveInput<'a> {
    /// Image of the camera.
    pub image: &'a Image,
    /// Pose of the camera: azimuth (rad), elevation (rad), distance. Without it, the proposed motions are assumed to have been
    /// carried out.
    pub pose: Option<&'a Observation>,
}

/// A learner of active perception.
///
/// Each call adds a view of the subject to the belief of the stream. The target is the most likely class, with its probability
/// after all views and, as long as a further view is worthwhile, the motion to it. A target without an action is the last
/// one; the next image begins with another subject.
pub struct ActiveLearner<K> {
    container: ActiveContainer,
    classes: Classes,
    params: ActiveParams,
    kind: PhantomData<K>,
}

impl<K: ActiveKind> Learner for ActiveLearner<K> {
    const SPEC: Spec = K::SPEC;
    type Params = ActiveParams;
    type Input<'a> = ActiveInput<'a>;
    type Target = Category;
    type State = ActiveState;

    fn load(model: &Model, params: ActiveParams, device: Device) -> Result<Self> {
        if !matches!(device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "{} runs on the CPU, not on {device}; set the device to \"cpu\" or \"auto\"",
                K::SPEC.class
            )));
        }
        let container = ActiveContainer::read(model)?;
        Ok(Self { container, classes: model.classes().clone(), params, kind: PhantomData })
    }

    fn params(&self) -> &ActiveParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ActiveParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(
        &self,
        state: &mut ActiveState,
        input: ActiveInput<'_>,
        target: &mut Category,
    ) -> Result<()> {
        let pose = input.pose.map(view_pose).transpose()?;
        let decision =
            state.add(&self.container, input.image, pose, &self.params.stop(), &mut target.probabilities)?;
        target.class = decision.class as i64;
        target.description = self.classes.name(target.class).cloned();
        target.confidence = Some(decision.confidence);
        target.action = decision.action;
        Ok(())
    }
}

/// Returns the pose of three numbers.
fn view_pose(observation: &Observation) -> Result<ViewPose> {
    match *observation.as_slice() {
        [azimuth, elevation, distance, ..]
            if [azimuth, elevation, distance].iter().all(|part| part.is_finite()) =>
        {
            let [azimuth, elevation, distance] = [azimuth, elevation, distance].map(f64::from);
            Ok(ViewPose { azimuth, elevation, distance, fourth: 0.0 })
        }
        _ => Err(Error::invalid_input(format!(
            "a pose of {} numbers; give azimuth (rad), elevation (rad) and distance, all finite",
            observation.as_slice().len()
        ))),
    }
}
