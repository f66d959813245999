//! Schedules of hyperparameters over a training.

opendr_engine::choices! {
    /// How a hyperparameter changes over a training.
    pub enum Schedule {
        /// Constant.
        Constant = "constant",
        /// Linear decay to zero, as `lin_0.001` in rl-zoo.
        Linear = "linear",
    }
}

impl Schedule {
    /// Returns the value for the initial value `first` when the fraction `remaining`, in [0, 1], of the training is left.
    pub fn at(self, first: f32, remaining: f64) -> f32 {
        match self {
            Self::Constant => first,
            Self::Linear => (f64::from(first) * remaining) as f32,
        }
    }
}

/// Returns the fraction of a training that is left after `done` of `total` steps; 0 after the end.
pub(crate) fn remaining(done: u64, total: u64) -> f64 {
    1.0 - (done as f64 / total.max(1) as f64).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_ends_at_zero() {
        assert_eq!(Schedule::Linear.at(0.5, remaining(25, 100)), 0.375);
        assert_eq!(Schedule::Linear.at(0.5, remaining(101, 100)), 0.0);
        assert_eq!(Schedule::Constant.at(0.5, remaining(99, 100)), 0.5);
    }
}
