//! Adapter from poses of successive images to skeleton sequences.

use opendr_actions::skeleton_based_action_recognition::{SkeletonBuffer, SkeletonBufferOptions};
use opendr_engine::model::Model;
use opendr_engine::target::Skeleton;
use opendr_engine::{Error, Result, Value};

use super::adapter::Adapter;

/// A [`SkeletonBuffer`] with the joints, frames and persons of a model.
pub(super) struct Skeletons(SkeletonBuffer);

impl Skeletons {
    /// Creates the adapter for `model`, whose `inputs.skeleton_sequence` names skeleton, frames and persons.
    ///
    /// # Errors
    /// `InvalidParam` for a model without them.
    pub fn make(model: &Model) -> Result<Box<dyn Adapter>> {
        let input = model.manifest().inputs.get("skeleton_sequence");
        let text = |key: &str| input?.get(key)?.as_str();
        let count = |key: &str| input?.get(key)?.as_u64().and_then(|count| usize::try_from(count).ok());
        let named = |name: &str| Skeleton::ALL.iter().find(|skeleton| skeleton.name() == name).copied();
        let (Some(skeleton), Some(frames), Some(persons)) =
            (text("skeleton").and_then(named), count("frames"), count("persons"))
        else {
            return Err(Error::invalid_param(format!(
                "the model {} does not describe its skeletons: name skeleton, frames and persons under \
                 inputs.skeleton_sequence of its model.json, or train it again",
                model.path().display()
            )));
        };
        let options = SkeletonBufferOptions { skeleton, frames, persons, ..Default::default() };
        Ok(Box::new(Self(SkeletonBuffer::new(options)?)))
    }
}

impl Adapter for Skeletons {
    fn adapt(&mut self, prediction: &Value) -> Result<Option<Value>> {
        let Value::PoseList(poses) = prediction else {
            return Err(Error::internal("skeleton sequences are made from poses"));
        };
        self.0.push(poses)?;
        let sequence = self.0.together()?;
        Ok(sequence.map(|sequence| sequence.with_header(poses.header.clone()).into()))
    }

    fn reset(&mut self) {
        self.0.clear();
    }
}
