//! Two critics, of which the lower value is used (clipped double Q-learning; Fujimoto et al., 2018).

use opendr_engine::environment::StateReader;
use opendr_engine::{Random, Result};
use opendr_kernels::{Adam, AdamOptions, Compute, Network, Tape, polyak_update};

use crate::policy::{Extractor, ExtractorMemory, NetworkConfig, ObservationEncoder, ParameterInit};
use crate::saved_state::SavedState;

/// Names of the arrays of saved critics and of their shared extractor: parameters, target and moments of Adam of each.
pub(crate) const ROWS: [[&str; 4]; 3] = [
    ["critic_1", "critic_1_target", "critic_1_adam_first", "critic_1_adam_second"],
    ["critic_2", "critic_2_target", "critic_2_adam_first", "critic_2_adam_second"],
    ["critic_sight", "critic_sight_target", "critic_sight_adam_first", "critic_sight_adam_second"],
];

/// Both critics and their work memory.
#[derive(Debug, Clone)]
pub(crate) struct TwinCritics {
    network: Network,
    critics: [Critic; 2],
    shared: SharedExtractor,
    /// Features and actions, side by side.
    inputs: Vec<f32>,
    /// The lower of both values of each row.
    lowest: Vec<f32>,
    daction: Vec<f32>,
}

/// Networks of image observations, shared by both critics as in Stable-Baselines3; empty without images.
#[derive(Debug, Clone)]
struct SharedExtractor {
    extractor: Extractor,
    parameters: Vec<f32>,
    target: Vec<f32>,
    adam: Adam,
    memory: ExtractorMemory,
    gradients: Vec<f32>,
    dfeatures: Vec<f32>,
}

/// Which parameters compute the values.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Version {
    Online,
    Target,
}

#[derive(Debug, Clone)]
struct Critic {
    parameters: Vec<f32>,
    target: Vec<f32>,
    adam: Adam,
    tape: Tape,
    /// Rows for which its value is the lower one.
    rows: Vec<usize>,
    dvalues: Vec<f32>,
    gradients: Vec<f32>,
    dinputs: Vec<f32>,
    loss: f32,
}

impl TwinCritics {
    pub fn new(
        encoder: &ObservationEncoder,
        action: usize,
        config: &NetworkConfig,
        random: &mut Random,
    ) -> Result<Self> {
        let shared = SharedExtractor::new(encoder, config, random)?;
        let network = config.network(shared.extractor.outputs() + action, 1)?;
        let count = network.parameters();
        let critics = [(); 2].map(|()| {
            let mut parameters = vec![0.0; count];
            network.initialise(ParameterInit::Uniform.of_output(), random, &mut parameters);
            Critic {
                target: parameters.clone(),
                parameters,
                adam: Adam::new(count, AdamOptions::default()),
                tape: Tape::default(),
                rows: Vec::new(),
                dvalues: Vec::new(),
                gradients: vec![0.0; count],
                dinputs: Vec::new(),
                loss: 0.0,
            }
        });
        Ok(Self { network, critics, shared, inputs: Vec::new(), lowest: Vec::new(), daction: Vec::new() })
    }

    /// Returns the lower value of both target networks for each row.
    pub fn target_values(
        &mut self,
        compute: &Compute,
        observations: &[f32],
        actions: &[f32],
        rows: usize,
    ) -> &[f32] {
        self.set_inputs(compute, observations, actions, rows, Version::Target);
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

    /// Takes a gradient step of both towards `targets`. The loss of each is `weight` times the mean squared error; returns their sum.
    pub fn learn(
        &mut self,
        compute: &Compute,
        [observations, actions]: [&[f32]; 2],
        targets: &[f32],
        weight: f32,
        learning_rate: f32,
    ) -> f32 {
        self.set_inputs(compute, observations, actions, targets.len(), Version::Online);
        let Self { network, critics: [first, second], shared, inputs, .. } = self;
        let update = CriticUpdate {
            targets,
            weight,
            learning_rate,
            needs_input_gradient: !shared.extractor.is_identity(),
        };
        compute.pool().join(
            || first.learn(compute, network, inputs, update),
            || second.learn(compute, network, inputs, update),
        );
        let loss = first.loss + second.loss;
        if update.needs_input_gradient && loss.is_finite() {
            shared.learn(compute, [&first.dinputs, &second.dinputs], network.inputs(), learning_rate);
        }
        loss
    }

    /// Returns the mean over rows of the lower value, and the gradient of minus that mean with respect to the actions.
    pub fn gradient_by_actions(
        &mut self,
        compute: &Compute,
        observations: &[f32],
        actions: &[f32],
        rows: usize,
    ) -> (f32, &[f32]) {
        self.set_inputs(compute, observations, actions, rows, Version::Online);
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
        for critic in [&mut *first, &mut *second] {
            critic.rows.clear();
            critic.rows.reserve(rows);
        }
        for (row, (one, other)) in first.tape.output().iter().zip(second.tape.output()).enumerate() {
            sum += one.min(*other);
            let lower = if one <= other { &mut first.rows } else { &mut second.rows };
            lower.push(row);
        }
        compute.pool().join(
            || first.differentiate(compute, network, rows),
            || second.differentiate(compute, network, rows),
        );
        let (width, action) = (network.inputs(), actions.len() / rows);
        daction.clear();
        for (one, other) in first.dinputs.chunks_exact(width).zip(second.dinputs.chunks_exact(width)) {
            let both = one[width - action..].iter().zip(&other[width - action..]);
            daction.extend(both.map(|(one, other)| one + other));
        }
        (sum * scale, daction)
    }

    /// Returns the same for the first critic alone, as TD3 uses it.
    pub fn gradient_by_actions_of_first(
        &mut self,
        compute: &Compute,
        observations: &[f32],
        actions: &[f32],
        rows: usize,
    ) -> (f32, &[f32]) {
        self.set_inputs(compute, observations, actions, rows, Version::Online);
        let Self { network, critics: [first, _], inputs, daction, .. } = self;
        let values = network.forward(compute, &first.parameters, inputs, &mut first.tape);
        let scale = 1.0 / rows as f32;
        let mean = values.iter().sum::<f32>() * scale;
        first.rows.clear();
        first.rows.extend(0..rows);
        first.differentiate(compute, network, rows);
        let (width, action) = (network.inputs(), actions.len() / rows);
        daction.clear();
        for row in first.dinputs.chunks_exact(width) {
            daction.extend_from_slice(&row[width - action..]);
        }
        (mean, daction)
    }

    /// Moves the target networks by `tau` towards the online networks.
    pub fn update_targets(&mut self, tau: f32) {
        for critic in &mut self.critics {
            polyak_update(&mut critic.target, &critic.parameters, tau);
        }
        polyak_update(&mut self.shared.target, &self.shared.parameters, tau);
    }

    fn set_inputs(
        &mut self,
        compute: &Compute,
        observations: &[f32],
        actions: &[f32],
        rows: usize,
        version: Version,
    ) {
        let SharedExtractor { extractor, parameters, target, memory, .. } = &mut self.shared;
        let parameters = if version == Version::Target { target } else { parameters };
        let features = extractor.forward(compute, parameters, observations, memory);
        let (width, action) = (features.len() / rows, actions.len() / rows);
        self.inputs.clear();
        for (features, action) in features.chunks_exact(width).zip(actions.chunks_exact(action)) {
            self.inputs.extend_from_slice(features);
            self.inputs.extend_from_slice(action);
        }
    }

    pub fn save(&self, state: &mut SavedState) {
        for (critic, [parameters, target, first, second]) in self.critics.iter().zip(ROWS) {
            state.add(parameters, &critic.parameters);
            state.add(target, &critic.target);
            state.add_adam([first, second], &critic.adam);
        }
        let (shared, [parameters, target, first, second]) = (&self.shared, ROWS[2]);
        state.add(parameters, &shared.parameters);
        state.add(target, &shared.target);
        state.add_adam([first, second], &shared.adam);
    }

    pub fn load(&mut self, state: &SavedState, words: &mut StateReader<'_>) -> Result<()> {
        for (critic, [parameters, target, first, second]) in self.critics.iter_mut().zip(ROWS) {
            state.fill(parameters, &mut critic.parameters)?;
            state.fill(target, &mut critic.target)?;
            state.fill_adam([first, second], &mut critic.adam, words)?;
        }
        let (shared, [parameters, target, first, second]) = (&mut self.shared, ROWS[2]);
        state.fill(parameters, &mut shared.parameters)?;
        state.fill(target, &mut shared.target)?;
        state.fill_adam([first, second], &mut shared.adam, words)
    }
}

impl SharedExtractor {
    fn new(encoder: &ObservationEncoder, config: &NetworkConfig, random: &mut Random) -> Result<Self> {
        let extractor = Extractor::new(encoder, config.image_network)?;
        let count = extractor.parameters();
        let mut parameters = vec![0.0; count];
        extractor.initialise(ParameterInit::Uniform, random, &mut parameters);
        Ok(Self {
            extractor,
            target: parameters.clone(),
            parameters,
            adam: Adam::new(count, AdamOptions::default()),
            memory: ExtractorMemory::default(),
            gradients: vec![0.0; count],
            dfeatures: Vec::new(),
        })
    }

    /// Takes a gradient step from the input gradients of both critics, in rows of `width`.
    fn learn(&mut self, compute: &Compute, [first, second]: [&[f32]; 2], width: usize, learning_rate: f32) {
        let Self { extractor, parameters, adam, memory, gradients, dfeatures, .. } = self;
        dfeatures.clear();
        for (one, other) in first.chunks_exact(width).zip(second.chunks_exact(width)) {
            let both = one.iter().zip(other).take(extractor.outputs());
            dfeatures.extend(both.map(|(one, other)| one + other));
        }
        gradients.fill(0.0);
        extractor.backward(compute, parameters, dfeatures, memory, gradients);
        adam.step(compute, learning_rate, parameters, gradients);
    }
}

/// A gradient step of a critic: targets, loss weight and learning rate.
#[derive(Debug, Clone, Copy)]
struct CriticUpdate<'a> {
    targets: &'a [f32],
    weight: f32,
    learning_rate: f32,
    needs_input_gradient: bool,
}

impl Critic {
    fn learn(&mut self, compute: &Compute, network: &Network, inputs: &[f32], update: CriticUpdate<'_>) {
        let CriticUpdate { targets, weight, learning_rate, needs_input_gradient } = update;
        let values = network.forward(compute, &self.parameters, inputs, &mut self.tape);
        let scale = weight / targets.len() as f32;
        self.loss = 0.0;
        self.dvalues.clear();
        for (value, target) in values.iter().zip(targets) {
            let error = value - target;
            self.loss += scale * error * error;
            self.dvalues.push(2.0 * scale * error);
        }
        if !self.loss.is_finite() {
            return;
        }
        self.gradients.fill(0.0);
        let gradients = Some(&mut self.gradients[..]);
        let (parameters, tape) = (&self.parameters, &mut self.tape);
        let dinputs =
            network.backward(compute, parameters, &self.dvalues, tape, gradients, needs_input_gradient);
        self.dinputs.clear();
        self.dinputs.extend_from_slice(dinputs);
        self.adam.step(compute, learning_rate, &mut self.parameters, &self.gradients);
    }

    /// Computes the gradient, with respect to the inputs, of minus the sum of the values of its `rows` in the last forward pass,
    /// divided by `batch`. Other rows have a gradient of 0 and are not computed.
    fn differentiate(&mut self, compute: &Compute, network: &Network, batch: usize) {
        let Self { parameters, tape, rows, dvalues, dinputs, .. } = self;
        dvalues.clear();
        dvalues.resize(rows.len(), -1.0 / batch as f32);
        tape.keep_rows(rows);
        let width = network.inputs();
        let of_rows = network.backward(compute, parameters, dvalues, tape, None, true);
        dinputs.clear();
        dinputs.resize(batch * width, 0.0);
        for (row, from) in rows.iter().zip(of_rows.chunks_exact(width)) {
            dinputs[row * width..(row + 1) * width].copy_from_slice(from);
        }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::environment::Space;

    use super::*;

    fn numbers(count: usize) -> ObservationEncoder {
        ObservationEncoder::new(&Space::symmetric(&vec![1.0; count]), None).unwrap()
    }

    #[test]
    fn actions_have_the_gradient_of_the_lower_value() {
        let (compute, mut random) = (Compute::with_threads(2), Random::new(4));
        let config = NetworkConfig { net_arch: vec![16], ..NetworkConfig::default() };
        let mut critics = TwinCritics::new(&numbers(3), 2, &config, &mut random).unwrap();
        let mut drawn = |count: usize| (0..count).map(|_| random.uniform(-1.0, 1.0)).collect::<Vec<_>>();
        let (observations, actions) = (drawn(6), drawn(4));
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
    fn values_converge_to_regression_targets_and_target_networks_follow() {
        let (compute, mut random) = (Compute::single(), Random::new(4));
        let mut critics = TwinCritics::new(&numbers(1), 1, &NetworkConfig::default(), &mut random).unwrap();
        let (observations, actions, targets) = ([0.5, -0.5], [1.0, -1.0], [2.0, -3.0]);
        let losses: Vec<_> = (0..300)
            .map(|_| critics.learn(&compute, [&observations, &actions], &targets, 0.5, 0.01))
            .collect();
        assert!(losses[299] < 1e-3 * losses[0], "{losses:?}");
        critics.update_targets(1.0);
        let values = critics.target_values(&compute, &observations, &actions, 2);
        assert!(values.iter().zip(targets).all(|(value, target)| (value - target).abs() < 0.1), "{values:?}");
    }
}
