//! The network on the features of a policy or critic: an optional recurrent unit, and hidden layers; or one that scores choices.

use opendr_engine::Random;
use opendr_kernels::{Compute, Gru, GruTape, Initialisation, Network, Tape};

/// Hidden layers and an output layer, after a gated recurrent unit if there is one. The parameters of the unit come first.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Trunk {
    gru: Option<Gru>,
    network: Network,
    choices: Option<Choices>,
}

/// Choices that the same network scores one by one, each by its own features and those that follow the features of all choices. The
/// scores do not depend on the order of the choices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Choices {
    /// Number of choices.
    pub count: usize,
    /// Features of each.
    pub own: usize,
}

impl Choices {
    /// Writes a row for each choice of each row of `width` features.
    fn rows(self, features: &[f32], width: usize, rows: &mut Vec<f32>) {
        rows.clear();
        for features in features.chunks_exact(width) {
            let (own, common) = features.split_at(self.count * self.own);
            for own in own.chunks_exact(self.own) {
                rows.extend_from_slice(own);
                rows.extend_from_slice(common);
            }
        }
    }
}

/// Sequences of rows, `[steps, sequences]`; ignored without a recurrent unit.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sequences<'a> {
    /// Recurrent states before the first step, `[sequences, size]`.
    pub states: &'a [f32],
    /// Whether a step starts an episode, `[steps, sequences]`; the state is reset there.
    pub starts: &'a [bool],
}

/// Work memory of a forward and backward pass.
#[derive(Debug, Clone, Default)]
pub(crate) struct TrunkMemory {
    tape: Tape,
    gru: GruTape,
    /// All false: no row starts an episode.
    no_starts: Vec<bool>,
    dfeatures: Vec<f32>,
    /// Rows of choices.
    rows: Vec<f32>,
}

impl Trunk {
    pub fn new(gru: Option<Gru>, network: Network) -> Self {
        Self { gru, network, choices: None }
    }

    /// Creates a trunk whose network scores choices.
    pub fn scoring(choices: Choices, network: Network) -> Self {
        Self { gru: None, network, choices: Some(choices) }
    }

    /// Returns the choices that the network scores; none for a network on all features.
    pub fn choices(&self) -> Option<Choices> {
        self.choices
    }

    pub fn gru(&self) -> Option<&Gru> {
        self.gru.as_ref()
    }

    pub fn network(&self) -> &Network {
        &self.network
    }

    /// Returns the number of numbers of a recurrent state.
    pub fn state_len(&self) -> usize {
        self.gru.map_or(0, |gru| gru.size())
    }

    pub fn parameters(&self) -> usize {
        self.recurrent_parameters() + self.network.parameters()
    }

    /// Returns the number of parameters of the recurrent unit, which come first.
    pub fn recurrent_parameters(&self) -> usize {
        self.gru.map_or(0, |gru| gru.parameters())
    }

    /// Initialises the parameters; those of a recurrent unit by PyTorch's default, as in Stable-Baselines3.
    pub fn initialise(&self, how: Initialisation, random: &mut Random, parameters: &mut [f32]) {
        let (of_gru, of_network) = parameters.split_at_mut(self.recurrent_parameters());
        let bound = 1.0 / (self.state_len().max(1) as f32).sqrt();
        of_gru.iter_mut().for_each(|parameter| *parameter = random.uniform(-bound, bound));
        self.network.initialise(how, random, of_network);
    }

    /// Computes the outputs for the features of all steps.
    pub fn forward<'m>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        features: &[f32],
        sequences: Sequences<'_>,
        memory: &'m mut TrunkMemory,
    ) -> &'m [f32] {
        let (of_gru, of_network) = parameters.split_at(self.recurrent_parameters());
        let TrunkMemory { tape, gru: gru_tape, rows, .. } = memory;
        let features = match &self.gru {
            None => self.inputs(features, rows),
            Some(gru) => gru.forward(compute, of_gru, features, sequences.states, sequences.starts, gru_tape),
        };
        self.network.forward(compute, of_network, features, tape)
    }

    /// Returns what the network reads of features: them, or rows of choices.
    fn inputs<'f>(&self, features: &'f [f32], rows: &'f mut Vec<f32>) -> &'f [f32] {
        let Some(choices) = self.choices else { return features };
        choices.rows(features, self.network.inputs() + (choices.count - 1) * choices.own, rows);
        rows
    }

    /// Computes one step of every row and updates `states`.
    pub fn step<'m>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        features: &[f32],
        states: &mut [f32],
        memory: &'m mut TrunkMemory,
    ) -> &'m [f32] {
        let (of_gru, of_network) = parameters.split_at(self.recurrent_parameters());
        let TrunkMemory { tape, gru: gru_tape, no_starts, rows, .. } = memory;
        let Some(gru) = &self.gru else {
            return self.network.forward(compute, of_network, self.inputs(features, rows), tape);
        };
        no_starts.resize(states.len() / gru.size(), false);
        let after = gru.forward(compute, of_gru, features, states, no_starts, gru_tape);
        states.copy_from_slice(after);
        self.network.forward(compute, of_network, after, tape)
    }

    /// Adds to `gradients`, from the gradient of the outputs of the last [`Self::forward`]. Returns that of the features if
    /// `wants_input`, which must be false where choices are scored, else an empty slice.
    #[expect(clippy::too_many_arguments, reason = "inputs and outputs of a backward pass")]
    pub fn backward<'m>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        doutputs: &[f32],
        starts: &[bool],
        memory: &'m mut TrunkMemory,
        gradients: &mut [f32],
        wants_input: bool,
    ) -> &'m [f32] {
        let (of_gru, of_network) = parameters.split_at(self.recurrent_parameters());
        let (dgru, dnetwork) = gradients.split_at_mut(of_gru.len());
        let TrunkMemory { tape, gru: gru_tape, dfeatures, .. } = memory;
        let Some(gru) = &self.gru else {
            return self.network.backward(compute, of_network, doutputs, tape, Some(dnetwork), wants_input);
        };
        let dstates = self.network.backward(compute, of_network, doutputs, tape, Some(dnetwork), true);
        let wanted = if wants_input { starts.len() * gru.inputs() } else { 0 };
        dfeatures.resize(wanted, 0.0);
        let dx = wants_input.then_some(&mut dfeatures[..]);
        gru.backward(compute, of_gru, starts, dstates, gru_tape, dgru, dx, None);
        dfeatures
    }
}

impl TrunkMemory {
    /// Returns the outputs of the last forward pass.
    pub fn output(&self) -> &[f32] {
        self.tape.output()
    }

    /// Returns the input of a layer in the last forward pass.
    pub fn input_of(&self, layer: usize) -> &[f32] {
        self.tape.input_of(layer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::policy::NetworkConfig;

    const STARTS: [bool; 6] = [false, false, true, false, false, true];

    fn trunk() -> (Trunk, Vec<f32>, Vec<f32>, Vec<f32>) {
        let config = NetworkConfig { net_arch: vec![5], gru_size: Some(4), ..NetworkConfig::default() };
        let (trunk, mut random) = (config.trunk(3, 2).unwrap(), Random::new(8));
        let mut parameters = vec![0.0; trunk.parameters()];
        trunk.initialise(Initialisation::Uniform, &mut random, &mut parameters);
        let mut numbers = |count: usize| (0..count).map(|_| random.uniform(-1.0, 1.0)).collect::<Vec<_>>();
        let (features, states) = (numbers(6 * 3), numbers(2 * 4));
        (trunk, parameters, features, states)
    }

    #[test]
    fn gradients_are_differences() {
        let (trunk, parameters, features, states) = trunk();
        let (compute, mut memory) = (Compute::single(), TrunkMemory::default());
        let weights: Vec<f32> = (0..12).map(|at| (at as f32 - 5.0) / 4.0).collect();
        let sequences = Sequences { states: &states, starts: &STARTS };
        let mut loss = |parameters: &[f32], features: &[f32]| {
            let outputs = trunk.forward(&compute, parameters, features, sequences, &mut memory);
            outputs.iter().zip(&weights).map(|(output, weight)| output * weight).sum::<f32>()
        };
        let moved = |values: &[f32], at: usize, by: f32| {
            let mut values = values.to_vec();
            values[at] += by;
            values
        };
        let step = 1.0 / 128.0;
        let by_parameters: Vec<f32> = (0..parameters.len())
            .map(|at| [step, -step].map(|by| loss(&moved(&parameters, at, by), &features)))
            .map(|[up, down]| (up - down) / (2.0 * step))
            .collect();
        let by_features: Vec<f32> = (0..features.len())
            .map(|at| [step, -step].map(|by| loss(&parameters, &moved(&features, at, by))))
            .map(|[up, down]| (up - down) / (2.0 * step))
            .collect();
        loss(&parameters, &features);
        let mut gradients = vec![0.0; parameters.len()];
        let dfeatures =
            trunk.backward(&compute, &parameters, &weights, &STARTS, &mut memory, &mut gradients, true);
        for (got, wanted) in [(&gradients[..], by_parameters), (dfeatures, by_features)] {
            for (at, (got, wanted)) in got.iter().zip(&wanted).enumerate() {
                assert!((got - wanted).abs() < 2e-3, "{at}: {got} {wanted}");
            }
        }
    }

    /// Steps taken one by one, with resets at episode starts, give the outputs of the sequence.
    #[test]
    fn a_sequence_is_its_steps() {
        let (trunk, parameters, features, mut states) = trunk();
        let (compute, mut memory) = (Compute::single(), TrunkMemory::default());
        let sequences = Sequences { states: &states, starts: &STARTS };
        let whole = trunk.forward(&compute, &parameters, &features, sequences, &mut memory).to_vec();
        for (step, (features, wanted)) in features.chunks_exact(6).zip(whole.chunks_exact(4)).enumerate() {
            for (row, state) in states.chunks_exact_mut(4).enumerate() {
                if STARTS[2 * step + row] {
                    state.fill(0.0);
                }
            }
            assert_eq!(trunk.step(&compute, &parameters, features, &mut states, &mut memory), wanted);
        }
    }

    /// Scores follow their choices into any order, and their gradients are differences.
    #[test]
    fn choices_are_scored_one_by_one() {
        let choices = Choices { count: 3, own: 2 };
        let config = NetworkConfig { net_arch: vec![5], ..NetworkConfig::default() };
        let (trunk, mut random) = (Trunk::scoring(choices, config.network(3, 1).unwrap()), Random::new(3));
        let mut parameters = vec![0.0; trunk.parameters()];
        trunk.initialise(Initialisation::Uniform, &mut random, &mut parameters);
        let (compute, mut memory) = (Compute::single(), TrunkMemory::default());
        let features: Vec<f32> = (0..2 * 7).map(|_| random.uniform(-1.0, 1.0)).collect();
        let mut scores = |parameters: &[f32], features: &[f32]| {
            trunk.forward(&compute, parameters, features, Sequences::default(), &mut memory).to_vec()
        };
        let first = scores(&parameters, &features);
        let mut turned = features.clone();
        turned.chunks_exact_mut(7).for_each(|row| row[..6].rotate_left(2));
        let mut wanted = first.clone();
        wanted.chunks_exact_mut(3).for_each(|scores| scores.rotate_left(1));
        assert_eq!(scores(&parameters, &turned), wanted);
        let weights = [1.0, -0.5, 0.25, 2.0, 0.0, -1.0];
        let mut loss = |at: usize, by: f32| {
            let mut parameters = parameters.clone();
            parameters[at] += by;
            scores(&parameters, &features)
                .iter()
                .zip(weights)
                .map(|(score, weight)| score * weight)
                .sum::<f32>()
        };
        let step = 1.0 / 128.0;
        let differences: Vec<_> =
            (0..parameters.len()).map(|at| (loss(at, step) - loss(at, -step)) / (2.0 * step)).collect();
        scores(&parameters, &features);
        let mut gradients = vec![0.0; parameters.len()];
        trunk.backward(&compute, &parameters, &weights, &[], &mut memory, &mut gradients, false);
        for (at, (got, wanted)) in gradients.iter().zip(differences).enumerate() {
            assert!((got - wanted).abs() < 2e-3, "{at}: {got} {wanted}");
        }
    }
}
