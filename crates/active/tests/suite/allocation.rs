//! After the first steps, rendering, recognition and fusion allocate nothing.

use opendr_active::{EnvironmentScene, Fusion, ViewLoop};
use opendr_engine::Random;
use opendr_engine::params::ParamMap;
use opendr_engine::target::Action;
use opendr_simulation::RegisteredSource;
use opendr_test_allocator::allocations_of_thread;

use crate::small::{small_networks, source};

#[test]
fn steps_allocate_nothing() {
    let source = source();
    let (recogniser, best_view) = small_networks();
    let scene = EnvironmentScene::new(&source, recogniser.clone()).unwrap();
    let mut view_loop = ViewLoop::new(scene, Fusion::default(), 6, Some(best_view)).unwrap();
    let action = Action::new(&[0.5, 0.1, -0.2]).unwrap();
    view_loop.begin(&mut Random::new(1)).unwrap();
    (0..6).for_each(|_| assert!(view_loop.step(&action).unwrap().effort() <= 1.0));
    view_loop.begin(&mut Random::new(2)).unwrap();
    let before = allocations_of_thread();
    (0..6).for_each(|_| assert!(view_loop.step(&action).unwrap().effort() <= 1.0));
    assert_eq!(allocations_of_thread() - before, 0);
    let objects = RegisteredSource::new("SphereView-Object-v1", &ParamMap::new()).unwrap();
    let error = EnvironmentScene::new(&objects, recogniser).err().unwrap().to_string();
    assert!(error.contains("a recogniser of 10 classes in an environment of 15"), "{error}");
    let other = RegisteredSource::new("CartPole-v1", &ParamMap::new()).unwrap();
    assert!(EnvironmentScene::new(&other, small_networks().0).is_err());
}
