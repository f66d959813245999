//! Numbers that change in the course of a training.

opendr_engine::choices! {
    /// How a number changes from the beginning of a training to its end.
    pub enum Schedule {
        /// Not at all.
        Constant = "constant",
        /// Evenly to zero: what rl-zoo writes as `lin_0.001`.
        Linear = "linear",
    }
}

impl Schedule {
    /// The number that began as `first`, where the share `remaining` of the training, in [0, 1], is left.
    pub fn at(self, first: f32, remaining: f64) -> f32 {
        match self {
            Self::Constant => first,
            Self::Linear => (f64::from(first) * remaining) as f32,
        }
    }
}

/// The share of a training that is left after `done` of `total` steps; 0 where more than all are done.
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
