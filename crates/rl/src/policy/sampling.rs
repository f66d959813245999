//! Sampling of actions.

use opendr_engine::Random;
use opendr_kernels::Isa;

use super::head::{Head, LOG_STD_BOUNDS};
use super::likelihood::Likelihood;

impl Head {
    /// Samples actions, in the environment's range; deterministic heads give their most likely ones.
    pub(crate) fn sample(
        &self,
        isa: Isa,
        outputs: &[f32],
        log_std: &[f32],
        random: &mut Random,
        likelihood: &mut Likelihood,
        actions: &mut [f32],
    ) {
        match self {
            Self::Categorical { .. } | Self::Binary(_) | Self::Gaussian(_) => {
                likelihood.sample(isa, self, outputs, log_std, random);
                self.environment_actions(&likelihood.actions, actions);
            }
            Self::SquashedGaussian(bounds) => {
                let axes = bounds.low.len();
                let rows = outputs.chunks_exact(2 * axes).zip(actions.chunks_exact_mut(axes));
                for (outputs, actions) in rows {
                    let (means, log_stds) = outputs.split_at(axes);
                    for (axis, (action, (mean, log_std))) in
                        actions.iter_mut().zip(means.iter().zip(log_stds)).enumerate()
                    {
                        let deviation = log_std.clamp(LOG_STD_BOUNDS[0], LOG_STD_BOUNDS[1]).exp();
                        *action = bounds.stretch(axis, (mean + deviation * random.normal() as f32).tanh());
                    }
                }
            }
            Self::Squashed(_) | Self::Greedy { .. } => self.most_likely(outputs, actions),
        }
    }
}
