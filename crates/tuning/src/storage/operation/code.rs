//! Optuna's codes of directions and states.

use opendr_engine::{Error, Result};
use serde_json::Value;

use crate::records::{Direction, TrialState};

pub fn direction_from_json(code: &Value) -> Result<Direction> {
    match code.as_i64() {
        // 0 is "not set" in Optuna: minimise.
        Some(0 | 1) => Ok(Direction::Minimize),
        Some(2) => Ok(Direction::Maximize),
        _ => Err(Error::format(format!("{code} is not a direction; 1 is minimise, 2 maximise"))),
    }
}

pub fn code_from_direction(direction: Direction) -> i64 {
    match direction {
        Direction::Minimize => 1,
        Direction::Maximize => 2,
    }
}

pub fn state_from_code(code: i64) -> Result<TrialState> {
    Ok(match code {
        0 => TrialState::Running,
        1 => TrialState::Complete,
        2 => TrialState::Pruned,
        3 => TrialState::Failed,
        4 => TrialState::Waiting,
        _ => return Err(Error::format(format!("{code} is not a state of a trial; states are 0 to 4"))),
    })
}

pub fn code_from_state(state: TrialState) -> i64 {
    match state {
        TrialState::Running => 0,
        TrialState::Complete => 1,
        TrialState::Pruned => 2,
        TrialState::Failed => 3,
        TrialState::Waiting => 4,
    }
}
