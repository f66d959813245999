//! Classes in messages: vision_msgs has one text, a network a number, a robot's user a name.

use opendr_engine::target::{Classes, Name};
use opendr_engine::{Header, Result};
use opendr_messages::vision_msgs;

use crate::message_from_header;

opendr_engine::choices! {
    /// How classes are told in `class_id` fields.
    pub enum ClassIds {
        /// By name where the learner knows one (`person`), by number otherwise.
        Names = "names",
        /// By number (`0`), as OpenDR's nodes did; a message `LabelInfo` says what they mean.
        Numbers = "numbers",
    }
}

impl ClassIds {
    /// The text of a class.
    pub(crate) fn class_id(self, name: &Name, classes: &Classes) -> String {
        match (self, name) {
            (Self::Names, name) => match classes.label(name) {
                Some(label) => label.to_owned(),
                None => name.to_string(),
            },
            (Self::Numbers, Name::Label(label)) => match classes.index(label) {
                Some(index) => index.to_string(),
                None => label.to_string(),
            },
            (Self::Numbers, Name::Index(_)) => name.to_string(),
        }
    }
}

/// The class of a text: a number where it is one.
pub(crate) fn name_from_class_id(class_id: &str) -> Name {
    match class_id.parse::<i64>() {
        Ok(number) => Name::Index(number),
        Err(_) => Name::Label(class_id.into()),
    }
}

/// What class numbers mean, as vision_msgs tells it beside its detections.
///
/// # Errors
/// `InvalidInput` for a stamp that ROS cannot hold. Classes beyond 65,535 have no number there and are left out.
pub fn label_info(classes: &Classes, header: &Header, threshold: f32) -> Result<vision_msgs::LabelInfo> {
    let class_map = classes
        .iter()
        .zip(0_u16..=u16::MAX)
        .map(|(name, class_id)| vision_msgs::VisionClass { class_id, class_name: name.to_owned() });
    Ok(vision_msgs::LabelInfo {
        header: message_from_header(header)?,
        class_map: class_map.collect(),
        threshold,
    })
}
