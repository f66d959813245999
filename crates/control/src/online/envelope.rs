//! The region of observations that a network was trained on.

use opendr_engine::{Error, Result};

/// Bounds of every number of an observation.
#[derive(Debug, Clone, PartialEq)]
pub struct Envelope {
    low: Vec<f32>,
    high: Vec<f32>,
}

impl Envelope {
    /// Returns the bounds of `observations`, rows of `len` numbers, widened by `margin` of their span to both sides.
    ///
    /// # Errors
    /// `InvalidInput` without a row or for rows of another length.
    pub fn of(observations: &[f32], len: usize, margin: f32) -> Result<Self> {
        if len == 0 || observations.is_empty() || !observations.len().is_multiple_of(len) {
            return Err(Error::invalid_input(format!(
                "{} numbers are no rows of {len}; give the observations of the training",
                observations.len()
            )));
        }
        let (mut low, mut high) = (vec![f32::INFINITY; len], vec![f32::NEG_INFINITY; len]);
        for row in observations.chunks_exact(len) {
            for (at, number) in row.iter().enumerate() {
                (low[at], high[at]) = (low[at].min(*number), high[at].max(*number));
            }
        }
        for (low, high) in low.iter_mut().zip(&mut high) {
            let wider = margin * (*high - *low);
            (*low, *high) = (*low - wider, *high + wider);
        }
        Ok(Self { low, high })
    }

    /// Returns whether an observation lies inside.
    pub fn contains(&self, observation: &[f32]) -> bool {
        let bounds = self.low.iter().zip(&self.high);
        observation.iter().zip(bounds).all(|(number, (low, high))| (*low..=*high).contains(number))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_span_the_envelope() {
        let envelope = Envelope::of(&[0.0, 5.0, 2.0, 6.0], 2, 0.5).unwrap();
        assert!(envelope.contains(&[-1.0, 6.5]) && envelope.contains(&[3.0, 4.5]));
        assert!(!envelope.contains(&[3.1, 5.0]) && !envelope.contains(&[f32::NAN, 5.0]));
        assert!(Envelope::of(&[0.0; 3], 2, 0.0).is_err());
    }
}
