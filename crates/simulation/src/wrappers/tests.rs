use opendr_engine::Random;
use opendr_engine::environment::Environment;
use opendr_engine::params::ParamMap;

use super::*;
use crate::classic_control::{CartPole, CartPoleParams, Pendulum, PendulumParams};
use crate::{RegisteredEnvironment, Registry, make};

#[test]
fn a_time_limit_truncates_only() {
    let inner = Pendulum::new(&PendulumParams::default()).unwrap();
    let mut environment = TimeLimit::new(inner, 3).unwrap();
    let mut observation = [0.0; 3];
    for _ in 0..2 {
        environment.reset(Some(1), &ParamMap::new(), &mut observation).unwrap();
        let ends = [(); 3].map(|()| {
            let step = environment.step(&[0.0], &mut observation).unwrap();
            (step.terminated, step.truncated)
        });
        assert_eq!(ends, [(false, false), (false, false), (false, true)]);
    }
    assert!(TimeLimit::new(Pendulum::new(&PendulumParams::default()).unwrap(), 0).is_err());
}

#[test]
fn wrong_use_is_reported_and_changes_nothing() {
    let mut environment = make("Pendulum-v1").unwrap();
    let mut observation = [0.0; 3];
    assert!(environment.step(&[0.0], &mut observation).unwrap_err().to_string().contains("never reset"));
    assert!(environment.snapshot().is_err());
    assert!(environment.reset(Some(1), &ParamMap::new(), &mut [0.0; 2]).is_err());
    environment.reset(Some(1), &ParamMap::new(), &mut observation).unwrap();
    let before = environment.snapshot().unwrap();
    for wrong in [&[f32::NAN][..], &[2.5], &[f32::INFINITY], &[], &[0.0, 0.0]] {
        assert!(environment.step(wrong, &mut observation).is_err(), "{wrong:?}");
    }
    assert!(environment.step(&[0.0], &mut [0.0; 4]).is_err());
    assert_eq!(environment.snapshot().unwrap(), before);
    while !environment.step(&[0.0], &mut observation).unwrap().is_over() {}
    assert!(environment.step(&[0.0], &mut observation).unwrap_err().to_string().contains("is over"));
}

#[test]
fn a_restored_state_has_the_same_future() {
    for id in Registry::builtin().ids() {
        let mut environment = make(id).unwrap();
        let spec = environment.spec().clone();
        let mut observation = vec![0.0; spec.observation.len()];
        let mut random = Random::new(9);
        environment.reset(Some(5), &ParamMap::new(), &mut observation).unwrap();
        for _ in 0..5 {
            environment.step(&spec.action.sample(&mut random), &mut observation).unwrap();
        }
        let snapshot = environment.snapshot().unwrap();
        let actions: Vec<_> = (0..10).map(|_| spec.action.sample(&mut random)).collect();
        let run = |environment: &mut dyn Environment| -> Vec<_> {
            let mut observation = vec![0.0; spec.observation.len()];
            let mut steps = Vec::new();
            for action in &actions {
                let step = environment.step(action, &mut observation).unwrap();
                steps.push((step.clone(), observation.clone()));
                if step.is_over() {
                    environment.reset(None, &ParamMap::new(), &mut observation).unwrap();
                }
            }
            steps
        };
        let first = run(&mut *environment);
        let text = serde_json::to_string(&snapshot).unwrap();
        let mut other = make(id).unwrap();
        other.restore(&serde_json::from_str(&text).unwrap()).unwrap();
        assert_eq!(first, run(&mut *other), "{id}");
    }
}

#[test]
fn snapshots_of_others_are_refused() {
    let mut environment = make("CartPole-v1").unwrap();
    let mut observation = [0.0; 4];
    environment.reset(Some(1), &ParamMap::new(), &mut observation).unwrap();
    assert!(make("Acrobot-v1").unwrap().restore(&environment.snapshot().unwrap()).is_err());
    let mut bare = CartPole::new(&CartPoleParams::default()).unwrap();
    assert!(bare.restore(&environment.snapshot().unwrap()).is_err());
}

#[test]
fn frames_are_stacked_oldest_first() {
    let mut environment = FrameStack::new(make("MountainCar-v0").unwrap(), 3).unwrap();
    let mut single = make("MountainCar-v0").unwrap();
    let (mut observation, mut last) = (vec![0.0; 6], vec![0.0; 2]);
    assert_eq!(
        environment.spec().observation.to_string(),
        "Box([-1.2, -0.07, -1.2, -0.07, -1.2, -0.07], [0.6, 0.07, 0.6, 0.07, 0.6, 0.07], [3, 2])"
    );
    environment.reset(Some(4), &ParamMap::new(), &mut observation).unwrap();
    single.reset(Some(4), &ParamMap::new(), &mut last).unwrap();
    assert_eq!(observation, last.repeat(3));
    let mut expected = observation.clone();
    for _ in 0..4 {
        environment.step(&[2.0], &mut observation).unwrap();
        single.step(&[2.0], &mut last).unwrap();
        expected = [&expected[2..], &last].concat();
        assert_eq!(observation, expected);
    }
    assert!(environment.step(&[2.0], &mut last).is_err());
    assert!(FrameStack::new(make("MountainCar-v0").unwrap(), 0).is_err());
    assert!(FrameStack::new(make("MountainCar-v0").unwrap(), usize::MAX).is_err());
}

/// Gymnasium 1.4: `NormalizeReward(NormalizeObservation(make("Pendulum-v1")), gamma=0.9)` from seed 2, 30 steps with the
/// actions `((7 k) % 5 - 2) / 2`. It counts observations in single precision.
#[test]
fn normalisation_matches_gymnasium() {
    let inner = NormaliseObservation::new(make("Pendulum-v1").unwrap()).unwrap();
    let mut environment = NormaliseReward::new(inner, 0.9).unwrap();
    let mut observation = [0.0; 3];
    environment.reset(Some(2), &ParamMap::new(), &mut observation).unwrap();
    let mut reward = 0.0;
    for k in 0..30 {
        let action = [((k * 7) % 5 - 2) as f32 / 2.0];
        reward = environment.step(&action, &mut observation).unwrap().reward;
    }
    for (ours, theirs) in observation.into_iter().zip(OBSERVATION_OF_GYMNASIUM) {
        assert!((ours - theirs).abs() < 2e-5, "{ours} {theirs}");
    }
    assert!((reward - REWARD_OF_GYMNASIUM).abs() < 1e-9, "{reward}");
    assert!(NormaliseReward::new(make("Pendulum-v1").unwrap(), f64::NAN).is_err());
}

#[test]
fn merged_moments_do_not_depend_on_the_division() {
    let samples: Vec<_> = (0..50).map(|k| [f64::from(k * k % 17), f64::from(k) * 0.1]).collect();
    let mut all = RunningMoments::new(2);
    samples.iter().for_each(|sample| all.add(*sample));
    let [mut first, mut second] = [RunningMoments::new(2), RunningMoments::new(2)];
    samples[..20].iter().for_each(|sample| first.add(*sample));
    samples[20..].iter().for_each(|sample| second.add(*sample));
    first.merge(&second);
    let exact = samples.iter().map(|sample| sample[1]).sum::<f64>() / 50.0;
    assert!((all.mean()[1] - exact).abs() < 1e-4);
    for (one, other) in
        all.mean().iter().chain(all.variance()).zip(first.mean().iter().chain(first.variance()))
    {
        assert!((one - other).abs() < 1e-3, "{one} {other}");
    }
}

#[test]
fn episodes_are_counted() {
    let mut environment = RecordEpisodeStatistics::new(make("CartPole-v1").unwrap());
    let mut observation = [0.0; 4];
    for seed in 0..3 {
        environment.reset(Some(seed), &ParamMap::new(), &mut observation).unwrap();
        let mut steps = 0.0;
        let last = loop {
            let step = environment.step(&[1.0], &mut observation).unwrap();
            steps += 1.0;
            if step.is_over() {
                break step;
            }
            assert_eq!(step.info.get("episode_return"), None);
        };
        assert_eq!(last.info.get("episode_return"), Some(steps));
        assert_eq!(last.info.get("episode_length"), Some(steps));
    }
    assert_eq!(environment.last_episodes().len(), 3);
}

#[test]
fn snapshots_include_wrappers() {
    let make = || {
        let inner = NormaliseObservation::new(make("Pendulum-v1").unwrap()).unwrap();
        let inner = FrameStack::new(NormaliseReward::new(inner, 0.99).unwrap(), 2).unwrap();
        RecordEpisodeStatistics::new(inner)
    };
    let (mut one, mut other, mut observation) = (make(), make(), [0.0; 6]);
    one.reset(Some(1), &ParamMap::new(), &mut observation).unwrap();
    one.step(&[1.0], &mut observation).unwrap();
    other.restore(&one.snapshot().unwrap()).unwrap();
    let mut observation_there = [0.0; 6];
    for _ in 0..5 {
        let (here, there) =
            (one.step(&[-0.5], &mut observation), other.step(&[-0.5], &mut observation_there));
        assert_eq!((here.unwrap(), observation), (there.unwrap(), observation_there));
    }
}

const OBSERVATION_OF_GYMNASIUM: [f32; 3] = [-1.076_754_7, -0.957_770_2, 1.627_924_1];
const REWARD_OF_GYMNASIUM: f64 = -0.634_611_027_249_364;
