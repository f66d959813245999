//! Files of the TUM RGB-D benchmark (J. Sturm et al., A benchmark for the evaluation of RGB-D SLAM systems, 2012): a line
//! `time x y z qx qy qz qw` for each pose, `#` before comments.

use std::fmt::Write as _;

use opendr_engine::{Error, Result};

use super::{Stamped, Trajectory};
use crate::geometry::Pose;

impl Trajectory {
    /// Reads a trajectory in TUM's format.
    ///
    /// # Errors
    /// `Format` with the number of the line that does not have eight finite numbers, whose quaternion is zero, or whose time is not
    /// after the one before.
    pub fn from_tum(text: &str) -> Result<Self> {
        let mut poses: Vec<Stamped> = Vec::new();
        for (line, number) in text.lines().zip(1..).filter(|(line, _)| !is_comment(line)) {
            let [time, x, y, z, quaternion @ ..] = numbers::<8>(line, number)?;
            if quaternion.iter().map(|part: &f64| part * part).sum::<f64>() < 1e-12 {
                return Err(Error::format(format!(
                    "line {number}: the quaternion is zero; write qx qy qz qw of length 1"
                )));
            }
            if poses.last().is_some_and(|last| last.time >= time) {
                return Err(Error::format(format!(
                    "line {number}: time {time} is not after the line before; sort the file by time"
                )));
            }
            poses.push(Stamped { time, pose: Pose::from_quaternion([x, y, z], quaternion) });
        }
        Self::new(poses)
    }

    /// Writes the trajectory in TUM's format; a number read back is the same.
    pub fn to_tum(&self) -> String {
        let mut text = String::from("# time x y z qx qy qz qw\n");
        for Stamped { time, pose } in self.poses() {
            let _ = write!(text, "{time}");
            for part in pose.position.iter().chain(&pose.quaternion()) {
                let _ = write!(text, " {part}");
            }
            text.push('\n');
        }
        text
    }
}

pub(super) fn is_comment(line: &str) -> bool {
    let line = line.trim();
    line.is_empty() || line.starts_with('#')
}

/// Reads the numbers of a line.
pub(super) fn numbers<const N: usize>(line: &str, number: usize) -> Result<[f64; N]> {
    let mut found = [0.0; N];
    let mut words = line.split([' ', '\t', ',']).filter(|word| !word.is_empty());
    for place in &mut found {
        let word = words.next().unwrap_or_default();
        *place = word.trim().parse().ok().filter(|value: &f64| value.abs() < 1e15).ok_or_else(|| {
            let word: String = word.chars().take(30).collect();
            Error::format(format!("line {number}: \"{word}\" is not a finite number; a line has {N} numbers"))
        })?;
    }
    match words.next() {
        None => Ok(found),
        Some(_) => Err(Error::format(format!("line {number} has more than {N} numbers"))),
    }
}
