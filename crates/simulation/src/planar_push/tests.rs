use opendr_engine::Random;
use opendr_engine::environment::{Controller as _, Environment, ResetOptions};
use opendr_engine::params::ParamValue;

use super::*;
use crate::{RegisteredEnvironment as _, make};

fn demonstrate(environment: &mut dyn Environment, seed: u64) -> (bool, usize) {
    let (mut seen, mut action) = ([0.0; OBSERVATION_LEN], [0.0; 2]);
    let mut teacher = PushTeacher::default();
    environment.reset(Some(seed), &ResetOptions::new(), &mut seen).unwrap();
    for step in 1.. {
        teacher.act(&seen, &mut action).unwrap();
        let outcome = environment.step(&action, &mut seen).unwrap();
        if outcome.is_over() {
            return (outcome.info.success().unwrap(), step);
        }
    }
    unreachable!()
}

#[test]
fn the_teacher_reaches_the_goal() {
    let mut environment = make("PlanarPush-v1").unwrap();
    let runs: Vec<_> = (0..20).map(|seed| demonstrate(&mut *environment, seed)).collect();
    let successes = runs.iter().filter(|(success, _)| *success).count();
    assert!(successes >= 19, "{runs:?}");
}

/// Pushes towards the T.
fn straight(seen: &[f32; OBSERVATION_LEN]) -> [f32; 2] {
    [0, 1].map(|axis| (5.0 * (seen[2 + axis] - seen[axis])).clamp(-1.0, 1.0))
}

/// Pushes of this version: others need another version of the environment.
#[test]
fn the_golden_trajectory_is_the_same_on_every_machine() {
    let mut environment = PlanarPush::new(&PlanarPushParams::default()).unwrap();
    let mut seen = [0.0; OBSERVATION_LEN];
    environment.reset(Some(42), &ResetOptions::new(), &mut seen).unwrap();
    let mut hash = opendr_engine::model::Sha256Hasher::default();
    for _ in 0..60 {
        environment.step(&straight(&seen), &mut seen).unwrap();
        seen.iter().for_each(|number| hash.update(&number.to_le_bytes()));
    }
    assert_eq!(hash.finish().to_string(), "87a4707aec25e50366e89b7cf968d893d3308ddec2d6d693605d764038e584fa");
}

/// Whatever the pusher does, it stays outside of the T and within its reach, and numbers stay finite.
#[test]
fn random_pushes_keep_the_bodies_apart() {
    let mut random = Random::new(3);
    let mut seen = [0.0; OBSERVATION_LEN];
    for seed in 0..10 {
        let mut environment = make("PlanarPush-v1").unwrap();
        environment.reset(Some(seed), &ResetOptions::new(), &mut seen).unwrap();
        for _ in 0..200 {
            let towards = straight(&seen);
            let action = towards.map(|part| (part + random.uniform(-0.8, 0.8)).clamp(-1.0, 1.0));
            let step = environment.step(&action, &mut seen).unwrap();
            let table = table::Table::observed(&PlanarPushParams::default(), &seen);
            let gap = table.tee().distance(table.pusher()) - PUSHER_RADIUS;
            assert!(gap > -3e-3, "seed {seed}: {gap}");
            assert!(environment.spec().observation.contains(&seen), "{seen:?}");
            if step.is_over() {
                break;
            }
        }
    }
}

#[test]
fn wrong_options_are_refused() {
    let mut environment = make("PlanarPush-v1").unwrap();
    let mut seen = [0.0; OBSERVATION_LEN];
    assert!(environment.step(&[0.0; 2], &mut seen).is_err(), "never reset");
    for (name, value) in [("mass", 0.0), ("turn", f64::NAN), ("payload", 1.0)] {
        let options = ResetOptions::from([(name.to_owned(), ParamValue::Float(value))]);
        assert!(environment.reset(Some(1), &options, &mut seen).is_err(), "{name}");
    }
    assert!(PushTeacher::default().act(&[f32::NAN; OBSERVATION_LEN], &mut [0.0; 2]).is_err());
    assert!(PushTeacher::default().act(&[0.0; 3], &mut [0.0; 2]).is_err());
}
