//! Poses of one picture after the other as moving skeletons.

use opendr_actions::skeleton_based_action_recognition::{SkeletonBuffer, SkeletonBufferOptions};
use opendr_engine::model::Model;
use opendr_engine::target::Skeleton;
use opendr_engine::{Error, Result, Value};

use super::adapter::Adapter;

/// A [`SkeletonBuffer`] of the joints, frames and persons that a model says it looks at.
pub(super) struct Skeletons(SkeletonBuffer);

impl Skeletons {
    /// For `model`, whose `inputs.skeleton_sequence` names skeleton, frames and persons.
    ///
    /// # Errors
    /// `InvalidParam` where it does not.
    pub fn make(model: &Model) -> Result<Box<dyn Adapter>> {
        let input = model.manifest().inputs.get("skeleton_sequence");
        let text = |key: &str| input?.get(key)?.as_str();
        let count = |key: &str| input?.get(key)?.as_u64().and_then(|count| usize::try_from(count).ok());
        let named = |name: &str| Skeleton::ALL.iter().find(|skeleton| skeleton.name() == name).copied();
        let (Some(skeleton), Some(frames), Some(persons)) =
            (text("skeleton").and_then(named), count("frames"), count("persons"))
        else {
            return Err(Error::invalid_param(format!(
                "the model {} does not say which skeletons it takes: name skeleton, frames and persons under \
                 inputs.skeleton_sequence of its model.json, or train it again",
                model.path().display()
            )));
        };
        let options = SkeletonBufferOptions { skeleton, frames, persons, ..Default::default() };
        Ok(Box::new(Self(SkeletonBuffer::new(options)?)))
    }
}

impl Adapter for Skeletons {
    fn adapt(&mut self, answer: &Value) -> Result<Option<Value>> {
        let Value::PoseList(poses) = answer else {
            return Err(Error::internal("skeletons are made of poses"));
        };
        self.0.push(poses)?;
        let sequence = self.0.together()?;
        Ok(sequence.map(|sequence| sequence.with_header(poses.header.clone()).into()))
    }

    fn reset(&mut self) {
        self.0.clear();
    }
}
