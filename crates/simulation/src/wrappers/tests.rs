use opendr_engine::Random;
use opendr_engine::environment::Environment;
use opendr_engine::params::ParamMap;

use super::*;
use crate::classic_control::{CartPole, CartPoleParams, Pendulum, PendulumParams};
use crate::{Registered, Registry, make};

#[test]
fn a_time_limit_truncates_only() {
    let inner = Pendulum::new(&PendulumParams::default()).unwrap();
    let mut environment = TimeLimit::new(inner, 3).unwrap();
    let mut seen = [0.0; 3];
    for _ in 0..2 {
        environment.reset(Some(1), &ParamMap::new(), &mut seen).unwrap();
        let ends = [(); 3].map(|()| {
            let step = environment.step(&[0.0], &mut seen).unwrap();
            (step.terminated, step.truncated)
        });
        assert_eq!(ends, [(false, false), (false, false), (false, true)]);
    }
    assert!(TimeLimit::new(Pendulum::new(&PendulumParams::default()).unwrap(), 0).is_err());
}

#[test]
fn wrong_use_is_told_and_changes_nothing() {
    let mut environment = make("Pendulum-v1").unwrap();
    let mut seen = [0.0; 3];
    assert!(environment.step(&[0.0], &mut seen).unwrap_err().to_string().contains("never reset"));
    assert!(environment.snapshot().is_err());
    assert!(environment.reset(Some(1), &ParamMap::new(), &mut [0.0; 2]).is_err());
    environment.reset(Some(1), &ParamMap::new(), &mut seen).unwrap();
    let before = environment.snapshot().unwrap();
    for wrong in [&[f32::NAN][..], &[2.5], &[f32::INFINITY], &[], &[0.0, 0.0]] {
        assert!(environment.step(wrong, &mut seen).is_err(), "{wrong:?}");
    }
    assert!(environment.step(&[0.0], &mut [0.0; 4]).is_err());
    assert_eq!(environment.snapshot().unwrap(), before);
    while !environment.step(&[0.0], &mut seen).unwrap().is_over() {}
    assert!(environment.step(&[0.0], &mut seen).unwrap_err().to_string().contains("is over"));
}

#[test]
fn a_restored_state_has_the_same_future() {
    for id in Registry::builtin().ids() {
        let mut environment = make(id).unwrap();
        let spec = environment.spec().clone();
        let mut seen = vec![0.0; spec.observation.len()];
        let mut random = Random::new(9);
        environment.reset(Some(5), &ParamMap::new(), &mut seen).unwrap();
        for _ in 0..5 {
            environment.step(&spec.action.sample(&mut random), &mut seen).unwrap();
        }
        let snapshot = environment.snapshot().unwrap();
        let actions: Vec<_> = (0..10).map(|_| spec.action.sample(&mut random)).collect();
        let run = |environment: &mut dyn Environment| -> Vec<_> {
            let mut seen = vec![0.0; spec.observation.len()];
            let mut steps = Vec::new();
            for action in &actions {
                let step = environment.step(action, &mut seen).unwrap();
                steps.push((step.clone(), seen.clone()));
                if step.is_over() {
                    environment.reset(None, &ParamMap::new(), &mut seen).unwrap();
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
    let mut seen = [0.0; 4];
    environment.reset(Some(1), &ParamMap::new(), &mut seen).unwrap();
    assert!(make("Acrobot-v1").unwrap().restore(&environment.snapshot().unwrap()).is_err());
    let mut bare = CartPole::new(&CartPoleParams::default()).unwrap();
    assert!(bare.restore(&environment.snapshot().unwrap()).is_err());
}
