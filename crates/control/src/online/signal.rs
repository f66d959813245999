//! What the parameters learn from.

opendr_engine::choices! {
    /// A learning signal: the direction in which a command should have been different, from the error and its rate.
    pub enum LearningSignal {
        /// A rule surface that saturates (Sarabakha and Kayacan, 2019): large errors teach no more than the scale.
        ExpertRule = "expert_rule",
        /// The weighted sum of error and rate itself, as in feedback-error learning (Kawato, 1990).
        FeedbackError = "feedback_error",
        /// The velocity that a unit plant under the base's commands would have, less the observed one: unlike the tracking error it
        /// shows a disturbance at once, through a filter of first order, so that learning from it does not oscillate. Saturates
        /// as the expert rule does. Needs the place of the reference's velocity.
        ReferenceModel = "reference_model",
    }
}

impl LearningSignal {
    /// The signal for `sum`, the weighted sum of error and rate; zero up to the dead zone, and without a step there.
    pub fn value(self, sum: f32, scale: f32, dead_zone: f32) -> f32 {
        let beyond = (sum.abs() - dead_zone).max(0.0).copysign(sum);
        match self {
            Self::ExpertRule | Self::ReferenceModel => scale * (beyond / scale).tanh(),
            Self::FeedbackError => beyond,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_are_odd_and_silent_in_the_dead_zone() {
        for signal in [LearningSignal::ExpertRule, LearningSignal::FeedbackError] {
            assert_eq!(signal.value(0.009, 0.3, 0.01), 0.0);
            assert!((signal.value(0.03, 0.3, 0.01) - 0.02).abs() < 1e-4);
            assert_eq!(signal.value(0.5, 0.3, 0.01), -signal.value(-0.5, 0.3, 0.01));
        }
        assert!(LearningSignal::ExpertRule.value(100.0, 0.3, 0.01) <= 0.3);
        assert!(LearningSignal::FeedbackError.value(100.0, 0.3, 0.01) > 99.0);
    }
}
