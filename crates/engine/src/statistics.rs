//! The results of `fit` and `eval`.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

/// Named scalars and named curves, the same on every surface.
///
/// Keys are `snake_case`. `fit` writes the curves `loss` and, with validation data, `val_<metric>` (one value per
/// epoch) and the scalars `steps`, `epochs`, `seconds`; `eval` writes one scalar per metric of the task, e.g.
/// `map`, `map50`, `map75`. A key that could not be computed is absent, never NaN.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// Scalars by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub scalars: BTreeMap<String, f64>,
    /// Curves by name: one value per epoch, step or class.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub curves: BTreeMap<String, Vec<f64>>,
}

impl Statistics {
    /// Returns the scalar `key`.
    pub fn get(&self, key: &str) -> Option<f64> {
        self.scalars.get(key).copied()
    }

    /// Sets a scalar; a value that is not finite removes the key.
    pub fn set(&mut self, key: impl Into<String>, value: f64) {
        let key = key.into();
        if value.is_finite() {
            self.scalars.insert(key, value);
        } else {
            self.scalars.remove(&key);
        }
    }

    /// Appends a value to a curve.
    pub fn push(&mut self, key: impl Into<String>, value: f64) {
        self.curves.entry(key.into()).or_default().push(value);
    }
}

impl fmt::Display for Statistics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (key, value) in &self.scalars {
            writeln!(f, "{key}: {value:.6}")?;
        }
        for (key, curve) in &self.curves {
            match curve.last() {
                Some(last) => writeln!(f, "{key}: {} values, last {last:.6}", curve.len())?,
                None => writeln!(f, "{key}: empty")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scalars_are_finite() {
        let mut statistics = Statistics::default();
        statistics.set("map50", 0.5);
        statistics.set("map75", f64::NAN);
        assert_eq!(statistics.get("map75"), None);
        statistics.push("loss", 2.0);
        assert_eq!(statistics.to_string(), "map50: 0.500000\nloss: 1 values, last 2.000000\n");
    }
}
