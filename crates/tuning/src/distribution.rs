//! Distributions of hyperparameters.

use std::fmt;

use opendr_engine::{Error, Result};
use serde_json::Value;

/// Largest magnitude of a whole number that is exact as a double, which is how files store it.
const LARGEST_INT: i64 = 1 << 53;

/// The range or choices of a hyperparameter, with its scale.
///
/// Samplers and Optuna's files represent every value as a number: a float or an int as itself, a choice by its index.
#[derive(Debug, Clone, PartialEq)]
pub enum Distribution {
    /// Numbers from `low` to `high`, both inclusive.
    Float {
        /// Smallest value.
        low: f64,
        /// Largest value.
        high: f64,
        /// Whether the range is sampled on a logarithmic scale.
        log: bool,
        /// Step of the values, counted from `low`; `None` for a continuous range.
        step: Option<f64>,
    },
    /// Whole numbers from `low` to `high`, both inclusive.
    Int {
        /// Smallest value.
        low: i64,
        /// Largest value.
        high: i64,
        /// Whether the range is sampled on a logarithmic scale.
        log: bool,
        /// Step of the values, counted from `low`.
        step: i64,
    },
    /// One of several unordered values, which may be any JSON values.
    Categorical {
        /// The choices.
        choices: Vec<Value>,
    },
}

impl Distribution {
    /// Creates a continuous range from `low` to `high`.
    ///
    /// # Errors
    /// `InvalidParam` when the range is empty or not finite; this applies to all constructors.
    pub fn float(low: f64, high: f64) -> Result<Self> {
        Self::Float { low, high, log: false, step: None }.checked()
    }

    /// Creates a logarithmic range of positive numbers from `low` to `high`.
    ///
    /// # Errors
    /// As [`Distribution::float`], and when `low` is not positive.
    pub fn log_float(low: f64, high: f64) -> Result<Self> {
        Self::Float { low, high, log: true, step: None }.checked()
    }

    /// Creates the values `low`, `low + step`, ... up to `high`.
    ///
    /// # Errors
    /// As [`Distribution::float`], and when `step` is not positive.
    pub fn stepped_float(low: f64, high: f64, step: f64) -> Result<Self> {
        Self::Float { low, high, log: false, step: Some(step) }.checked()
    }

    /// Creates a range of whole numbers from `low` to `high`.
    ///
    /// # Errors
    /// As [`Distribution::float`].
    pub fn int(low: i64, high: i64) -> Result<Self> {
        Self::Int { low, high, log: false, step: 1 }.checked()
    }

    /// Creates a logarithmic range of positive whole numbers from `low` to `high`.
    ///
    /// # Errors
    /// As [`Distribution::float`], and when `low` is below 1.
    pub fn log_int(low: i64, high: i64) -> Result<Self> {
        Self::Int { low, high, log: true, step: 1 }.checked()
    }

    /// Creates the whole numbers `low`, `low + step`, ... up to `high`.
    ///
    /// # Errors
    /// As [`Distribution::float`], and when `step` is below 1.
    pub fn stepped_int(low: i64, high: i64, step: i64) -> Result<Self> {
        Self::Int { low, high, log: false, step }.checked()
    }

    /// Creates a choice among `choices`.
    ///
    /// # Errors
    /// `InvalidParam` when there are none, or duplicates.
    pub fn categorical<T: Into<Value>>(choices: impl IntoIterator<Item = T>) -> Result<Self> {
        Self::Categorical { choices: choices.into_iter().map(Into::into).collect() }.checked()
    }

    /// Returns the distribution if it is valid, with `high` rounded down to the last step.
    ///
    /// # Errors
    /// `InvalidParam` with the reason.
    pub fn checked(mut self) -> Result<Self> {
        let wrong = |what: &str, it: &Self| Err(Error::invalid_param(format!("{it}: {what}")));
        match &mut self {
            Self::Float { low, high, log, step } => {
                if !(low.is_finite() && high.is_finite() && *low <= *high && (*high - *low).is_finite()) {
                    return wrong("give a finite range with low <= high", &self);
                }
                if *log && (*low <= 0.0 || step.is_some()) {
                    return wrong("a logarithmic range must begin above 0 and have no step", &self);
                }
                if let Some(step) = *step {
                    if !(step.is_finite() && step > 0.0) {
                        return wrong("give a step above 0", &self);
                    }
                    let steps = (*high - *low) / step;
                    // A range that ends at a step up to rounding is left unchanged.
                    if (steps - steps.round()).abs() > 1e-9 * steps.max(1.0) {
                        *high = *low + steps.floor() * step;
                    }
                }
            }
            Self::Int { low, high, log, step } => {
                let range = -LARGEST_INT..=LARGEST_INT;
                if !(range.contains(low) && range.contains(high) && *low <= *high) {
                    return wrong("give low <= high, within 2^53", &self);
                }
                if *step < 1 || (*log && (*low < 1 || *step != 1)) {
                    return wrong(
                        "give a step of 1 or more; a logarithmic range must begin at 1 or more and have step 1",
                        &self,
                    );
                }
                *high = *low + (*high - *low) / *step * *step;
            }
            Self::Categorical { choices } => {
                if choices.is_empty() {
                    return wrong("give at least one choice", &self);
                }
                let twice = |at: usize| choices[..at].contains(&choices[at]);
                if (0..choices.len()).any(twice) {
                    return wrong("a choice occurs twice", &self);
                }
            }
        }
        Ok(self)
    }

    /// Returns whether there is only one value.
    pub fn is_single(&self) -> bool {
        match self {
            Self::Float { low, high, .. } => low == high,
            Self::Int { low, high, .. } => low == high,
            Self::Categorical { choices } => choices.len() == 1,
        }
    }

    /// Returns the value that a number represents; `None` when the number is not in this distribution.
    pub fn value_from_number(&self, number: f64) -> Option<Value> {
        match self {
            Self::Float { .. } => number.is_finite().then(|| Value::from(number)),
            Self::Int { .. } => (number.fract() == 0.0 && number.abs() <= LARGEST_INT as f64)
                .then(|| Value::from(number as i64)),
            Self::Categorical { choices } => {
                let index = (number.fract() == 0.0 && number >= 0.0).then_some(number as usize)?;
                choices.get(index).cloned()
            }
        }
    }

    /// Returns the number that represents a value.
    ///
    /// # Errors
    /// `InvalidParam` when the value has another type, is out of range, or is not a choice.
    pub fn number_from_value(&self, value: &Value) -> Result<f64> {
        let number = match self {
            Self::Float { low, high, .. } => value.as_f64().filter(|number| (*low..=*high).contains(number)),
            Self::Int { low, high, .. } => {
                let whole = value.as_f64().filter(|number| number.fract() == 0.0);
                whole.filter(|number| (*low as f64..=*high as f64).contains(number))
            }
            Self::Categorical { choices } => {
                choices.iter().position(|choice| choice == value).map(|index| index as f64)
            }
        };
        number.ok_or_else(|| Error::invalid_param(format!("{value} is not in {self}")))
    }

    /// Returns whether both may occur in one study: same kind, same scale, same choices.
    pub fn is_compatible(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Float { log, .. }, Self::Float { log: other, .. }) => log == other,
            (Self::Int { log, .. }, Self::Int { log: other, .. }) => log == other,
            (Self::Categorical { choices }, Self::Categorical { choices: others }) => choices == others,
            _ => false,
        }
    }
}

/// Formats for reading: `0.001..=0.1 (log)`, `16..=64 step 16`, `one of "sgd", "adam"`.
impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Float { low, high, log, step } => {
                write!(f, "{low}..={high}")?;
                step.map_or(Ok(()), |step| write!(f, " step {step}"))?;
                f.write_str(if *log { " (log)" } else { "" })
            }
            Self::Int { low, high, log, step } => {
                write!(f, "{low}..={high}")?;
                if *step == 1 { Ok(()) } else { write!(f, " step {step}") }?;
                f.write_str(if *log { " (log)" } else { "" })
            }
            Self::Categorical { choices } => {
                let choices: Vec<_> = choices.iter().map(Value::to_string).collect();
                write!(f, "one of {}", choices.join(", "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn ranges_without_values_are_refused() {
        for wrong in [
            Distribution::float(1.0, 0.0),
            Distribution::float(f64::NAN, 0.0),
            Distribution::float(f64::MIN, f64::MAX),
            Distribution::log_float(0.0, 1.0),
            Distribution::stepped_float(0.0, 1.0, 0.0),
            Distribution::int(3, 2),
            Distribution::int(0, i64::MAX),
            Distribution::log_int(0, 2),
            Distribution::stepped_int(0, 2, 0),
            Distribution::categorical(Vec::<Value>::new()),
            Distribution::categorical(["a", "a"]),
        ] {
            assert_eq!(wrong.unwrap_err().kind(), opendr_engine::ErrorKind::InvalidParam);
        }
    }

    #[test]
    fn ranges_end_at_their_last_step() {
        assert_eq!(Distribution::stepped_int(1, 10, 4).unwrap(), Distribution::stepped_int(1, 9, 4).unwrap());
        let Distribution::Float { high, .. } = Distribution::stepped_float(0.0, 0.3, 0.1).unwrap() else {
            panic!()
        };
        assert_eq!(high, 0.3);
        let Distribution::Float { high, .. } = Distribution::stepped_float(0.0, 1.0, 0.4).unwrap() else {
            panic!()
        };
        assert_eq!(high, 0.8);
    }

    #[test]
    fn values_and_numbers_convert_to_each_other() {
        let choices =
            Distribution::categorical([json!("sgd"), json!(null), json!([64, 64]), json!({"a": 1})]).unwrap();
        assert_eq!(choices.number_from_value(&json!([64, 64])).unwrap(), 2.0);
        assert_eq!(choices.value_from_number(3.0), Some(json!({"a": 1})));
        assert_eq!(choices.value_from_number(4.0), None);
        assert_eq!(choices.value_from_number(-1.0), None);
        assert!(choices.number_from_value(&json!("adam")).is_err());
        let int = Distribution::int(1, 5).unwrap();
        assert_eq!(int.value_from_number(3.0), Some(json!(3)));
        assert_eq!(int.value_from_number(3.5), None);
        assert_eq!(int.number_from_value(&json!(4)).unwrap(), 4.0);
        assert!(int.number_from_value(&json!(6)).is_err() && int.number_from_value(&json!("4")).is_err());
    }
}
