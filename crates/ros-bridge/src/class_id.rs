//! Class ids in messages, whose text is a name or an index.

use opendr_engine::target::{Classes, Name};
use opendr_engine::{Header, Result};
use opendr_messages::vision_msgs;

use crate::message_from_header;

opendr_engine::choices! {
    /// Form of `class_id` fields.
    pub enum ClassIds {
        /// Name of the class (`person`), or its index without a name.
        Names = "names",
        /// Index of the class (`0`), as in OpenDR's nodes; a message `LabelInfo` contains the names.
        Numbers = "numbers",
    }
}

impl ClassIds {
    /// Returns the text of a class.
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

/// Returns the class of a text, which is an index if the text is a number.
pub(crate) fn name_from_class_id(class_id: &str) -> Name {
    match class_id.parse::<i64>() {
        Ok(number) => Name::Index(number),
        Err(_) => Name::Label(class_id.into()),
    }
}

/// Returns the message of vision_msgs with the names of the classes. Class indices above 65,535 do not fit and are omitted.
///
/// # Errors
/// `InvalidInput` for a stamp that ROS cannot hold.
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
