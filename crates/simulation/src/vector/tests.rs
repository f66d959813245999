use opendr_engine::environment::{Environment, Info, ResetOptions, Step};
use opendr_engine::{Random, Result};

use super::*;
use crate::classic_control::CartPoleParams;
use crate::make;

const MODES: [Autoreset; 3] = [Autoreset::NextStep, Autoreset::SameStep, Autoreset::Disabled];

fn several(id: &str, count: usize, mode: Autoreset, threads: usize) -> EnvironmentVector {
    let environments = (0..count).map(|_| make(id).unwrap()).collect();
    EnvironmentVector::new(environments, mode, threads).unwrap()
}

/// Returns the batches of `steps` steps from seed 3; resets ended episodes if the mode does not.
fn played(vector: &mut dyn VecEnvironment, steps: usize) -> Vec<Batch> {
    let (spec, count) = (vector.spec().clone(), vector.count());
    let (mut batch, mut random) = (Batch::new(&spec, count), Random::new(7));
    let mut actions = vec![0.0; spec.action.len() * count];
    vector.reset(Seeds::From(3), &ResetOptions::new(), None, &mut batch).unwrap();
    let mut batches = vec![batch.clone()];
    for _ in 0..steps {
        for action in actions.chunks_mut(spec.action.len()) {
            spec.action.sample_into(&mut random, action);
        }
        vector.step(&actions, &mut batch).unwrap();
        batches.push(batch.clone());
        let over: Vec<_> = batch.terminated.iter().zip(&batch.truncated).map(|(a, b)| a | b).collect();
        if vector.autoreset() == Autoreset::Disabled && over.contains(&true) {
            vector.reset(Seeds::Random, &ResetOptions::new(), Some(&over), &mut batch).unwrap();
        }
    }
    batches
}

#[test]
fn threads_change_nothing() {
    for mode in MODES {
        let expected = played(&mut several("Pendulum-v1", 7, mode, 1), 210);
        for threads in [2, 3, 20] {
            assert_eq!(
                played(&mut several("Pendulum-v1", 7, mode, threads), 210),
                expected,
                "{mode:?} {threads}"
            );
        }
    }
}

#[test]
fn carts_in_arrays_are_single_carts() {
    for mode in MODES {
        let mut arrays = CartPoleVector::new(&CartPoleParams::default(), 13, mode).unwrap();
        assert_eq!(
            played(&mut arrays, 150),
            played(&mut several("CartPole-v1", 13, mode, 1), 150),
            "{mode:?}"
        );
    }
}

/// Snapshots do not depend on threads or arrays, and every vector continues from them the same way.
#[test]
fn all_continue_from_a_snapshot() {
    let arrays = |mode| Box::new(CartPoleVector::new(&CartPoleParams::default(), 5, mode).unwrap());
    for mode in [Autoreset::NextStep, Autoreset::SameStep] {
        let mut makers: [Box<dyn VecEnvironment>; 3] = [
            Box::new(several("CartPole-v1", 5, mode, 1)),
            Box::new(several("CartPole-v1", 5, mode, 3)),
            arrays(mode),
        ];
        assert!(makers.iter().all(|vector| vector.snapshot().is_err()));
        // Long enough that some episodes have ended.
        let played: Vec<_> = makers.iter_mut().map(|vector| played(&mut **vector, 40)).collect();
        assert!(played.iter().all(|batches| *batches == played[0]));
        let snapshots: Vec<_> = makers.iter().map(|vector| vector.snapshot().unwrap()).collect();
        assert!(snapshots.iter().all(|snapshot| *snapshot == snapshots[0]));
        let on = |vector: &mut dyn VecEnvironment| -> Vec<Batch> {
            let mut batch = Batch::new(vector.spec(), 5);
            (0..60)
                .map(|step| {
                    vector.step(&[(step % 2) as f32; 5], &mut batch).unwrap();
                    batch.clone()
                })
                .collect()
        };
        let expected = on(&mut *makers[0]);
        assert!(expected.iter().any(|batch| batch.terminated.contains(&true)));
        for vector in &mut makers {
            vector.restore(&snapshots[0]).unwrap();
            let got = on(&mut **vector);
            assert!(
                got.iter().zip(&expected).all(|(got, expected)| got.observations == expected.observations
                    && got.terminated == expected.terminated)
            );
        }
        let mut fewer = several("CartPole-v1", 4, mode, 1);
        assert!(fewer.restore(&snapshots[0]).is_err());
    }
}

/// Compares the order of events with Gymnasium, for a cart that falls after a few pushes.
#[test]
fn autoreset_matches_gymnasium() {
    let ends = |mode| {
        let mut vector = several("CartPole-v1", 1, mode, 1);
        let mut batch = Batch::new(vector.spec(), 1);
        vector.reset(Seeds::From(1), &ResetOptions::new(), None, &mut batch).unwrap();
        let mut single = make("CartPole-v1").unwrap();
        let mut observation = vec![0.0; 4];
        single.reset(Some(1), &ResetOptions::new(), &mut observation).unwrap();
        while !batch.terminated[0] {
            vector.step(&[1.0], &mut batch).unwrap();
            single.step(&[1.0], &mut observation).unwrap();
        }
        let last = observation.clone();
        single.reset(None, &ResetOptions::new(), &mut observation).unwrap();
        (vector, batch, last, observation)
    };
    let (mut vector, mut batch, last, first) = ends(Autoreset::NextStep);
    assert_eq!(batch.observations, last);
    vector.step(&[1.0], &mut batch).unwrap();
    assert_eq!((&batch.observations, batch.rewards[0], batch.terminated[0]), (&first, 0.0, false));

    let (_, batch, last, first) = ends(Autoreset::SameStep);
    assert_eq!((batch.observations, batch.final_observations, batch.rewards[0]), (first, last, 1.0));

    let (mut vector, mut batch, ..) = ends(Autoreset::Disabled);
    let error = vector.step(&[1.0], &mut batch).unwrap_err().to_string();
    assert!(error.starts_with("environment 0: the episode is over"), "{error}");
}

#[test]
fn wrong_sizes_and_actions_are_reported() {
    for mut vector in [
        Box::new(several("CartPole-v1", 3, Autoreset::NextStep, 2)) as Box<dyn VecEnvironment>,
        Box::new(CartPoleVector::new(&CartPoleParams::default(), 3, Autoreset::NextStep).unwrap()),
    ] {
        let mut batch = Batch::new(vector.spec(), 3);
        assert!(vector.step(&[0.0; 3], &mut batch).is_err());
        let none = ResetOptions::new();
        assert!(vector.reset(Seeds::Each(&[None; 2]), &none, None, &mut batch).is_err());
        assert!(vector.reset(Seeds::Random, &none, Some(&[false; 3]), &mut batch).is_err());
        let mut small = Batch::new(vector.spec(), 2);
        assert!(vector.reset(Seeds::Random, &none, None, &mut small).is_err());
        vector.reset(Seeds::From(0), &none, None, &mut batch).unwrap();
        assert!(vector.step(&[0.0; 2], &mut batch).is_err());
        let error = vector.step(&[0.0, 1.0, f32::NAN], &mut batch).unwrap_err().to_string();
        assert!(error.starts_with("environment 2: action of CartPole-v1: number 0 is NaN"), "{error}");
        vector.step(&[0.0, 1.0, 1.0], &mut batch).unwrap();
    }
    assert!(CartPoleVector::new(&CartPoleParams::default(), 0, Autoreset::NextStep).is_err());
    assert!(make_mixed().is_err());
}

fn make_mixed() -> Result<EnvironmentVector> {
    let environments = vec![make("CartPole-v1")?, make("Acrobot-v1")?];
    EnvironmentVector::new(environments, Autoreset::NextStep, 1)
}

/// Panics in its second step.
struct Faulty(Box<dyn Environment>, u32);

impl Environment for Faulty {
    fn spec(&self) -> &EnvironmentSpec {
        self.0.spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        self.0.reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.1 += 1;
        assert!(self.1 < 2, "a fault");
        self.0.step(action, observation)
    }
}

#[test]
fn a_panic_of_a_thread_is_an_error() {
    let faulty = Box::new(Faulty(make("CartPole-v1").unwrap(), 0));
    let mut vector =
        EnvironmentVector::new(vec![make("CartPole-v1").unwrap(), faulty], Autoreset::NextStep, 2).unwrap();
    let mut batch = Batch::new(vector.spec(), 2);
    vector.reset(Seeds::From(0), &ResetOptions::new(), None, &mut batch).unwrap();
    vector.step(&[0.0; 2], &mut batch).unwrap();
    assert!(vector.step(&[0.0; 2], &mut batch).unwrap_err().to_string().contains("panicked"));
    assert!(vector.step(&[0.0; 2], &mut batch).is_err());
}

/// Takes steps with fixed actions and returns the batches.
fn played_on(vector: &mut dyn VecEnvironment, actions: &[f32]) -> Vec<Batch> {
    let mut batch = Batch::new(vector.spec(), vector.count());
    let mut step = || {
        vector.step(actions, &mut batch).unwrap();
        batch.clone()
    };
    (0..60).map(|_| step()).collect()
}

#[test]
fn states_are_restored_with_any_number_of_threads() {
    for mode in [Autoreset::NextStep, Autoreset::SameStep] {
        let carts = || CartPoleVector::new(&CartPoleParams::default(), 5, mode).unwrap();
        let pairs: [[Box<dyn VecEnvironment>; 2]; 2] = [
            [Box::new(carts()), Box::new(carts())],
            [Box::new(several("CartPole-v1", 5, mode, 1)), Box::new(several("CartPole-v1", 5, mode, 3))],
        ];
        for [mut vector, mut other] in pairs {
            assert!(vector.snapshot().is_err());
            played(&mut *vector, 37);
            let snapshot = vector.snapshot().unwrap();
            let expected = played_on(&mut *vector, &[1.0, 0.0, 1.0, 1.0, 0.0]);
            other.restore(&snapshot).unwrap();
            let got = played_on(&mut *other, &[1.0, 0.0, 1.0, 1.0, 0.0]);
            // Final observations are leftovers where no episode ended.
            for (got, expected) in got.iter().zip(&expected) {
                assert_eq!(got.observations, expected.observations, "{mode:?}");
                assert_eq!(got.terminated, expected.terminated, "{mode:?}");
            }
            assert!(several("CartPole-v1", 4, mode, 1).restore(&snapshot).is_err());
        }
    }
}
