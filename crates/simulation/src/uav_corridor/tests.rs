use opendr_engine::environment::ResetOptions;

use super::*;
use crate::make;

/// Successes of a controller in 500 fixed worlds.
fn successes(id: &str, controller: &mut dyn CorridorController) -> u32 {
    let mut environment = make(id).unwrap();
    let space = environment.spec().observation.clone();
    let (mut seen, mut sight) = (vec![0.0; space.len()], CorridorSight::default());
    let mut successes = 0;
    for seed in 0..500 {
        environment.reset(Some(1_000_000 + seed), &ResetOptions::new(), &mut seen).unwrap();
        controller.begin();
        loop {
            sight.read(&space, &seen).unwrap();
            let step = environment.step(&controller.act(&sight), &mut seen).unwrap();
            if step.is_over() {
                successes += u32::from(step.info.get("success") == Some(1.0));
                break;
            }
        }
    }
    successes
}

#[test]
fn controllers_succeed_as_often_as_measured() {
    let straight = successes("UavDepthCorridor-v1", &mut Straight);
    let reactive = successes("UavDepthCorridor-v1", &mut Reactive::default());
    let field = successes("UavDepthCorridor-v1", &mut PotentialField::default());
    assert_eq!((straight, reactive, field), (96, 350, 368));
}
