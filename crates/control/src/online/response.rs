//! How the nominal plant answers to a command.

/// First-order lags in series: the response of the plant as two equal lags, and the filter of the observed velocity behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Response {
    /// Shares of the distance that a step closes, stage by stage.
    shares: [f32; 3],
}

/// Signals behind each stage.
pub(super) type Stages = [f32; 3];

impl Response {
    /// Creates a plant that takes `seconds` from a command to its effect, observed through a filter of `bandwidth` (1/s).
    pub fn new(seconds: f32, bandwidth: f32, period: f32) -> Self {
        let lag = period / (0.5 * seconds + period);
        Self { shares: [lag, lag, (bandwidth * period).min(1.0)] }
    }

    /// Advances the stages by one step of an input.
    pub fn advance(&self, stages: &mut Stages, input: f32) {
        let mut input = input;
        for (stage, share) in stages.iter_mut().zip(self.shares) {
            *stage += share * (input - *stage);
            input = *stage;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The centre of the response to a step lies at the sum of the lags.
    #[test]
    fn lags_add_up() {
        let response = Response::new(0.3, 5.0, 0.001);
        let (mut stages, mut areas) = ([0.0; 3], [0.0; 2]);
        for _ in 0..5000 {
            response.advance(&mut stages, 1.0);
            areas[0] += 0.001 * (1.0 - stages[1]);
            areas[1] += 0.001 * (1.0 - stages[2]);
        }
        assert!((areas[0] - 0.3).abs() < 0.01 && (areas[1] - 0.5).abs() < 0.01, "{areas:?}");
    }
}
