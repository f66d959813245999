//! Import of policies of Stable-Baselines3 from the files of `model.save`, without running any code in them.

mod archive;
mod pickle;

use std::collections::BTreeMap;

use opendr_engine::environment::EnvironmentSpec;
use opendr_engine::{Error, Result, ResultExt as _};
use opendr_kernels::{Layer, Network};
use serde::Deserialize;

use archive::{Archive, Tensor};

use crate::policy::{ActivationFn, Bounds, Head, ImageNetwork, NetworkConfig, Policy};

/// The parts of the JSON member `data` that are read; serialised objects are skipped.
#[derive(Deserialize)]
struct Settings {
    #[serde(default)]
    use_sde: bool,
    #[serde(default)]
    policy_kwargs: serde_json::Value,
}

/// Names of tensors, by the algorithm that wrote them.
struct Family {
    name: &'static str,
    /// Prefix of the names of hidden layers.
    hidden: &'static str,
    /// Output layer; none if it is the last of the hidden ones.
    output: Option<&'static str>,
    /// Second output layer; its outputs follow those of the first.
    second: Option<&'static str>,
    activation: ActivationFn,
}

/// The known families, in the order in which they are tried.
const FAMILIES: &[Family] = &[
    Family {
        name: "PPO or A2C",
        hidden: "mlp_extractor.policy_net",
        output: Some("action_net"),
        second: None,
        activation: ActivationFn::Tanh,
    },
    Family {
        name: "SAC",
        hidden: "actor.latent_pi",
        output: Some("actor.mu"),
        second: Some("actor.log_std"),
        activation: ActivationFn::Relu,
    },
    Family {
        name: "TD3 or DDPG",
        hidden: "actor.mu",
        output: None,
        second: None,
        activation: ActivationFn::Relu,
    },
    Family { name: "DQN", hidden: "q_net.q_net", output: None, second: None, activation: ActivationFn::Relu },
];

/// Reads a policy from the bytes of a `.zip` written by Stable-Baselines3's `model.save`, for environments of this specification:
/// PPO, A2C, SAC, TD3, DDPG and DQN with an `MlpPolicy`. Statistics of `VecNormalize` are in another file and not read.
///
/// # Errors
/// `Format` and `Integrity` for a damaged file, `Unsupported` for other policies, `InvalidInput` when the spaces do not match.
pub fn policy_from_stable_baselines3(bytes: &[u8], spec: &EnvironmentSpec) -> Result<Policy> {
    read(bytes, spec).context(|| "reading a Stable-Baselines3 policy")
}

fn read(bytes: &[u8], spec: &EnvironmentSpec) -> Result<Policy> {
    let mut archive = Archive::open(bytes)?;
    let settings: Settings = serde_json::from_slice(&archive.member("data")?).map_err(|error| {
        Error::format("the member data is not the JSON of Stable-Baselines3").with_source(error)
    })?;
    let tensors = archive.tensors("policy.pth")?;
    let is_there = |family: &&Family| tensors.contains_key(&format!("{}.0.weight", family.hidden));
    let Some(family) = FAMILIES.iter().find(is_there) else {
        let names: Vec<_> = tensors.keys().take(6).map(String::as_str).collect();
        return Err(Error::unsupported(format!(
            "the tensors {}, ... are not those of an MlpPolicy; train the policy with MlpPolicy",
            names.join(", ")
        )));
    };
    if settings.use_sde || tensors.keys().any(|name| name.contains("features_extractor")) {
        return Err(Error::unsupported(format!(
            "a policy of {} with state-dependent exploration or image observations; train it with neither",
            family.name
        )));
    }
    let layers = family.layers(&tensors)?;
    let sizes = layers.split_last().map_or(&[][..], |(_, hidden)| hidden).iter();
    let config = NetworkConfig {
        net_arch: sizes.map(|layer| layer.outputs()).collect(),
        activation_fn: family.activation_of(&settings.policy_kwargs)?,
        image_network: ImageNetwork::Flat,
        gru_size: None,
    };
    let mut policy = Policy::new(spec, family.head(spec)?, &config, None)?;
    fill(&mut policy, &layers)?;
    if let Head::Gaussian(_) = policy.head {
        let log_std = tensors.get("log_std").map_or(&[][..], |tensor| &tensor.numbers);
        let first = policy.trunk.parameters();
        copy(&mut policy.parameters[first..], log_std, "log_std")?;
    }
    Ok(policy)
}

/// A dense layer of PyTorch.
struct DenseLayer<'a> {
    /// Weights, one row per unit; those of a second layer follow.
    weights: Vec<&'a Tensor>,
    biases: Vec<&'a Tensor>,
}

impl DenseLayer<'_> {
    fn outputs(&self) -> usize {
        self.biases.iter().map(|bias| bias.numbers.len()).sum()
    }
}

impl Family {
    /// Returns all layers, the output last.
    fn layers<'a>(&self, tensors: &'a BTreeMap<String, Tensor>) -> Result<Vec<DenseLayer<'a>>> {
        let of = |name: &str, suffix: &str| {
            tensors.get(&format!("{name}.{suffix}")).ok_or_else(|| {
                Error::format(format!(
                    "the policy has no tensor {name}.{suffix}; save it again with model.save"
                ))
            })
        };
        let layer = |names: &[&str]| -> Result<_> {
            let weights = names.iter().map(|name| of(name, "weight")).collect::<Result<_>>()?;
            let biases = names.iter().map(|name| of(name, "bias")).collect::<Result<_>>()?;
            Ok(DenseLayer { weights, biases })
        };
        // The activations between layers are numbered, too.
        let names = (0..).step_by(2).map(|index| format!("{}.{index}", self.hidden));
        let there = names.take_while(|name| tensors.contains_key(&format!("{name}.weight")));
        let mut layers = there.map(|name| layer(&[&name])).collect::<Result<Vec<_>>>()?;
        if let Some(output) = self.output {
            let names = [Some(output), self.second];
            layers.push(layer(&names.into_iter().flatten().collect::<Vec<_>>())?);
        }
        Ok(layers)
    }

    fn activation_of(&self, policy_kwargs: &serde_json::Value) -> Result<ActivationFn> {
        match policy_kwargs.get("activation_fn").map(serde_json::Value::to_string) {
            None => Ok(self.activation),
            Some(name) if name.contains(".ReLU'") => Ok(ActivationFn::Relu),
            Some(name) if name.contains(".Tanh'") => Ok(ActivationFn::Tanh),
            Some(name) => Err(Error::unsupported(format!(
                "the activation function {name:.80} is not supported; use tanh or ReLU"
            ))),
        }
    }

    fn head(&self, spec: &EnvironmentSpec) -> Result<Head> {
        use opendr_engine::environment::Space;
        match (self.name, &spec.action) {
            ("SAC", space) => Bounds::of(space, true).map(Head::SquashedGaussian),
            ("TD3 or DDPG", space) => Bounds::of(space, true).map(Head::Squashed),
            ("DQN", Space::Discrete { n, start }) => Ok(Head::Greedy { count: *n, start: *start }),
            ("DQN", space) => {
                Err(Error::invalid_input(format!("a policy of DQN does not fit the action space {space}")))
            }
            (_, space) => Head::stochastic(space),
        }
    }
}

/// Copies layers into the parameters of a policy, with the weights of PyTorch transposed.
fn fill(policy: &mut Policy, layers: &[DenseLayer<'_>]) -> Result<()> {
    let network: &Network = policy.trunk.network();
    for (index, (own, layer)) in network.layers().iter().zip(layers).enumerate() {
        let Layer::Dense(dense) = own else { continue };
        let (inputs, outputs) = (dense.inputs(), dense.outputs());
        let weights: Vec<f32> =
            layer.weights.iter().flat_map(|tensor| tensor.numbers.iter().copied()).collect();
        let biases: Vec<f32> =
            layer.biases.iter().flat_map(|tensor| tensor.numbers.iter().copied()).collect();
        let is_wide = layer.weights.iter().all(|weights| weights.shape.last() == Some(&inputs));
        if weights.len() != inputs * outputs || biases.len() != outputs || !is_wide {
            return Err(Error::invalid_input(format!(
                "layer {index} has {} weights and {} biases, but needs {inputs} times {outputs} and {outputs} for observations {} and actions {}",
                weights.len(),
                biases.len(),
                policy.encoder.space(),
                policy.action()
            )));
        }
        let (to_weights, to_biases) =
            policy.parameters[network.parameter_range(index)].split_at_mut(inputs * outputs);
        for (neuron, row) in weights.chunks_exact(inputs).enumerate() {
            for (input, weight) in row.iter().enumerate() {
                to_weights[input * outputs + neuron] = *weight;
            }
        }
        to_biases.copy_from_slice(&biases);
    }
    Ok(())
}

fn copy(to: &mut [f32], from: &[f32], name: &str) -> Result<()> {
    if to.len() != from.len() {
        return Err(Error::invalid_input(format!(
            "{name} has {} numbers, but the action space has {} axes",
            from.len(),
            to.len()
        )));
    }
    to.copy_from_slice(from);
    Ok(())
}
