//! Active perception: the recommended movement of a target, as `opendr_msgs/ViewAction`.

use opendr_engine::target::Action;
use opendr_engine::{Header, Result};
use opendr_messages::opendr_msgs::ViewAction;

use crate::message_from_header;

/// Returns the message of a movement.
///
/// # Errors
/// `InvalidInput` for a stamp that ROS cannot hold.
pub fn view_action(action: &Action, header: &Header) -> Result<ViewAction> {
    Ok(ViewAction { header: message_from_header(header)?, axes: (*action).into() })
}
