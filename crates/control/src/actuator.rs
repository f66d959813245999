//! How the command of a feedback law becomes an action.

use opendr_engine::{Error, Result};

/// What carries out the commands of a feedback law on an observation.
#[derive(Debug, Clone, PartialEq)]
pub enum Actuator {
    /// Numbers: the command of each axis, within plus or minus its limit.
    Limited(Vec<f64>),
    /// A choice: the command that each choice of the action space stands for, counted from 0. The choice nearest to the command of
    /// the only axis is the action.
    Levels(Vec<f64>),
}

impl Actuator {
    /// Checks limits and levels.
    ///
    /// # Errors
    /// `InvalidParam` for limits that are not positive, fewer than two levels, and numbers that are not finite.
    pub fn check(&self) -> Result<()> {
        match self {
            Self::Limited(limits)
                if !limits.is_empty() && limits.iter().all(|limit| *limit > 0.0 && limit.is_finite()) =>
            {
                Ok(())
            }
            Self::Limited(limits) => Err(Error::invalid_param(format!(
                "limits {limits:?} of a command; give a positive number for each axis"
            ))),
            Self::Levels(levels) if levels.len() >= 2 && levels.iter().all(|level| level.is_finite()) => {
                Ok(())
            }
            Self::Levels(levels) => Err(Error::invalid_param(format!(
                "levels {levels:?} of a command; give the command of each choice, at least two"
            ))),
        }
    }

    /// Returns the number of axes of a command.
    pub fn axes(&self) -> usize {
        match self {
            Self::Limited(limits) => limits.len(),
            Self::Levels(_) => 1,
        }
    }

    /// Returns the largest magnitude of the command of each axis.
    pub fn limits(&self) -> Vec<f64> {
        match self {
            Self::Limited(limits) => limits.clone(),
            Self::Levels(levels) => vec![levels.iter().fold(0.0, |most, level| level.abs().max(most))],
        }
    }

    /// Writes the action of a command.
    ///
    /// # Errors
    /// `InvalidInput` for an action of another length, and for a command that is not finite.
    pub fn act(&self, command: &[f64], action: &mut [f32]) -> Result<()> {
        if (command.len(), action.len()) != (self.axes(), self.axes()) {
            return Err(Error::invalid_input(format!(
                "an action of {} numbers for a command of {} axes; use a controller of this action space",
                action.len(),
                command.len()
            )));
        }
        if let Some(number) = command.iter().find(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "the command is {number}: the observation has numbers that are not finite"
            )));
        }
        match self {
            Self::Limited(limits) => {
                for (action, (command, limit)) in action.iter_mut().zip(command.iter().zip(limits)) {
                    *action = command.clamp(-limit, *limit) as f32;
                }
            }
            Self::Levels(levels) => {
                let off = |choice: usize| (levels[choice] - command[0]).abs();
                let nearest =
                    (1..levels.len()).fold(0, |best, at| if off(at) < off(best) { at } else { best });
                action[0] = nearest as f32;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_become_actions() {
        let limited = Actuator::Limited(vec![2.0, 0.5]);
        limited.check().unwrap();
        let mut action = [0.0; 2];
        limited.act(&[-3.0, 0.25], &mut action).unwrap();
        assert_eq!(action, [-2.0, 0.25]);
        assert!(limited.act(&[0.0, f64::NAN], &mut action).is_err());
        assert!(limited.act(&[0.0, 0.0], &mut action[..1]).is_err());
        let levels = Actuator::Levels(vec![-10.0, 0.0, 10.0]);
        for (command, choice) in [(-99.0, 0.0), (-5.1, 0.0), (4.9, 1.0), (5.1, 2.0)] {
            levels.act(&[command], &mut action[..1]).unwrap();
            assert_eq!(action[0], choice, "{command}");
        }
        assert_eq!(levels.limits(), [10.0]);
        for refused in [
            Actuator::Limited(vec![]),
            Actuator::Limited(vec![1.0, 0.0]),
            Actuator::Limited(vec![f64::INFINITY]),
            Actuator::Levels(vec![1.0]),
            Actuator::Levels(vec![1.0, f64::NAN]),
        ] {
            assert!(refused.check().is_err(), "{refused:?}");
        }
    }
}
