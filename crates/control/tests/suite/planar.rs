//! Steps of the planar worlds and their teachers.

use opendr_control::priors;
use opendr_engine::Random;
use opendr_engine::environment::ResetOptions;
use opendr_simulation::make;
use opendr_test_allocator::allocations_of_thread;

/// Bodies, contacts and impulses have their memory from the start.
#[test]
fn steps_of_planar_worlds_allocate_nothing() {
    for id in ["PlanarPush-v1", "PlanarPeg-v1"] {
        let mut environment = make(id).unwrap();
        let spec = environment.spec().clone();
        let (mut seen, mut action) = (vec![0.0; spec.observation.len()], vec![0.0; spec.action.len()]);
        let mut random = Random::new(2);
        environment.reset(Some(1), &ResetOptions::new(), &mut seen).unwrap();
        for step in 0..100 {
            spec.action.sample_into(&mut random, &mut action);
            let before = allocations_of_thread();
            environment.step(&action, &mut seen).unwrap();
            assert_eq!(allocations_of_thread() - before, 0, "{id}, step {step}");
        }
    }
}

/// The teacher of the peg plans nothing, and allocates nothing.
#[test]
fn the_teacher_of_the_peg_allocates_nothing() {
    let mut environment = make("PlanarPeg-v1").unwrap();
    let teachers = priors();
    let prior = teachers.iter().find(|prior| prior.id().name == "planar-peg-teacher").unwrap();
    let mut teacher = prior.controller(&environment.spec().observation).unwrap();
    let (mut seen, mut action) = (vec![0.0; 10], vec![0.0; 4]);
    environment.reset(Some(1), &ResetOptions::new(), &mut seen).unwrap();
    teacher.act(&seen, &mut action).unwrap();
    let before = allocations_of_thread();
    (0..20).for_each(|_| teacher.act(&seen, &mut action).unwrap());
    assert_eq!(allocations_of_thread() - before, 0);
}
