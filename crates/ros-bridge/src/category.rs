//! Classes of whole images and audio: `vision_msgs/Classification` (ROS 1: `Classification2D`).

use opendr_engine::target::{Category, Classes, Name};
use opendr_engine::{Error, Result};
use opendr_messages::vision_msgs::{Classification, ObjectHypothesis};

use crate::class_id::{ClassIds, name_from_class_id};
use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// The predicted class first, by description or index, then the scores of all classes by index, if the learner predicts them.
impl FromToMessage<Classification> for Category {
    fn from_message(message: Classification, _: &RosBridge) -> Result<Self> {
        let [first, all @ ..] = &message.results[..] else {
            return Err(Error::format("the classification has no result"));
        };
        let mut probabilities = Vec::with_capacity(all.len());
        for (index, result) in all.iter().enumerate() {
            if result.class_id != index.to_string() {
                return Err(Error::format(format!(
                    "result {} of the classification has class {:?}; after the first there must be one per class, by index",
                    index + 1,
                    result.class_id
                )));
            }
            probabilities.push(result.score as f32);
        }
        let score = first.score as f32;
        let (class, description) = match name_from_class_id(&first.class_id) {
            Name::Index(class) => (class, None),
            Name::Label(label) => {
                let same = probabilities.iter().position(|other| *other == score);
                (same.map_or(-1, |class| class as i64), Some(label))
            }
        };
        // NaN stands for no score.
        let confidence = (!score.is_nan()).then_some(score);
        let header = header_from_message(&message.header);
        Ok(Self { header, description, probabilities, ..Self::new(class, confidence) })
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<Classification> {
        let class_id = match &self.description {
            Some(description) if bridge.class_ids == ClassIds::Names => description.to_string(),
            _ => self.class.to_string(),
        };
        let score = self.confidence.map_or(f64::NAN, f64::from);
        let mut results = vec![ObjectHypothesis { class_id, score }];
        results.extend(self.probabilities.iter().enumerate().map(|(class, score)| {
            let class_id = ClassIds::Numbers.class_id(&Name::Index(class as i64), &Classes::default());
            ObjectHypothesis { class_id, score: f64::from(*score) }
        }));
        Ok(Classification { header: message_from_header(&self.header)?, results })
    }
}
