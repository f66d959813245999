//! Search spaces from OpenDR's hyperparameter dictionaries.

use opendr_engine::{Error, Result};
use serde::Deserialize;
use serde_json::Value;

use crate::{Distribution, SearchSpace};

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
enum Dictionary {
    Categorical {
        name: String,
        choices: Vec<Value>,
    },
    DiscreteUniform {
        name: String,
        low: f64,
        high: f64,
        q: f64,
    },
    Float {
        name: String,
        low: f64,
        high: f64,
        #[serde(default)]
        step: Option<f64>,
        #[serde(default)]
        log: bool,
    },
    Int {
        name: String,
        low: i64,
        high: i64,
        #[serde(default = "one")]
        step: i64,
        #[serde(default)]
        log: bool,
    },
    Loguniform {
        name: String,
        low: f64,
        high: f64,
    },
    Uniform {
        name: String,
        low: f64,
        high: f64,
    },
}

fn one() -> i64 {
    1
}

impl SearchSpace {
    /// Creates the space of OpenDR's hyperparameter dictionaries: each has `name`, `type` (one of `categorical`,
    /// `discrete_uniform`, `float`, `int`, `loguniform`, `uniform`) and the arguments of that type.
    ///
    /// ```
    /// use opendr_tuning::SearchSpace;
    /// use serde_json::json;
    ///
    /// let space = SearchSpace::from_dictionaries(&[
    ///     json!({"name": "optimizer", "type": "categorical", "choices": ["sgd", "adam"]}),
    ///     json!({"name": "lr", "type": "loguniform", "low": 0.00001, "high": 0.01}),
    /// ]);
    /// assert_eq!(space.unwrap().parameters()[1].name, "lr");
    /// ```
    ///
    /// # Errors
    /// `InvalidParam` with the invalid dictionary.
    pub fn from_dictionaries(dictionaries: &[Value]) -> Result<Self> {
        dictionaries.iter().try_fold(Self::new(), |space, dictionary| {
            let read = Dictionary::deserialize(dictionary).map_err(|error| {
                Error::invalid_param(format!(
                    "hyperparameter {dictionary}: give name, type (categorical, discrete_uniform, float, int, \
                     loguniform or uniform) and the arguments of that type"
                ))
                .with_source(error)
            })?;
            let (name, distribution) = named_distribution(read);
            space.with(name, distribution)
        })
    }
}

fn named_distribution(dictionary: Dictionary) -> (String, Distribution) {
    let float = |low, high, log, step| Distribution::Float { low, high, log, step };
    match dictionary {
        Dictionary::Categorical { name, choices } => (name, Distribution::Categorical { choices }),
        Dictionary::DiscreteUniform { name, low, high, q } => (name, float(low, high, false, Some(q))),
        Dictionary::Float { name, low, high, step, log } => (name, float(low, high, log, step)),
        Dictionary::Int { name, low, high, step, log } => (name, Distribution::Int { low, high, log, step }),
        Dictionary::Loguniform { name, low, high } => (name, float(low, high, true, None)),
        Dictionary::Uniform { name, low, high } => (name, float(low, high, false, None)),
    }
}
