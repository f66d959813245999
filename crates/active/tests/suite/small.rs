//! A small recogniser of the poses of SphereView-Pose-v1.

use opendr_active::{
    EnvironmentRig, LabelledViews, ViewClassifier, ViewClassifierConfig, ViewTraining, fit_view_classifier,
};
use opendr_engine::environment::EnvironmentSource as _;
use opendr_engine::params::ParamMap;
use opendr_kernels::Compute;
use opendr_simulation::RegisteredSource;

pub fn source() -> RegisteredSource {
    RegisteredSource::new("SphereView-Pose-v1", &ParamMap::new()).unwrap()
}

pub fn small_classifier(source: &RegisteredSource) -> ViewClassifier {
    let mut rigs = [EnvironmentRig::new(source.make().unwrap()).unwrap()];
    let views = LabelledViews::collect(&mut rigs, 0, 40).unwrap();
    let config = ViewClassifierConfig { side: 0, kernels: vec![8, 8], hidden: 16, dimension: 8, classes: 0 };
    let training = ViewTraining { config, epochs: 3, seed: 1 };
    let mut losses = Vec::new();
    let classifier = fit_view_classifier(&views, &training, &Compute::single(), &mut |_, loss| {
        losses.push(loss);
        false
    });
    assert!(losses[2] < losses[0], "{losses:?}");
    classifier.unwrap()
}
