//! Files of KITTI's odometry benchmark (A. Geiger, P. Lenz and R. Urtasun, Are we ready for autonomous driving?, 2012): a line of the
//! twelve numbers of `[rotation | position]`, row by row, for each pose.

use std::fmt::Write as _;

use opendr_engine::{Error, Result};

use super::tum::{is_comment, numbers};
use super::{Stamped, Trajectory};
use crate::geometry::{Pose, length};

impl Trajectory {
    /// Reads a trajectory in KITTI's format. Its poses have no times: they are `rate` per second.
    ///
    /// # Errors
    /// `Format` with the number of the line that does not have twelve finite numbers or no rotation matrix (to 1 %); `InvalidParam`
    /// for a rate that is not positive.
    pub fn from_kitti(text: &str, rate: f64) -> Result<Self> {
        if !(1e-6..=1e6).contains(&rate) {
            return Err(Error::invalid_param(format!("the rate is {rate}; give poses per second, e.g. 10")));
        }
        let mut poses = Vec::new();
        for (line, number) in text.lines().zip(1..).filter(|(line, _)| !is_comment(line)) {
            let values = numbers::<12>(line, number)?;
            let rows: [[f64; 4]; 3] =
                std::array::from_fn(|row| std::array::from_fn(|at| values[4 * row + at]));
            let pose = Pose::from_rows(rows);
            let differs =
                pose.rows().as_flattened().iter().zip(&values).any(|(own, read)| (own - read).abs() > 0.01);
            let is_unit = |row: [f64; 3]| (length(row) - 1.0).abs() < 0.01;
            if differs || !pose.rotation.into_iter().all(is_unit) {
                return Err(Error::format(format!(
                    "line {number}: the first three columns are no rotation matrix"
                )));
            }
            poses.push(Stamped { time: poses.len() as f64 / rate, pose });
        }
        Self::new(poses)
    }

    /// Writes the trajectory in KITTI's format, without its times.
    pub fn to_kitti(&self) -> String {
        let mut text = String::new();
        for stamped in self.poses() {
            let rows = stamped.pose.rows();
            let numbers = rows.as_flattened().iter().enumerate();
            for (at, part) in numbers {
                let _ = write!(text, "{}{part:e}", if at > 0 { " " } else { "" });
            }
            text.push('\n');
        }
        text
    }
}
