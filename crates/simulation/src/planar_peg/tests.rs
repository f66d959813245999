use opendr_engine::environment::{Controller as _, Environment, ResetOptions};

use super::*;
use crate::make;

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
