//! Odometry: `nav_msgs/Odometry`.

use opendr_engine::Result;
use opendr_engine::target::{Odometry, RigidPose};
use opendr_messages::{geometry_msgs, nav_msgs};

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Frame of the first image.
const WORLD: &str = "odom";
/// Ending of the frame id of a camera whose z axis points ahead, and of the same camera whose x axis does (REP 103).
const OPTICAL: [&str; 2] = ["_optical_frame", "_frame"];
/// Variance of an unknown pose, m² and rad².
const UNKNOWN: f64 = 9999.0;
/// Lengths of a quaternion that are not 0.
const SHORTEST: f64 = 1e-6;

/// The pose with the axes of REP 103: x ahead, y to the left, z up. An unknown pose has an orientation of zeros and a variance of 9999. The
/// number of landmarks is not in the message; the twist is unknown.
impl FromToMessage<nav_msgs::Odometry> for Odometry {
    fn from_message(message: nav_msgs::Odometry, _: &RosBridge) -> Result<Self> {
        let geometry_msgs::Pose { position, orientation } = message.pose.pose;
        let quaternion = [-orientation.y, -orientation.z, orientation.x, orientation.w];
        let length = quaternion.iter().map(|part| part * part).sum::<f64>().sqrt();
        let position = [-position.y, -position.z, position.x];
        let is_known =
            length > SHORTEST && length.is_finite() && position.iter().all(|part| part.is_finite());
        let mut header = message.header;
        header.frame_id = message.child_frame_id;
        let pose =
            is_known.then(|| RigidPose { position, orientation: quaternion.map(|part| part / length) });
        Ok(Self { header: header_from_message(&header), pose, ..Self::default() })
    }

    fn to_message(&self, _: &RosBridge) -> Result<nav_msgs::Odometry> {
        let mut header = message_from_header(&self.header)?;
        let camera = std::mem::replace(&mut header.frame_id, WORLD.to_owned());
        let child_frame_id = match camera.strip_suffix(OPTICAL[0]) {
            Some(name) => format!("{name}{}", OPTICAL[1]),
            None => camera,
        };
        let mut message = nav_msgs::Odometry { header, child_frame_id, ..Default::default() };
        let pose = &mut message.pose;
        match self.pose {
            Some(RigidPose { position: [x, y, z], orientation: [qx, qy, qz, qw] }) => {
                pose.pose.position = geometry_msgs::Point { x: z, y: -x, z: -y };
                pose.pose.orientation = geometry_msgs::Quaternion { x: qz, y: -qx, z: -qy, w: qw };
            }
            None => {
                pose.pose.orientation = geometry_msgs::Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 0.0 };
                set_unknown(&mut pose.covariance);
            }
        }
        set_unknown(&mut message.twist.covariance);
        Ok(message)
    }
}

fn set_unknown(covariance: &mut [f64; 36]) {
    covariance.iter_mut().step_by(7).for_each(|variance| *variance = UNKNOWN);
}
