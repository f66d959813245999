//! After the first steps, rendering, recognising and believing allocate nothing.

use opendr_active::sphere::{EmbeddingConfig, SphereScene, SubjectPool, ViewSet, fit_embedding};
use opendr_active::{Fusion, Look};
use opendr_engine::Random;
use opendr_engine::target::Action;
use opendr_kernels::Compute;
use opendr_simulation::sphere_view::Subject;
use opendr_test_allocator::allocations_of_thread;

#[test]
fn steps_allocate_nothing() {
    let views = ViewSet::render(Subject::Pose, 32, 0, 10, 1).unwrap();
    let config = EmbeddingConfig { epochs: 2, hidden: 16, ..EmbeddingConfig::default() };
    let fit = fit_embedding(&views, &config, &Compute::single()).unwrap();
    assert!(fit.losses[1] < fit.losses[0], "{:?}", fit.losses);
    let pool = SubjectPool::generate(Subject::Pose, 5, 1).unwrap();
    let mut look = Look::new(SphereScene::new(&pool, &fit).unwrap(), Fusion::default(), 6).unwrap();
    let action = Action::new(&[0.5, 0.1, -0.2]).unwrap();
    look.begin(&mut Random::new(1)).unwrap();
    (0..6).for_each(|_| assert!(look.step(&action).unwrap().effort() <= 1.0));
    look.begin(&mut Random::new(2)).unwrap();
    let before = allocations_of_thread();
    (0..6).for_each(|_| assert!(look.step(&action).unwrap().effort() <= 1.0));
    assert_eq!(allocations_of_thread() - before, 0);
    // A recogniser of other classes does not fit.
    let heads = SubjectPool::generate(Subject::Object, 0, 1).unwrap();
    assert!(SphereScene::new(&heads, &fit).is_err());
}
