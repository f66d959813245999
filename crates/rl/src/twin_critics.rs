//! Two estimates of what actions are worth, of which the lower one counts (Fujimoto et al., 2018).

use opendr_engine::environment::StateReader;
use opendr_engine::{Random, Result};
use opendr_kernels::{Adam, AdamOptions, Compute, Network, Tape, move_towards};

use crate::policy::{Beginning, NetworkConfig};
use crate::saved_state::SavedState;

/// The rows of saved critics: parameters, targets and moments of each.
pub(crate) const ROWS: [[&str; 4]; 2] = [
    ["critic_1", "critic_1_target", "critic_1_adam_first", "critic_1_adam_second"],
    ["critic_2", "critic_2_target", "critic_2_adam_first", "critic_2_adam_second"],
];

/// Both critics, with memory that is used again.
#[derive(Debug, Clone)]
pub(crate) struct TwinCritics {
    network: Network,
    critics: [Critic; 2],
    /// Observations and actions, side by side.
    inputs: Vec<f32>,
    /// The lower of both values of each row.
    lowest: Vec<f32>,
    daction: Vec<f32>,
}

#[derive(Debug, Clone)]
struct Critic {
    parameters: Vec<f32>,
    target: Vec<f32>,
    adam: Adam,
    tape: Tape,
    dvalues: Vec<f32>,
    gradients: Vec<f32>,
    dinputs: Vec<f32>,
    loss: f32,
}

impl TwinCritics {
    pub fn new(
        observation: usize,
        action: usize,
        config: &NetworkConfig,
        random: &mut Random,
    ) -> Result<Self> {
        let network = config.network(observation + action, 1)?;
        let count = network.parameters();
        let critics = [(); 2].map(|()| {
            let mut parameters = vec![0.0; count];
            network.initialise(Beginning::Uniform.of_output(), random, &mut parameters);
            Critic {
                target: parameters.clone(),
                parameters,
                adam: Adam::new(count, AdamOptions::default()),
                tape: Tape::default(),
                dvalues: Vec::new(),
                gradients: vec![0.0; count],
                dinputs: Vec::new(),
                loss: 0.0,
            }
        });
        Ok(Self { network, critics, inputs: Vec::new(), lowest: Vec::new(), daction: Vec::new() })
    }

    /// What the targets think that actions are worth: the lower of both.
    pub fn target_values(
        &mut self,
        compute: &Compute,
        observations: &[f32],
        actions: &[f32],
        rows: usize,
    ) -> &[f32] {
        self.set_inputs(observations, actions, rows);
        let Self { network, critics: [first, second], inputs, lowest, .. } = self;
        compute.pool().join(
            || {
                network.forward(compute, &first.target, inputs, &mut first.tape);
            },
            || {
                network.forward(compute, &second.target, inputs, &mut second.tape);
            },
        );
        let both = first.tape.output().iter().zip(second.tape.output());
        lowest.clear();
        lowest.extend(both.map(|(first, second)| first.min(*second)));
        lowest
    }

    /// Takes a step of both towards `wanted`, with `weight` times the mean squared error of each as loss; gives the sum.
    pub fn learn(
        &mut self,
        compute: &Compute,
        [observations, actions]: [&[f32]; 2],
        wanted: &[f32],
        weight: f32,
        learning_rate: f32,
    ) -> f32 {
        self.set_inputs(observations, actions, wanted.len());
        let Self { network, critics: [first, second], inputs, .. } = self;
        compute.pool().join(
            || first.learn(compute, network, inputs, wanted, weight, learning_rate),
            || second.learn(compute, network, inputs, wanted, weight, learning_rate),
        );
        first.loss + second.loss
    }

    /// The mean, over rows, of the lower of both values, and the gradient of minus that mean by the actions.
    pub fn gradient_by_actions(
        &mut self,
        compute: &Compute,
        observations: &[f32],
        actions: &[f32],
        rows: usize,
    ) -> (f32, &[f32]) {
        self.set_inputs(observations, actions, rows);
        let Self { network, critics: [first, second], inputs, daction, .. } = self;
        compute.pool().join(
            || {
                network.forward(compute, &first.parameters, inputs, &mut first.tape);
            },
            || {
                network.forward(compute, &second.parameters, inputs, &mut second.tape);
            },
        );
        let scale = 1.0 / rows as f32;
        let mut sum = 0.0;
        first.dvalues.clear();
        second.dvalues.clear();
        for (one, other) in first.tape.output().iter().zip(second.tape.output()) {
            sum += one.min(*other);
            first.dvalues.push(if one <= other { -scale } else { 0.0 });
            second.dvalues.push(if one <= other { 0.0 } else { -scale });
        }
        compute
            .pool()
            .join(|| first.differentiate(compute, network), || second.differentiate(compute, network));
        let (width, action) = (network.inputs(), actions.len() / rows);
        daction.clear();
        for (one, other) in first.dinputs.chunks_exact(width).zip(second.dinputs.chunks_exact(width)) {
            let both = one[width - action..].iter().zip(&other[width - action..]);
            daction.extend(both.map(|(one, other)| one + other));
        }
        (sum * scale, daction)
    }

    /// Only the first: as TD3 has it.
    pub fn gradient_by_actions_of_first(
        &mut self,
        compute: &Compute,
        observations: &[f32],
        actions: &[f32],
        rows: usize,
    ) -> (f32, &[f32]) {
        self.set_inputs(observations, actions, rows);
        let Self { network, critics: [first, _], inputs, daction, .. } = self;
        let values = network.forward(compute, &first.parameters, inputs, &mut first.tape);
        let scale = 1.0 / rows as f32;
        let mean = values.iter().sum::<f32>() * scale;
        first.dvalues.clear();
        first.dvalues.resize(rows, -scale);
        first.differentiate(compute, network);
        let (width, action) = (network.inputs(), actions.len() / rows);
        daction.clear();
        for row in first.dinputs.chunks_exact(width) {
            daction.extend_from_slice(&row[width - action..]);
        }
        (mean, daction)
    }

    /// Moves the targets.
    pub fn follow(&mut self, tau: f32) {
        for critic in &mut self.critics {
            move_towards(&mut critic.target, &critic.parameters, tau);
        }
    }

    fn set_inputs(&mut self, observations: &[f32], actions: &[f32], rows: usize) {
        let (observation, action) = (observations.len() / rows, actions.len() / rows);
        self.inputs.clear();
        for (observation, action) in observations.chunks_exact(observation).zip(actions.chunks_exact(action))
        {
            self.inputs.extend_from_slice(observation);
            self.inputs.extend_from_slice(action);
        }
    }

    pub fn save(&self, state: &mut SavedState) {
        for (critic, [parameters, target, first, second]) in self.critics.iter().zip(ROWS) {
            state.add(parameters, &critic.parameters);
            state.add(target, &critic.target);
            state.add_adam([first, second], &critic.adam);
        }
    }

    pub fn load(&mut self, state: &SavedState, words: &mut StateReader<'_>) -> Result<()> {
        for (critic, [parameters, target, first, second]) in self.critics.iter_mut().zip(ROWS) {
            state.fill(parameters, &mut critic.parameters)?;
            state.fill(target, &mut critic.target)?;
            state.fill_adam([first, second], &mut critic.adam, words)?;
        }
        Ok(())
    }
}

impl Critic {
    fn learn(
        &mut self,
        compute: &Compute,
        network: &Network,
        inputs: &[f32],
        wanted: &[f32],
        weight: f32,
        learning_rate: f32,
    ) {
        let values = network.forward(compute, &self.parameters, inputs, &mut self.tape);
        let scale = weight / wanted.len() as f32;
        self.loss = 0.0;
        self.dvalues.clear();
        for (value, wanted) in values.iter().zip(wanted) {
            let error = value - wanted;
            self.loss += scale * error * error;
            self.dvalues.push(2.0 * scale * error);
        }
        if !self.loss.is_finite() {
            return;
        }
        self.gradients.fill(0.0);
        let gradients = Some(&mut self.gradients[..]);
        network.backward(compute, &self.parameters, &self.dvalues, &mut self.tape, gradients, false);
        self.adam.step(compute, learning_rate, &mut self.parameters, &self.gradients);
    }

    /// The gradient of the inputs from that of the values.
    fn differentiate(&mut self, compute: &Compute, network: &Network) {
        let dinputs = network.backward(compute, &self.parameters, &self.dvalues, &mut self.tape, None, true);
        self.dinputs.clear();
        self.dinputs.extend_from_slice(dinputs);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn actions_have_the_gradient_of_the_lower_value() {
        let (compute, mut random) = (Compute::with_threads(2), Random::new(4));
        let config = NetworkConfig { net_arch: vec![16], ..NetworkConfig::default() };
        let mut critics = TwinCritics::new(3, 2, &config, &mut random).unwrap();
        let mut numbers = |count: usize| (0..count).map(|_| random.uniform(-1.0, 1.0)).collect::<Vec<_>>();
        let (observations, actions) = (numbers(6), numbers(4));
        let gradient = critics.gradient_by_actions(&compute, &observations, &actions, 2).1.to_vec();
        let first = critics.gradient_by_actions_of_first(&compute, &observations, &actions, 2).1.to_vec();
        for at in 0..4 {
            let mut mean = |by: f32, of_first: bool| {
                let mut actions = actions.clone();
                actions[at] += by;
                match of_first {
                    true => critics.gradient_by_actions_of_first(&compute, &observations, &actions, 2).0,
                    false => critics.gradient_by_actions(&compute, &observations, &actions, 2).0,
                }
            };
            let difference = (mean(0.01, false) - mean(-0.01, false)) / 0.02;
            assert!((gradient[at] + difference).abs() < 1e-3, "{at}: {} {difference}", gradient[at]);
            let difference = (mean(0.01, true) - mean(-0.01, true)) / 0.02;
            assert!((first[at] + difference).abs() < 1e-3, "{at}: {} {difference}", first[at]);
        }
    }

    #[test]
    fn values_come_to_what_is_wanted_and_targets_follow() {
        let (compute, mut random) = (Compute::single(), Random::new(4));
        let mut critics = TwinCritics::new(1, 1, &NetworkConfig::default(), &mut random).unwrap();
        let (observations, actions, wanted) = ([0.5, -0.5], [1.0, -1.0], [2.0, -3.0]);
        let losses: Vec<_> = (0..300)
            .map(|_| critics.learn(&compute, [&observations, &actions], &wanted, 0.5, 0.01))
            .collect();
        assert!(losses[299] < 1e-3 * losses[0], "{losses:?}");
        critics.follow(1.0);
        let values = critics.target_values(&compute, &observations, &actions, 2);
        assert!(values.iter().zip(wanted).all(|(value, wanted)| (value - wanted).abs() < 0.1), "{values:?}");
    }
}
