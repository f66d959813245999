//! Exports policies to ONNX with some of their actions, for a comparison with ONNX Runtime:
//! `cargo run -p opendr-rl --example export_policy FOLDER`, then `python tests/rl/compare_onnx.py FOLDER`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use opendr_engine::environment::{EnvironmentSpec, Space};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;
use opendr_rl::{
    ActionMode, Algorithm as _, Head, ImageNetwork, NetworkConfig, ParameterInit, Policy, PolicyMemory, Ppo,
    PpoConfig, Sac, SacConfig, onnx_from_policy,
};
use opendr_simulation::make_vec;
use opendr_simulation::vector::{Autoreset, VectorOptions};

fn main() -> Result<()> {
    let folder = std::env::args_os().nth(1).map(PathBuf::from);
    let folder = folder.ok_or_else(|| Error::invalid_param("no output folder; give one as argument"))?;
    std::fs::create_dir_all(&folder)?;
    let options = VectorOptions { autoreset: Autoreset::SameStep, ..VectorOptions::new(4) };

    let mut carts = make_vec("CartPole-v1", options)?;
    let config = PpoConfig { n_steps: 128, norm_obs: true, ..PpoConfig::default() };
    let mut ppo = Ppo::new(&config, carts.spec())?;
    ppo.iterate(&mut *carts, 10_000)?;
    export(&folder, "ppo_cart_pole", ppo.policy())?;

    let mut pendulums = make_vec("Pendulum-v1", options)?;
    let mut ppo = Ppo::new(&config, pendulums.spec())?;
    ppo.iterate(&mut *pendulums, 10_000)?;
    export(&folder, "ppo_pendulum", ppo.policy())?;
    let mut sac = Sac::new(&SacConfig::default(), pendulums.spec())?;
    (0..40).try_for_each(|_| sac.iterate(&mut *pendulums, 10_000).map(drop))?;
    export(&folder, "sac_pendulum", sac.policy())?;

    let choices = EnvironmentSpec::new(
        "choices",
        Space::symmetric(&[1.0; 4 * 3 + 2]),
        Space::Discrete { n: 4, start: 1 },
    );
    let mut policy =
        Policy::new(&choices, Head::stochastic(&choices.action)?, &NetworkConfig::default(), None)?;
    policy.score_choices(3)?;
    policy.initialise(ParameterInit::Orthogonal(1.0), 0.0, &mut Random::new(5));
    export(&folder, "choices", &policy)?;

    let parts =
        [("depth", Space::uniform(0.0, 15.0, &[64, 64, 1])?), ("target", Space::symmetric(&[5.0; 3]))];
    let observation = Space::Dict(parts.map(|(name, part)| (name.to_owned(), part)).into());
    for (name, picture_network, gru_size, action) in [
        ("depth_small", ImageNetwork::Small, None, Space::symmetric(&[1.0, 1.0])),
        ("depth_nature", ImageNetwork::Nature, None, Space::MultiDiscrete(vec![3, 4])),
        ("depth_memory", ImageNetwork::Small, Some(24), Space::MultiBinary(vec![3])),
    ] {
        let spec = EnvironmentSpec::new(name, observation.clone(), action);
        let config = NetworkConfig { image_network: picture_network, gru_size, ..NetworkConfig::default() };
        let mut policy = Policy::new(&spec, Head::stochastic(&spec.action)?, &config, Some(10.0))?;
        policy.initialise(ParameterInit::Orthogonal(1.0), 0.0, &mut Random::new(5));
        export(&folder, name, &policy)?;
    }
    Ok(())
}

/// Writes the model, and the actions for random observations, in three steps of 32 rows.
fn export(folder: &Path, name: &str, policy: &Policy) -> Result<()> {
    std::fs::write(folder.join(format!("{name}.onnx")), onnx_from_policy(policy)?)?;
    let (mut random, rows) = (Random::new(3), 3 * 32);
    let observations: Vec<f32> = (0..rows).flat_map(|_| policy.observation().sample(&mut random)).collect();
    let observations: Vec<f32> = observations.iter().map(|number| number.clamp(-50.0, 50.0)).collect();
    let mut actions = vec![0.0; rows * policy.action().len()];
    let (compute, mut memory) = (Compute::single(), PolicyMemory::default());
    let steps = observations.chunks_exact(observations.len() / 3);
    for (observations, actions) in steps.zip(actions.chunks_exact_mut(32 * policy.action().len())) {
        policy.act(&compute, observations, ActionMode::Deterministic, &mut memory, actions)?;
    }
    let record = BTreeMap::from([("observations", observations), ("actions", actions)]);
    let json = serde_json::to_vec(&record)
        .map_err(|error| Error::internal("the actions cannot be written as JSON").with_source(error))?;
    Ok(std::fs::write(folder.join(format!("{name}.json")), json)?)
}
