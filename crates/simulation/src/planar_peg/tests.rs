use opendr_engine::environment::{Controller as _, Environment, ResetOptions, Snapshot};

use super::*;
use crate::{RegisteredEnvironment as _, make};

fn demonstrate(environment: &mut dyn Environment, seed: u64) -> (bool, usize) {
    let (mut seen, mut action) = ([0.0; OBSERVATION_LEN], [0.0; ACTION_LEN]);
    let mut teacher = PegTeacher::default();
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
fn the_teacher_inserts_the_peg() {
    let mut environment = make("PlanarPeg-v1").unwrap();
    let runs: Vec<_> = (0..20).map(|seed| demonstrate(&mut *environment, seed)).collect();
    let successes = runs.iter().filter(|(success, _)| *success).count();
    assert!(successes >= 19, "{runs:?}");
}

/// Goes to the peg, closes, and goes to the slot.
fn simple(seen: &[f32; OBSERVATION_LEN], step: usize) -> [f32; ACTION_LEN] {
    let target = if step < 40 { [seen[5], seen[6] - 0.1] } else { [seen[9], 0.3] };
    let [x, y] = [0, 1].map(|axis| (5.0 * (target[axis] - seen[axis])).clamp(-1.0, 1.0));
    [x, y, (3.0 * (seen[8] - seen[3])).clamp(-1.0, 1.0), if step < 30 { 1.0 } else { -1.0 }]
}

/// Motions of this version: others need another version of the environment.
#[test]
fn the_golden_trajectory_is_the_same_on_every_machine() {
    let mut environment = PlanarPeg::new(&PlanarPegParams::default()).unwrap();
    let mut seen = [0.0; OBSERVATION_LEN];
    environment.reset(Some(42), &ResetOptions::new(), &mut seen).unwrap();
    let mut hash = opendr_engine::model::Sha256Hasher::default();
    for step in 0..100 {
        environment.step(&simple(&seen, step), &mut seen).unwrap();
        seen.iter().for_each(|number| hash.update(&number.to_le_bytes()));
    }
    assert_eq!(hash.finish().to_string(), "efdd25539c56a1f5932ebf422dabac9d3c502aeeb4368eef26f320c97e050c46");
}

/// A teacher that is saved and loaded demonstrates the same.
#[test]
fn the_teacher_continues_from_a_snapshot() {
    let mut environment = make("PlanarPeg-v1").unwrap();
    let (mut seen, mut action) = ([0.0; OBSERVATION_LEN], [0.0; ACTION_LEN]);
    let mut teacher = PegTeacher::default();
    environment.reset(Some(5), &ResetOptions::new(), &mut seen).unwrap();
    for _ in 0..45 {
        teacher.act(&seen, &mut action).unwrap();
        environment.step(&action, &mut seen).unwrap();
    }
    let mut snapshot = Snapshot::new("teacher");
    teacher.save_state(&mut snapshot).unwrap();
    let mut again = PegTeacher::default();
    let mut state = snapshot.read("teacher").unwrap();
    again.load_state(&mut state).unwrap();
    state.finish().unwrap();
    for _ in 0..30 {
        let mut other = [0.0; ACTION_LEN];
        teacher.act(&seen, &mut action).unwrap();
        again.act(&seen, &mut other).unwrap();
        assert_eq!(action, other);
        environment.step(&action, &mut seen).unwrap();
    }
    assert!(again.act(&[f32::INFINITY; OBSERVATION_LEN], &mut action).is_err());
}
