use opendr_engine::ErrorKind;
use opendr_engine::params::Params;
use serde_json::json;

use super::*;
use crate::defaults_from_fields;

/// Parameters of the test.
#[derive(Debug, Clone, Params)]
struct Sample {
    /// The learning rate.
    #[param(default = 0.001, range = 1e-6..=0.1, log)]
    lr: f64,
    /// The decay of weights.
    #[param(default = 0.001, range = 0.0..=100.0, log)]
    decay: f64,
    /// Samples of a batch.
    #[param(default = 64, range = 16..=1024, log)]
    batch: usize,
    /// Rate of dropping.
    #[param(default = 0.0, range = 0.0..=0.9)]
    dropout: f32,
    /// Whether to mirror.
    #[param(default = true)]
    mirror: bool,
    /// A free text.
    #[param(default = "a")]
    note: String,
}

#[test]
fn fields_become_distributions() {
    let space = SearchSpace::from_fields(Sample::FIELDS, &["lr", "batch", "dropout", "mirror"]).unwrap();
    let of = |at: usize| space.parameters()[at].distribution.clone();
    assert_eq!(of(0), Distribution::log_float(1e-6, 0.1).unwrap());
    assert_eq!(of(1), Distribution::log_int(16, 1024).unwrap());
    assert_eq!(of(2), Distribution::float(0.0, 0.9).unwrap());
    assert_eq!(of(3), Distribution::categorical([false, true]).unwrap());
    let decay = SearchSpace::from_fields(Sample::FIELDS, &["decay"]).unwrap();
    assert_eq!(decay.parameters()[0].distribution, Distribution::log_float(1e-5, 0.1).unwrap());
    for name in ["note", "missing"] {
        let error = SearchSpace::from_fields(Sample::FIELDS, &[name]).unwrap_err();
        assert!(error.kind() == ErrorKind::InvalidParam && error.to_string().contains(name), "{error}");
    }
    let defaults = defaults_from_fields(Sample::FIELDS, &["lr", "mirror"]).unwrap();
    assert_eq!(json!(defaults), json!({"lr": 0.001, "mirror": true}));
}

#[test]
fn dictionaries_of_opendr_become_spaces() {
    let space = SearchSpace::from_dictionaries(&[
        json!({"name": "a", "type": "categorical", "choices": ["sgd", 3, null]}),
        json!({"name": "b", "type": "discrete_uniform", "low": 0, "high": 1, "q": 0.25}),
        json!({"name": "c", "type": "float", "low": 0.1, "high": 1, "log": true}),
        json!({"name": "d", "type": "int", "low": 8, "high": 64, "step": 8}),
        json!({"name": "e", "type": "loguniform", "low": 1e-5, "high": 1e-1}),
        json!({"name": "f", "type": "uniform", "low": -1, "high": 1}),
    ])
    .unwrap();
    let wanted = [
        Distribution::categorical([json!("sgd"), json!(3), json!(null)]),
        Distribution::stepped_float(0.0, 1.0, 0.25),
        Distribution::log_float(0.1, 1.0),
        Distribution::stepped_int(8, 64, 8),
        Distribution::log_float(1e-5, 1e-1),
        Distribution::float(-1.0, 1.0),
    ];
    for (parameter, wanted) in space.parameters().iter().zip(wanted) {
        assert_eq!(parameter.distribution, wanted.unwrap());
    }
    for wrong in [
        json!({"name": "a", "type": "normal", "low": 0, "high": 1}),
        json!({"name": "a", "type": "uniform", "low": 0}),
        json!({"name": "a", "type": "uniform", "low": 0, "high": 1, "q": 1}),
        json!({"name": "a", "type": "int", "low": 0.5, "high": 1}),
        json!({"name": "a", "type": "uniform", "low": 1, "high": 0}),
        json!("lr"),
    ] {
        let error = SearchSpace::from_dictionaries(std::slice::from_ref(&wrong)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidParam, "{wrong}");
    }
}

#[test]
fn conditions_need_a_possible_parent() {
    let space = || SearchSpace::new().with("a", Distribution::categorical(["x", "y"])?);
    let unit = || Distribution::float(0.0, 1.0).unwrap();
    assert!(space().unwrap().with_when("b", unit(), "c", ["x"]).is_err());
    assert!(space().unwrap().with_when("b", unit(), "a", ["z"]).is_err());
    assert!(space().unwrap().with("a", unit()).is_err());
    let space = space()
        .and_then(|space| space.with_when("b", unit(), "a", ["x"]))
        .and_then(|space| space.with("c", unit()))
        .and_then(|space| space.with_when("d", unit(), "a", ["x"]))
        .unwrap();
    let names: Vec<Vec<&str>> = space
        .groups()
        .iter()
        .map(|group| group.iter().map(|parameter| parameter.name.as_str()).collect())
        .collect();
    assert_eq!(names, [vec!["a", "c"], vec!["b", "d"]]);
}
