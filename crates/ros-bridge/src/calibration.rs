//! Calibrations: `opendr_msgs/Calibration`, `sensor_msgs/CameraInfo`.

use opendr_engine::data::Calibration;
use opendr_engine::{Error, Result};
use opendr_messages::{opendr_msgs, sensor_msgs};

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// The three matrices in row-major order.
impl FromToMessage<opendr_msgs::Calibration> for Calibration {
    fn from_message(message: opendr_msgs::Calibration, _: &RosBridge) -> Result<Self> {
        let all = message.p2.iter().chain(&message.r0_rect).chain(&message.tr_velo_to_cam);
        check_finite(all)?;
        Ok(Self {
            header: header_from_message(&message.header),
            p2: rows(&message.p2),
            r0_rect: rows(&message.r0_rect),
            tr_velo_to_cam: rows(&message.tr_velo_to_cam),
        })
    }

    fn to_message(&self, _: &RosBridge) -> Result<opendr_msgs::Calibration> {
        Ok(opendr_msgs::Calibration {
            header: message_from_header(&self.header)?,
            p2: flat(&self.p2),
            r0_rect: flat(&self.r0_rect),
            tr_velo_to_cam: flat(&self.tr_velo_to_cam),
        })
    }
}

/// Projection and rectification of a camera; the lidar is assumed to be in the camera's frame, and its pose is not written.
impl FromToMessage<sensor_msgs::CameraInfo> for Calibration {
    fn from_message(message: sensor_msgs::CameraInfo, _: &RosBridge) -> Result<Self> {
        check_finite(message.p.iter().chain(&message.r))?;
        if message.p[0] == 0.0 || message.p[5] == 0.0 {
            return Err(Error::format("the camera is not calibrated: its focal length is 0"));
        }
        Ok(Self {
            header: header_from_message(&message.header),
            p2: rows(&message.p),
            r0_rect: rows(&message.r),
            tr_velo_to_cam: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
        })
    }

    fn to_message(&self, _: &RosBridge) -> Result<sensor_msgs::CameraInfo> {
        let [[fx, _, cx, _], [_, fy, cy, _], _] = self.p2;
        Ok(sensor_msgs::CameraInfo {
            header: message_from_header(&self.header)?,
            k: [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
            r: flat(&self.r0_rect),
            p: flat(&self.p2),
            ..Default::default()
        })
    }
}

fn check_finite<'a>(mut numbers: impl Iterator<Item = &'a f64>) -> Result<()> {
    match numbers.find(|number| !number.is_finite()) {
        Some(number) => Err(Error::format(format!("a matrix of the calibration contains {number}"))),
        None => Ok(()),
    }
}

fn rows<const C: usize, const N: usize>(numbers: &[f64; N]) -> [[f64; C]; 3] {
    let mut rows = [[0.0; C]; 3];
    for (row, numbers) in rows.iter_mut().zip(numbers.chunks_exact(C)) {
        row.copy_from_slice(numbers);
    }
    rows
}

fn flat<const C: usize, const N: usize>(rows: &[[f64; C]; 3]) -> [f64; N] {
    let mut numbers = [0.0; N];
    for (place, number) in numbers.iter_mut().zip(rows.as_flattened()) {
        *place = *number;
    }
    numbers
}
