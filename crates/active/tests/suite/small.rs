//! A small recogniser of the poses of SphereView-Pose-v1, and an estimator of the best view.

use opendr_active::{
    BestViewEstimator, EnvironmentRig, FreshViews, ViewClassifier, ViewClassifierConfig, ViewTraining,
    fit_view_networks,
};
use opendr_engine::Silent;
use opendr_engine::environment::EnvironmentSource as _;
use opendr_engine::params::ParamMap;
use opendr_kernels::Compute;
use opendr_simulation::RegisteredSource;

pub fn source() -> RegisteredSource {
    RegisteredSource::new("SphereView-Pose-v1", &ParamMap::new()).unwrap()
}

pub fn views(episodes: u64) -> FreshViews {
    FreshViews::new(vec![EnvironmentRig::new(source().make().unwrap()).unwrap()], 0, episodes)
}

fn training(epochs: usize) -> ViewTraining {
    let config = ViewClassifierConfig { side: 0, kernels: vec![8, 8], hidden: 16, dimension: 8, classes: 0 };
    ViewTraining { config, epochs, seed: 1 }
}

pub fn small_networks() -> (ViewClassifier, BestViewEstimator) {
    let mut losses = Vec::new();
    let (classifier, best_view) =
        fit_view_networks(&mut views(40), &training(5), (&Compute::single(), &Silent), &mut |_, both| {
            losses.push(both);
        })
        .unwrap();
    assert!(losses[4][0] < losses[0][0] && losses[4][1] < losses[0][1], "{losses:?}");
    (classifier, best_view)
}
