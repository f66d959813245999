//! Conversion of network outputs into actions.

use opendr_engine::environment::Space;
use opendr_engine::{Error, Result};

/// Bounds of continuous actions.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    /// Lower bounds, one per axis.
    pub low: Vec<f32>,
    /// Upper bounds, one per axis.
    pub high: Vec<f32>,
}

/// The meaning of a policy network's outputs, and the distribution over actions they define.
#[derive(Debug, Clone, PartialEq)]
pub enum Head {
    /// Logits of categorical distributions.
    Categorical {
        /// Number of choices of each discrete action.
        counts: Vec<u32>,
        /// The first choice.
        start: i32,
    },
    /// Logits of this many binary actions.
    Binary(usize),
    /// Means of a Gaussian distribution; its log standard deviations are parameters of the policy. Actions are clipped to the bounds.
    Gaussian(Bounds),
    /// Means, then log standard deviations, of a Gaussian distribution; a tanh scaled to the bounds gives the action.
    SquashedGaussian(Bounds),
    /// Deterministic actions, before a tanh that is scaled to the bounds.
    Squashed(Bounds),
    /// Q-values of the choices; the highest is taken.
    Greedy {
        /// Number of choices.
        count: u32,
        /// The first choice.
        start: i32,
    },
}

/// Bounds of the log standard deviations of a squashed Gaussian distribution (Haarnoja et al., 2018).
pub(crate) const LOG_STD_BOUNDS: [f32; 2] = [-20.0, 2.0];

impl Bounds {
    /// Returns the bounds of a box, which must be finite if `finite`.
    ///
    /// # Errors
    /// `Unsupported` for another space, and for infinite bounds where they must be finite.
    pub fn of(space: &Space, finite: bool) -> Result<Self> {
        let Space::Box { low, high, .. } = space else {
            return Err(Error::unsupported(format!("the action space is {space}; this learner needs a box")));
        };
        if finite && !low.iter().chain(high).all(|bound| bound.is_finite()) {
            return Err(Error::unsupported(format!(
                "the action space is {space}; this learner needs finite bounds"
            )));
        }
        Ok(Self { low: low.clone(), high: high.clone() })
    }

    /// Scales a number in [-1, 1] to the bounds of an axis.
    pub(crate) fn stretch(&self, axis: usize, number: f32) -> f32 {
        let (low, high) = (self.low[axis], self.high[axis]);
        // Clamped because rounding may exceed the bounds.
        (low + 0.5 * (number + 1.0) * (high - low)).clamp(low, high)
    }

    /// The inverse of [`Self::stretch`].
    pub(crate) fn shrink(&self, axis: usize, number: f32) -> f32 {
        let (low, high) = (self.low[axis], self.high[axis]);
        2.0 * (number - low) / (high - low) - 1.0
    }
}

impl Head {
    /// Returns the head of on-policy methods for an action space.
    ///
    /// # Errors
    /// `Unsupported` for dictionaries and tuples.
    pub fn stochastic(space: &Space) -> Result<Self> {
        match space {
            Space::Discrete { n, start } => Ok(Self::Categorical { counts: vec![*n], start: *start }),
            Space::MultiDiscrete(counts) => Ok(Self::Categorical { counts: counts.clone(), start: 0 }),
            Space::MultiBinary(_) => Ok(Self::Binary(space.len())),
            Space::Box { .. } => Bounds::of(space, false).map(Self::Gaussian),
            _ => Err(Error::unsupported(format!(
                "no policy supports the action space {space}; use discrete, binary or box actions"
            ))),
        }
    }

    /// Returns the number of network outputs.
    pub fn outputs(&self) -> usize {
        match self {
            Self::Categorical { counts, .. } => counts.iter().map(|count| *count as usize).sum(),
            Self::Gaussian(bounds) | Self::Squashed(bounds) => bounds.low.len(),
            Self::SquashedGaussian(bounds) => 2 * bounds.low.len(),
            Self::Binary(count) => *count,
            Self::Greedy { count, .. } => *count as usize,
        }
    }

    /// Returns the number of numbers of an action.
    pub fn action_len(&self) -> usize {
        match self {
            Self::Categorical { counts, .. } => counts.len(),
            Self::Gaussian(bounds) | Self::Squashed(bounds) | Self::SquashedGaussian(bounds) => {
                bounds.low.len()
            }
            Self::Binary(count) => *count,
            Self::Greedy { .. } => 1,
        }
    }

    /// Returns the number of parameters besides those of the networks: log standard deviations.
    pub(crate) fn parameters(&self) -> usize {
        match self {
            Self::Gaussian(bounds) => bounds.low.len(),
            _ => 0,
        }
    }

    /// Writes the most likely actions, in the environment's range, from rows of `outputs`.
    pub(crate) fn most_likely(&self, outputs: &[f32], actions: &mut [f32]) {
        let rows = outputs.chunks_exact(self.outputs()).zip(actions.chunks_exact_mut(self.action_len()));
        for (outputs, actions) in rows {
            match self {
                Self::Categorical { counts, start } => {
                    let mut rest = outputs;
                    for (action, count) in actions.iter_mut().zip(counts) {
                        let (own, behind) = rest.split_at(*count as usize);
                        *action = choice(largest(own), *start);
                        rest = behind;
                    }
                }
                Self::Greedy { start, .. } => actions[0] = choice(largest(outputs), *start),
                Self::Binary(_) => {
                    for (action, score) in actions.iter_mut().zip(outputs) {
                        *action = f32::from(*score > 0.0);
                    }
                }
                Self::Gaussian(bounds) => {
                    for (axis, (action, mean)) in actions.iter_mut().zip(outputs).enumerate() {
                        *action = mean.clamp(bounds.low[axis], bounds.high[axis]);
                    }
                }
                Self::Squashed(bounds) | Self::SquashedGaussian(bounds) => {
                    for (axis, (action, mean)) in actions.iter_mut().zip(outputs).enumerate() {
                        *action = bounds.stretch(axis, mean.tanh());
                    }
                }
            }
        }
    }

    /// Converts actions from the range of the distribution to that of the environment.
    pub(crate) fn environment_actions(&self, actions: &[f32], taken: &mut [f32]) {
        taken.copy_from_slice(actions);
        match self {
            Self::Categorical { start: 0, .. } | Self::Binary(_) => (),
            Self::Categorical { start, .. } | Self::Greedy { start, .. } => {
                taken.iter_mut().for_each(|action| *action = choice(*action as usize, *start));
            }
            Self::Gaussian(bounds) => {
                for actions in taken.chunks_exact_mut(bounds.low.len()) {
                    for (action, (low, high)) in actions.iter_mut().zip(bounds.low.iter().zip(&bounds.high)) {
                        *action = action.clamp(*low, *high);
                    }
                }
            }
            Self::Squashed(bounds) | Self::SquashedGaussian(bounds) => {
                for actions in taken.chunks_exact_mut(bounds.low.len()) {
                    for (axis, action) in actions.iter_mut().enumerate() {
                        *action = bounds.stretch(axis, *action);
                    }
                }
            }
        }
    }

    /// The inverse of [`Self::environment_actions`].
    pub(crate) fn distribution_actions(&self, taken: &[f32], actions: &mut [f32]) {
        actions.copy_from_slice(taken);
        match self {
            Self::Categorical { start, .. } | Self::Greedy { start, .. } => {
                let start = f64::from(*start);
                actions.iter_mut().for_each(|action| *action = (f64::from(*action) - start) as f32);
            }
            Self::Gaussian(_) | Self::Binary(_) => (),
            Self::Squashed(bounds) | Self::SquashedGaussian(bounds) => {
                for actions in actions.chunks_exact_mut(bounds.low.len()) {
                    for (axis, action) in actions.iter_mut().enumerate() {
                        *action = bounds.shrink(axis, *action);
                    }
                }
            }
        }
    }
}

/// Returns the value of the choice with an index.
fn choice(place: usize, start: i32) -> f32 {
    (place as f64 + f64::from(start)) as f32
}

/// Returns the index of the largest number, the first of equals.
pub(crate) fn largest(numbers: &[f32]) -> usize {
    numbers.iter().enumerate().fold(0, |best, (at, number)| if *number > numbers[best] { at } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_reached_and_never_left() {
        let bounds = Bounds { low: vec![-0.1], high: vec![0.7] };
        let head = Head::Squashed(bounds.clone());
        let mut actions = [0.0; 3];
        head.most_likely(&[-100.0, 0.0, 100.0], &mut actions);
        assert_eq!((actions[0], actions[2]), (-0.1, 0.7));
        assert!((actions[1] - 0.3).abs() < 1e-6 && bounds.shrink(0, actions[1]).abs() < 1e-6);
    }

    #[test]
    fn choices_begin_where_the_space_does() {
        let head = Head::stochastic(&Space::Discrete { n: 3, start: -4 }).unwrap();
        let mut actions = [0.0; 2];
        head.most_likely(&[0.0, 2.0, 1.0, 5.0, 5.0, 5.0], &mut actions);
        assert_eq!(actions, [-3.0, -4.0]);
        let mut back = [9.0; 2];
        head.distribution_actions(&actions, &mut back);
        assert_eq!(back, [1.0, 0.0]);
        let digits = Head::stochastic(&Space::MultiBinary(vec![1, 2])).unwrap();
        digits.most_likely(&[0.5, -0.5], &mut actions);
        assert_eq!(actions, [1.0, 0.0]);
        assert!(Head::stochastic(&Space::Tuple(vec![Space::discrete(2)])).is_err());
    }
}
