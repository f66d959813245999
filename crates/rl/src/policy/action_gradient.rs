//! Gradients of a policy's actions, for those who adapt it while it acts.

use opendr_engine::{Error, Result};
use opendr_kernels::Compute;

use super::{Head, Policy, PolicyMemory};

impl Policy {
    /// Returns the parameters of the last layer among [`Self::parameters`].
    pub fn last_layer(&self) -> std::ops::Range<usize> {
        let network = self.trunk.network();
        let first = self.extractor.parameters() + self.trunk.recurrent_parameters();
        let range = network.parameter_range(network.layers().len() - 1);
        first + range.start..first + range.end
    }

    /// Adds to `gradients` those of the parameters, from `daction`, the gradient of the actions that the last [`Self::act`] on
    /// `memory` wrote with [`ActionMode::Deterministic`](super::ActionMode::Deterministic).
    ///
    /// # Errors
    /// `Unsupported` for choices, digits and policies with memory; `InvalidInput` where a length does not fit, or before an act.
    pub fn action_gradient(
        &self,
        compute: &Compute,
        daction: &[f32],
        memory: &mut PolicyMemory,
        gradients: &mut [f32],
    ) -> Result<()> {
        self.with_output_gradient(daction, memory, gradients, |doutputs, memory, gradients| {
            self.backward(compute, doutputs, memory, gradients);
        })
    }

    /// Computes the gradients of [`Self::last_layer`] alone; the others of `gradients` stay as they are. It costs a fraction.
    ///
    /// # Errors
    /// As [`Self::action_gradient`].
    pub fn last_layer_gradient(
        &self,
        daction: &[f32],
        memory: &mut PolicyMemory,
        gradients: &mut [f32],
    ) -> Result<()> {
        let width = self.head.outputs();
        self.with_output_gradient(daction, memory, gradients, |doutputs, memory, gradients| {
            let inputs = memory.trunk.input_of(self.trunk.network().layers().len() - 1);
            let own = &mut gradients[self.last_layer()];
            let size = own.len() / width - 1;
            for (inputs, doutputs) in inputs.chunks_exact(size).zip(doutputs.chunks_exact(width)) {
                let inputs = inputs.iter().chain([&1.0]);
                for (own, input) in own.chunks_exact_mut(width).zip(inputs) {
                    own.iter_mut().zip(doutputs).for_each(|(own, doutput)| *own += input * doutput);
                }
            }
        })
    }

    /// Turns gradients of actions into those of the network's outputs, and calls `add` with them.
    fn with_output_gradient(
        &self,
        daction: &[f32],
        memory: &mut PolicyMemory,
        gradients: &mut [f32],
        add: impl FnOnce(&[f32], &mut PolicyMemory, &mut [f32]),
    ) -> Result<()> {
        self.config.check_no_memory("adaptation")?;
        let axes = self.head.action_len();
        let outputs = memory.trunk.output().len();
        let rows = outputs / self.head.outputs().max(1);
        if outputs == 0 || daction.len() != rows * axes || gradients.len() != self.parameters.len() {
            return Err(Error::invalid_input(format!(
                "{} numbers of actions and {} of gradients, where the last act had {rows} x {axes} and there are {} parameters; \
                 act before, and give as many",
                daction.len(),
                gradients.len(),
                self.parameters.len()
            )));
        }
        let mut doutputs = std::mem::take(&mut memory.doutputs);
        doutputs.clear();
        doutputs.resize(outputs, 0.0);
        let rows_of = |values| <[f32]>::chunks_exact(values, self.head.outputs());
        let known = match &self.head {
            Head::Gaussian(bounds) => {
                for ((output, gradient), down) in rows_of(memory.trunk.output())
                    .zip(daction.chunks_exact(axes))
                    .zip(doutputs.chunks_exact_mut(axes))
                {
                    for axis in 0..axes {
                        let inside = (bounds.low[axis]..=bounds.high[axis]).contains(&output[axis]);
                        down[axis] = if inside { gradient[axis] } else { 0.0 };
                    }
                }
                true
            }
            Head::Squashed(bounds) | Head::SquashedGaussian(bounds) => {
                let width = self.head.outputs();
                for ((output, gradient), down) in rows_of(memory.trunk.output())
                    .zip(daction.chunks_exact(axes))
                    .zip(doutputs.chunks_exact_mut(width))
                {
                    for axis in 0..axes {
                        let squashed = output[axis].tanh();
                        let stretch = 0.5 * (bounds.high[axis] - bounds.low[axis]);
                        down[axis] = gradient[axis] * stretch * (1.0 - squashed * squashed);
                    }
                }
                true
            }
            Head::Categorical { .. } | Head::Binary(_) | Head::Greedy { .. } => false,
        };
        if known {
            add(&doutputs, memory, gradients);
        }
        memory.doutputs = doutputs;
        match known {
            true => Ok(()),
            false => {
                Err(Error::unsupported("choices have no gradient; adapt a policy whose actions are numbers"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Random;
    use opendr_engine::environment::{EnvironmentSpec, Space};

    use super::*;
    use crate::policy::{ActionMode, Bounds, NetworkConfig, ParameterInit};

    /// Against differences, for each head with numbers.
    #[test]
    fn gradients_are_those_of_differences() {
        let spec =
            EnvironmentSpec::new("test", Space::symmetric(&[f32::INFINITY; 3]), Space::symmetric(&[2.0; 2]));
        let bounds = Bounds { low: vec![-2.0; 2], high: vec![2.0; 2] };
        let heads =
            [Head::Gaussian(bounds.clone()), Head::Squashed(bounds.clone()), Head::SquashedGaussian(bounds)];
        let compute = Compute::single();
        for head in heads {
            let config = NetworkConfig { net_arch: vec![7], ..NetworkConfig::default() };
            let mut policy = Policy::new(&spec, head, &config, None).unwrap();
            policy.initialise(ParameterInit::Orthogonal(0.5), 0.0, &mut Random::new(2));
            let (seen, weights) = ([0.3, -0.5, 0.8], [1.5, -0.7]);
            let mut memory = PolicyMemory::default();
            let mut value = |policy: &Policy| {
                let mut action = [0.0; 2];
                policy.act(&compute, &seen, ActionMode::Deterministic, &mut memory, &mut action).unwrap();
                (action[0] * weights[0] + action[1] * weights[1], memory.clone())
            };
            let (_, mut tape) = value(&policy);
            let mut gradients = vec![0.0; policy.parameters().len()];
            policy.action_gradient(&compute, &weights, &mut tape, &mut gradients).unwrap();
            for (at, gradient) in gradients.iter().enumerate() {
                let mut moved = [0.01f32, -0.01].map(|by| {
                    let mut policy = policy.clone();
                    policy.parameters_mut()[at] += by;
                    value(&policy).0
                });
                moved[0] = (moved[0] - moved[1]) / 0.02;
                assert!((moved[0] - gradient).abs() < 3e-3, "{at}: {} {gradient}", moved[0]);
            }
            let last = policy.last_layer();
            let mut own = vec![0.0; gradients.len()];
            policy.last_layer_gradient(&weights, &mut tape, &mut own).unwrap();
            for (own, whole) in own[last.clone()].iter().zip(&gradients[last.clone()]) {
                assert!((own - whole).abs() < 1e-5, "{own} {whole}");
            }
            assert!(last.end <= gradients.len() && last.len() == 8 * policy.head().outputs());
        }
    }
}
