//! Parameters of a node, from the tables of `Params`.

use std::sync::{Mutex, MutexGuard, PoisonError};

use opendr_engine::params::{Field, ParamValue};
use opendr_engine::{Error, Result};

type Apply = Box<dyn Fn(&str, &ParamValue) -> Result<()> + Send + Sync>;

/// Parameters with their values and the callback for changes.
pub struct ParameterTable {
    rows: Mutex<Vec<(&'static Field, ParamValue)>>,
    apply: Apply,
}

impl ParameterTable {
    /// Creates a table of fields with their values; `apply` is called with each change of a live parameter before it takes effect.
    pub fn new(
        rows: Vec<(&'static Field, ParamValue)>,
        apply: impl Fn(&str, &ParamValue) -> Result<()> + Send + Sync + 'static,
    ) -> Self {
        Self { rows: Mutex::new(rows), apply: Box::new(apply) }
    }

    /// Returns every parameter with its value.
    pub fn rows(&self) -> Vec<(&'static Field, ParamValue)> {
        self.locked().clone()
    }

    /// Returns one parameter with its value.
    pub fn get(&self, name: &str) -> Option<(&'static Field, ParamValue)> {
        self.locked().iter().find(|(field, _)| field.name == name).cloned()
    }

    /// Checks whether a parameter can be set to a value.
    ///
    /// # Errors
    /// As [`ParameterTable::set`].
    pub fn check(&self, name: &str, value: &ParamValue) -> Result<()> {
        let (field, _) = self.get(name).ok_or_else(|| {
            let names: Vec<_> = self.locked().iter().map(|(field, _)| field.name).collect();
            Error::invalid_param(format!("unknown parameter {name}; there are {}", names.join(", ")))
        })?;
        if !field.live {
            return Err(Error::invalid_param(format!(
                "{name} cannot change while the node runs; start it with -p {name}:={value}"
            )));
        }
        field.check(value)
    }

    /// Sets a parameter.
    ///
    /// # Errors
    /// `InvalidParam` for an unknown parameter, one that is not live, or a value that is out of range.
    pub fn set(&self, name: &str, value: ParamValue) -> Result<()> {
        self.check(name, &value)?;
        (self.apply)(name, &value)?;
        if let Some(row) = self.locked().iter_mut().find(|(field, _)| field.name == name) {
            row.1 = value;
        }
        Ok(())
    }

    fn locked(&self) -> MutexGuard<'_, Vec<(&'static Field, ParamValue)>> {
        self.rows.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
