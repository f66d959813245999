//! Online adaptation on `QuadTrack-v1`, around a network that was not trained: its adapter keeps the limits all the same.

use opendr_control::online::{
    AdaptablePolicy, AdaptationParams, Calibration, EventKind, FreezeReason, NeuralPolicy, OnlineAdapter,
};
use opendr_control::{PidGains, TrackingPid};
use opendr_engine::environment::{Controller, Environment as _, EnvironmentSpec, ResetOptions, Space};
use opendr_engine::{ErrorKind, Random, Result};
use opendr_rl::{Bounds, Head, NetworkConfig, ParameterInit, Policy};
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::quad_track::{CONTROL_PERIOD, QuadTrack, QuadTrackParams};
use opendr_test_allocator::allocations_of_thread;

fn law() -> TrackingPid {
    let spec = QuadTrack::new(&QuadTrackParams::default()).unwrap().spec().clone();
    let gains = PidGains { kp: 5.0, kd: 5.0, filter: 0.0, limit: 8.0, ..PidGains::default() };
    TrackingPid::new(spec.tracking.unwrap().layout, &[gains; 3], CONTROL_PERIOD).unwrap()
}

/// The law plus a constant for each axis, its only parameters: what a policy of a user's own can be.
#[derive(Debug, Clone)]
struct Trimmed {
    law: TrackingPid,
    trim: [f32; 3],
}

impl AdaptablePolicy for Trimmed {
    fn parameters(&self) -> &[f32] {
        &self.trim
    }

    fn parameters_mut(&mut self) -> &mut [f32] {
        &mut self.trim
    }

    fn last_layer(&self) -> std::ops::Range<usize> {
        0..3
    }

    fn outputs(&self) -> usize {
        3
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.law.act(observation, action)?;
        action.iter_mut().zip(&self.trim).for_each(|(action, trim)| *action += trim);
        Ok(())
    }

    fn backward(&mut self, daction: &[f32], gradients: &mut [f32]) -> Result<()> {
        gradients.iter_mut().zip(daction).for_each(|(gradient, own)| *gradient += own);
        Ok(())
    }
}

fn adapter(params: AdaptationParams) -> (OnlineAdapter<Trimmed>, QuadTrack) {
    let track = QuadTrack::new(&QuadTrackParams::default()).unwrap();
    let base = Trimmed { law: law(), trim: [0.0; 3] };
    let adapter = OnlineAdapter::new(base, track.spec(), None, params).unwrap();
    (adapter, track)
}

fn options(pairs: &[(&str, f64)]) -> ResetOptions {
    pairs.iter().map(|(name, value)| ((*name).to_owned(), (*value).into())).collect()
}

/// RMS errors from 30 s on.
fn fly(controller: &mut dyn Controller, track: &mut QuadTrack, pairs: &[(&str, f64)]) -> f64 {
    let (mut seen, mut action) = ([0.0; 17], [0.0; 3]);
    track.reset(Some(5), &options(pairs), &mut seen).unwrap();
    controller.reset();
    let mut sum = 0.0;
    for step in 0..6000 {
        controller.act(&seen, &mut action).unwrap();
        let outcome = track.step(&action, &mut seen).unwrap();
        assert!(!outcome.terminated);
        if step >= 3000 {
            sum += outcome.info.get("error").unwrap().powi(2);
        }
    }
    (sum / 3000.0).sqrt()
}

#[test]
fn a_load_is_learned_and_logged() {
    let (mut adapter, mut track) = adapter(AdaptationParams::default());
    let heavy = [("mass_factor", 1.3)];
    let frozen = fly(&mut law(), &mut track, &heavy);
    let adapted = fly(&mut adapter, &mut track, &heavy);
    assert!(adapted < 0.5 * frozen, "{adapted} {frozen}");
    assert!(adapter.log().count(EventKind::Snapshot) > 3 && !adapter.is_disarmed());
    assert!(adapter.log().count(EventKind::Frozen(FreezeReason::Stale)) > 0);
    assert_eq!(adapter.base().trim, [0.0; 3], "the base is never changed");
    let trim = adapter.adapted().trim[2];
    assert!((1.5..4.5).contains(&trim), "0.3 g are 2.9 m/s^2: {trim}");
}

/// A sign-flipped signal is found out by the monitor.
#[test]
fn a_wrong_signal_is_rolled_back() {
    for pairs in [&[][..], &[("mass_factor", 1.3)], &[("wind", 5.0)]] {
        let (adapter, mut track) = adapter(AdaptationParams::default());
        let frozen = fly(&mut law(), &mut track, pairs);
        let mut flipped = adapter.with_flipped_signal();
        let error = fly(&mut flipped, &mut track, pairs);
        assert!(error <= 1.3 * frozen, "{pairs:?}: {error} {frozen}");
        assert!(flipped.is_disarmed() && flipped.distance() == 0.0);
        assert_eq!(flipped.log().count(EventKind::Disarmed), 1);
    }
}

#[test]
fn commands_stay_in_the_band() {
    let (mut adapter, mut track) = adapter(AdaptationParams { band: 0.5, ..AdaptationParams::default() });
    let task = track.spec().tracking.clone().unwrap();
    let mut law = TrackingPid::conventional(&task, &[-8.0; 3], &[8.0; 3]).unwrap();
    let (mut seen, mut action, mut conventional) = ([0.0; 17], [0.0; 3], [0.0; 3]);
    // Without a delay or a failure every estimate is new: the law acts on what the adapter acts on.
    let changes = [("mass_factor", 1.4), ("change_at", 0.0), ("estimate_delay", 0.0), ("dropouts", 0.0)];
    track.reset(Some(1), &options(&changes), &mut seen).unwrap();
    for _ in 0..1000 {
        adapter.act(&seen, &mut action).unwrap();
        law.act(&seen, &mut conventional).unwrap();
        for axis in 0..3 {
            assert!((action[axis] - conventional[axis]).abs() < 0.5 + 1e-4);
        }
        track.step(&action, &mut seen).unwrap();
    }
    assert!(adapter.log().count(EventKind::Guarded) > 0);
    assert!(adapter.distance() < 2.0, "what is cut off is not asked for more and more");
}

#[test]
fn a_recording_is_learned_again_bit_for_bit() {
    let (mut flown, mut track) = adapter(AdaptationParams::default());
    flown.record(10_000);
    let (mut seen, mut action) = ([0.0; 17], [0.0; 3]);
    track.reset(Some(1), &options(&[("wind", 5.0), ("change_at", 1.0)]), &mut seen).unwrap();
    for _ in 0..1500 {
        flown.act(&seen, &mut action).unwrap();
        track.step(&action, &mut seen).unwrap();
    }
    let (mut again, _) = adapter(AdaptationParams::default());
    again.replay(flown.recording()).unwrap();
    assert_eq!((again.adapted().trim, again.log()), (flown.adapted().trim, flown.log()));
    assert!(flown.distance() > 0.0);
}

fn network(track: &QuadTrack) -> NeuralPolicy {
    let bounds = Bounds { low: vec![-8.0; 3], high: vec![8.0; 3] };
    let mut policy =
        Policy::new(track.spec(), Head::Squashed(bounds), &NetworkConfig::default(), None).unwrap();
    policy.initialise(ParameterInit::Orthogonal(0.1), 0.0, &mut Random::new(1));
    NeuralPolicy::new(policy).unwrap()
}

/// With features of the reference, as the protocol flies.
#[test]
fn steps_allocate_nothing() {
    let mut track = QuadTrack::new(&QuadTrackParams::default()).unwrap();
    let policy = network(&track);
    let Calibration { envelope, features } = Calibration::fly(&policy, &mut track).unwrap();
    let mut adapter =
        OnlineAdapter::new(policy, track.spec(), Some(envelope), AdaptationParams::default()).unwrap();
    adapter = adapter.with_features(features).unwrap();
    let (mut seen, mut action) = ([0.0; 17], [0.0; 3]);
    let heavy = options(&[("mass_factor", 1.3), ("change_at", 1.0)]);
    track.reset(Some(1), &heavy, &mut seen).unwrap();
    let mut before = 0;
    for step in 0..2000 {
        if step == 1 {
            before = allocations_of_thread();
        }
        adapter.act(&seen, &mut action).unwrap();
        track.step(&action, &mut seen).unwrap();
    }
    let after = allocations_of_thread();
    assert_eq!(after - before, 0);
    assert!(adapter.steps()[1] > 300, "{:?}", adapter.steps());
}

/// Policies and environments that cannot be adapted are refused, and the error says why.
#[test]
fn what_cannot_be_adapted_is_refused() {
    let track = QuadTrack::new(&QuadTrackParams::default()).unwrap();
    let refused = |policy: NeuralPolicy, spec: &EnvironmentSpec| {
        let error = OnlineAdapter::new(policy, spec, None, AdaptationParams::default()).err().unwrap();
        assert_eq!(error.kind(), ErrorKind::Unsupported, "{error}");
        error.to_string()
    };
    let mut spec = track.spec().clone();
    spec.tracking = None;
    assert!(refused(network(&track), &spec).contains("states no tracking task"));
    let mut spec = track.spec().clone();
    spec.action = Space::symmetric(&[8.0; 4]);
    assert!(refused(network(&track), &spec).contains("a box of 3 numbers"));
    let choices = Head::Categorical { counts: vec![2, 2, 2], start: 0 };
    let policy = Policy::new(track.spec(), choices, &NetworkConfig::default(), None).unwrap();
    assert!(refused(NeuralPolicy::new(policy).unwrap(), track.spec()).contains("no gradient"));
}

/// An observation with a number that is none changes nothing.
#[test]
fn broken_observations_are_refused() {
    let (mut adapter, mut track) = adapter(AdaptationParams::default());
    let (mut seen, mut action) = ([0.0; 17], [0.0; 3]);
    track.reset(Some(1), &options(&[]), &mut seen).unwrap();
    adapter.act(&seen, &mut action).unwrap();
    let mut broken = seen;
    broken[4] = f32::NAN;
    assert_eq!(adapter.act(&broken, &mut action).unwrap_err().kind(), ErrorKind::InvalidInput);
    assert!(adapter.act(&seen[1..], &mut action).is_err());
    let steps = adapter.steps();
    adapter.act(&seen, &mut action).unwrap();
    assert_eq!(adapter.steps()[0], steps[0] + 1);
    assert!(action.iter().all(|command| command.is_finite()));
}

#[test]
fn adapted_policies_are_models_of_their_own() {
    let mut track = QuadTrack::new(&QuadTrackParams::default()).unwrap();
    let make = |track: &QuadTrack| {
        OnlineAdapter::new(network(track), track.spec(), None, AdaptationParams::default()).unwrap()
    };
    let mut adapter = make(&track);
    let (mut seen, mut action) = ([0.0; 17], [0.0; 3]);
    track.reset(Some(1), &options(&[]), &mut seen).unwrap();
    for _ in 0..200 {
        adapter.act(&seen, &mut action).unwrap();
        track.step(&action, &mut seen).unwrap();
    }
    let path = std::env::temp_dir().join(format!("opendr-adapted-{}", std::process::id()));
    let model = adapter.save(&path, "QuadTrack-v1", 1_700_000_000).unwrap();
    assert!(adapter.save(&path, "QuadTrack-v1", 0).is_err(), "nothing is replaced");
    let mut other = make(&track);
    let lineage = other.load(&model).unwrap();
    assert_eq!((lineage.steps, lineage.adapted_on.as_str()), (200, "QuadTrack-v1"));
    assert_eq!(other.adapted().parameters(), adapter.adapted().parameters());
    std::fs::remove_dir_all(path).unwrap();
}
