//! Speech commands: `vision_msgs/Classification`, as in OpenDR's nodes.

use opendr_engine::target::{Classes, SpeechCommand};
use opendr_engine::{Error, Result};
use opendr_messages::vision_msgs::{Classification, ObjectHypothesis};

use crate::class_id::{ClassIds, name_from_class_id};
use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Word or index with its score. Start and end within the audio are not in the message.
impl FromToMessage<Classification> for SpeechCommand {
    fn from_message(message: Classification, _: &RosBridge) -> Result<Self> {
        let first = message.results.first();
        let first = first.ok_or_else(|| Error::format("the classification has no result"))?;
        let command = Self::new(name_from_class_id(&first.class_id), first.score as f32);
        Ok(Self { header: header_from_message(&message.header), ..command })
    }

    fn to_message(&self, _: &RosBridge) -> Result<Classification> {
        let class_id = ClassIds::Names.class_id(&self.command, &Classes::default());
        let results = vec![ObjectHypothesis { class_id, score: f64::from(self.confidence) }];
        Ok(Classification { header: message_from_header(&self.header)?, results })
    }
}
