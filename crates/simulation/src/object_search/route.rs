//! Driving along a path.

use super::grid::{distance, middle};
use super::{CONTROL_PERIOD, SPEED, TURN_RATE};
use crate::arctangent::{arctangent2, wrapped};

/// A path, and where to look at its end.
#[derive(Debug, Clone, Default)]
pub(super) struct Route {
    pub path: Vec<usize>,
    at: usize,
    /// Place to look at from the end.
    look: [f64; 2],
}

/// Distances at which a cell of the path is passed and the last one is reached, metres. What can be seen from the last cell may be
/// hidden from beside it.
const PASSED: f64 = 0.25;
const REACHED: f64 = 0.03;
/// Angle at which the robot looks at a place, and up to which it drives while it turns, radians.
const ALIGNED: f64 = 0.15;
const DRIVING: f64 = 0.4;

impl Route {
    /// Begins at the first cell of the path.
    pub fn begin(&mut self, look: [f64; 2]) {
        (self.at, self.look) = (0, look);
    }

    /// Returns the cells that are still ahead.
    pub fn ahead(&self) -> &[usize] {
        self.path.get(self.at..).unwrap_or_default()
    }

    /// Returns shares of the largest speed and turn rate; none at the end, looking at the place.
    pub fn command(&mut self, [x, y, yaw]: [f64; 3]) -> Option<[f64; 2]> {
        while let [cell, behind @ ..] = self.ahead()
            && distance(middle(*cell), [x, y]) < if behind.is_empty() { REACHED } else { PASSED }
        {
            self.at += 1;
        }
        let next = self.ahead().first().map(|cell| middle(*cell));
        let [to_x, to_y] = next.unwrap_or(self.look);
        let error = wrapped(arctangent2(to_y - y, to_x - x) - yaw);
        if next.is_none() && error.abs() < ALIGNED {
            return None;
        }
        let turn = (error / (TURN_RATE * CONTROL_PERIOD)).clamp(-1.0, 1.0);
        let rest = (error - turn * TURN_RATE * CONTROL_PERIOD).abs();
        let reach = match self.ahead() {
            [last] => distance(middle(*last), [x, y]) / (SPEED * CONTROL_PERIOD),
            _ => 1.0,
        };
        let speed = if next.is_some() && rest < DRIVING { reach.min(1.0) } else { 0.0 };
        Some([speed, turn])
    }
}
