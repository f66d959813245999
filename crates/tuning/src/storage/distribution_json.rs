//! Distributions in the JSON of Optuna's files.

use opendr_engine::{Error, Result, ResultExt};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::Distribution;
use crate::storage::python_json::{text_from_value, value_from_text};

/// Optuna's classes; the aliases and those after the third predate its version 3.
#[derive(Deserialize)]
#[serde(tag = "name", content = "attributes")]
enum Stored {
    #[serde(rename = "FloatDistribution", alias = "UniformDistribution")]
    Float(Range<f64>),
    #[serde(rename = "IntDistribution", alias = "IntUniformDistribution")]
    Int(Range<i64>),
    #[serde(rename = "CategoricalDistribution")]
    Categorical { choices: Vec<Value> },
    #[serde(rename = "LogUniformDistribution")]
    LogFloat(Range<f64>),
    #[serde(rename = "DiscreteUniformDistribution")]
    SteppedFloat { low: f64, high: f64, q: f64 },
    #[serde(rename = "IntLogUniformDistribution")]
    LogInt(Range<i64>),
}

#[derive(Deserialize)]
struct Range<T> {
    low: T,
    high: T,
    #[serde(default)]
    log: bool,
    #[serde(default = "none")]
    step: Option<T>,
}

fn none<T>() -> Option<T> {
    None
}

/// Parses a distribution.
pub fn distribution_from_json(text: &str) -> Result<Distribution> {
    let what = || "reading a distribution";
    let stored = Stored::deserialize(value_from_text(text).context(what)?).map_err(|error| {
        Error::format("the distribution is none of Optuna's").with_source(error).context(what())
    })?;
    let float = |Range { low, high, log, step }| Distribution::Float { low, high, log, step };
    let int = |Range { low, high, log, step }: Range<i64>| Distribution::Int {
        low,
        high,
        log,
        step: step.unwrap_or(1),
    };
    let distribution = match stored {
        Stored::Float(range) => float(range),
        Stored::LogFloat(range) => float(Range { log: true, ..range }),
        Stored::SteppedFloat { low, high, q } => float(Range { low, high, log: false, step: Some(q) }),
        Stored::Int(range) => int(range),
        // Optuna stored a step there that has no effect.
        Stored::LogInt(range) => int(Range { log: true, step: Some(1), ..range }),
        Stored::Categorical { choices } => Distribution::Categorical { choices },
    };
    distribution.checked().map_err(|error| Error::format(error.message()).context(what()))
}

/// Returns a distribution as text.
pub fn json_from_distribution(distribution: &Distribution) -> String {
    text_from_value(&match distribution {
        Distribution::Float { low, high, log, step } => {
            json!({"name": "FloatDistribution", "attributes": {"step": step, "low": low, "high": high, "log": log}})
        }
        Distribution::Int { low, high, log, step } => {
            json!({"name": "IntDistribution", "attributes": {"log": log, "step": step, "low": low, "high": high}})
        }
        Distribution::Categorical { choices } => {
            json!({"name": "CategoricalDistribution", "attributes": {"choices": choices}})
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distributions_round_trip() {
        for distribution in [
            Distribution::float(-1.0, 1e-7),
            Distribution::log_float(1e-300, 1e300),
            Distribution::stepped_float(0.0, 0.3, 0.1),
            Distribution::int(-5, 1 << 53),
            Distribution::log_int(1, 9),
            Distribution::stepped_int(0, 64, 16),
            Distribution::categorical([json!("a\"NaN"), json!(null), json!(1), json!(2.5), json!([true])]),
        ] {
            let distribution = distribution.unwrap();
            assert_eq!(distribution_from_json(&json_from_distribution(&distribution)).unwrap(), distribution);
        }
    }

    #[test]
    fn older_and_hostile_texts() {
        let read = |name: &str, attributes: Value| {
            distribution_from_json(&json!({"name": name, "attributes": attributes}).to_string())
        };
        let range = || json!({"low": 1, "high": 9});
        assert_eq!(
            read("LogUniformDistribution", range()).unwrap(),
            Distribution::log_float(1.0, 9.0).unwrap()
        );
        assert_eq!(read("IntUniformDistribution", range()).unwrap(), Distribution::int(1, 9).unwrap());
        assert!(read("IntLogUniformDistribution", json!({"low": 1, "high": 9, "step": 2})).is_ok());
        assert!(read("NormalDistribution", range()).is_err());
        assert!(read("FloatDistribution", json!({"low": 2.0, "high": 1.0})).is_err());
        assert!(read("IntDistribution", json!({"low": 0, "high": 5, "step": 0})).is_err());
        assert!(read("CategoricalDistribution", json!({"choices": []})).is_err());
        assert!(distribution_from_json("[").is_err());
    }
}
