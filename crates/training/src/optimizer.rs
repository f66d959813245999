//! Optimisers by name.

use burn::optim::decay::WeightDecayConfig;
use burn::optim::momentum::MomentumConfig;
use burn::optim::{AdamConfig, AdamWConfig, ModuleOptimizer, RmsPropConfig, SgdConfig};

use crate::params::{OptimizerKind, TrainingParams};

/// Epsilon in the denominators of the adaptive optimisers, as in PyTorch.
const EPSILON: f32 = 1e-8;

/// Returns the optimiser of `params`.
pub fn optimizer(params: &TrainingParams) -> ModuleOptimizer {
    let decay = params.weight_decay as f32;
    let penalty = (params.weight_decay > 0.0).then(|| WeightDecayConfig::new(decay));
    match params.optimizer {
        OptimizerKind::Adamw => AdamWConfig::new().with_epsilon(EPSILON).with_weight_decay(decay).init(),
        OptimizerKind::Adam => AdamConfig::new().with_epsilon(EPSILON).with_weight_decay(penalty).init(),
        OptimizerKind::Sgd => {
            let momentum = MomentumConfig { momentum: params.momentum, dampening: 0.0, nesterov: false };
            let momentum = (params.momentum > 0.0).then_some(momentum);
            SgdConfig::new().with_weight_decay(penalty).with_momentum(momentum).init()
        }
        OptimizerKind::Rmsprop => {
            let config = RmsPropConfig::new().with_epsilon(EPSILON).with_weight_decay(penalty);
            config.with_momentum(params.momentum as f32).init()
        }
    }
}
