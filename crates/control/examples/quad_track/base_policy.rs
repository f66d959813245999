//! The controllers of the protocol: tuned PID, conventional law, and the network that imitates it.

use std::ops::ControlFlow;

use opendr_control::online::{Calibration, NeuralPolicy, OnlineAdapter};
use opendr_control::{TrackingPid, quad_track_gains};
use opendr_engine::environment::{Controller, Environment as _, EnvironmentSpec, ResetOptions, TrackingTask};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;
use opendr_rl::{
    BehaviourCloningConfig, Bounds, Demonstrations, Head, NetworkConfig, ParameterInit, Policy,
    clone_behaviour,
};
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::quad_track::{CONTROL_PERIOD, MAX_ACCELERATION, QuadTrack, QuadTrackParams};

use crate::settings::Settings;

pub fn task(spec: &EnvironmentSpec) -> Result<&TrackingTask> {
    spec.tracking.as_ref().ok_or_else(|| Error::internal("QuadTrack-v1 states no tracking task"))
}

pub fn tuned_pid() -> Result<TrackingPid> {
    let spec = QuadTrack::new(&QuadTrackParams::default())?.spec().clone();
    TrackingPid::new(task(&spec)?.layout, &quad_track_gains(), CONTROL_PERIOD)
}

pub struct Base {
    pub policy: NeuralPolicy,
    pub spec: EnvironmentSpec,
    pub calibration: Calibration,
    /// RMS difference of the imitation's commands, m/s^2.
    pub difference: f64,
}

impl Base {
    pub fn adapter(&self, settings: &Settings) -> Result<OnlineAdapter<NeuralPolicy>> {
        let Calibration { envelope, features } = self.calibration.clone();
        OnlineAdapter::new(self.policy.clone(), &self.spec, Some(envelope), settings.params.clone())?
            .with_features(features)
    }
}

/// Trains a network to imitate the conventional law on nominal flights, with errors and references spread about those that occur.
pub fn train(seed: u64) -> Result<Base> {
    let mut track = QuadTrack::new(&QuadTrackParams::default())?;
    let spec = track.spec().clone();
    let (observations, actions) = imitated(&mut track, seed)?;
    let bounds = Bounds { low: vec![-MAX_ACCELERATION; 3], high: vec![MAX_ACCELERATION; 3] };
    // One wide layer: its units still reproduce every number of the reference, which a second layer mixes with the errors.
    let network = NetworkConfig { net_arch: vec![128], ..NetworkConfig::default() };
    let mut policy = Policy::new(&spec, Head::Squashed(bounds), &network, Some(10.0))?;
    policy.initialise(ParameterInit::Orthogonal(0.1), 0.0, &mut Random::from_key([seed, 3]));
    let demonstrations = Demonstrations::new(&spec, observations, actions)?;
    let compute = Compute::single();
    let mut loss = 0.0;
    for (learning_rate, n_epochs) in [(2e-3, 10), (5e-4, 6), (1e-4, 4)] {
        let config =
            BehaviourCloningConfig { learning_rate, batch_size: 128, n_epochs, ent_weight: 0.0, seed };
        let mut observer = |_, mean| {
            loss = mean;
            ControlFlow::Continue(())
        };
        clone_behaviour(&mut policy, &demonstrations, &config, &compute, &mut observer)?;
    }
    let difference = f64::from(MAX_ACCELERATION) * (loss / 3.0).sqrt();
    let policy = NeuralPolicy::new(policy)?;
    let calibration = Calibration::fly(&policy, &mut track)?;
    Ok(Base { policy, spec, difference, calibration })
}

/// Observations of nominal flights with spread errors, and the conventional law's commands.
fn imitated(track: &mut QuadTrack, seed: u64) -> Result<(Vec<f32>, Vec<f32>)> {
    let spec = track.spec().clone();
    let mut law = TrackingPid::conventional(task(&spec)?, &[-MAX_ACCELERATION; 3], &[MAX_ACCELERATION; 3])?;
    let mut random = Random::from_key([seed, 1]);
    let (mut observation, mut action) = (vec![0.0; spec.observation.len()], [0.0; 3]);
    let (mut observations, mut actions) = (Vec::new(), Vec::new());
    for flight in 0..12 {
        track.reset(Some(5000 + 100 * seed + flight), &ResetOptions::new(), &mut observation)?;
        for _ in 0..4000 {
            let mut spread = observation.clone();
            let wide = 0.2 + 0.8 * random.unit();
            let deviations = [0.4 * wide, 0.4 * wide, 0.1, 0.3, 0.3];
            for (at, number) in spread[..15].iter_mut().enumerate() {
                *number += (deviations[at / 3] * random.normal()) as f32;
            }
            spread[15] = random.uniform(0.0, 0.4);
            spread[16] = f32::from(random.chance(0.5));
            let mut label = [0.0; 3];
            law.act(&spread, &mut label)?;
            observations.extend_from_slice(&spread);
            actions.extend_from_slice(&label);
            law.act(&observation, &mut action)?;
            track.step(&action, &mut observation)?;
        }
    }
    Ok((observations, actions))
}
