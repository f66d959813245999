//! Parameters: name, type, default, range and documentation, defined once for all surfaces.
//!
//! `#[derive(Params)]` generates a static table of [`Field`]s and the code to read and write them by name. Python keyword
//! arguments and stubs, command-line flags, ROS parameters, C's JSON, the tuner's search space and the reference pages
//! all use that table.

mod choices;
mod field;
mod joined;
mod param;
mod value;

use std::fmt::Debug;

pub use field::{Field, FieldDefault, ParamRange};
#[doc(hidden)]
pub use joined::{count, joined};
pub use opendr_derive::Params;
pub use param::{Param, ParamKind};
pub use value::{ParamMap, ParamValue};

use crate::{Error, Result};

/// A struct of parameters. It is derived; the derive implements `Default` too.
///
/// ```
/// use opendr_engine::params::{Params, ParamValue};
///
/// /// Parameters of a detector.
/// #[derive(Debug, Clone, Params)]
/// pub struct MyParams {
///     /// Detections below this score are dropped.
///     #[param(default = 0.35, range = 0.0..=1.0, live)]
///     pub threshold: f32,
///     /// Side of the network's input in pixels.
///     #[param(default = 416, range = 32..=2048, unit = "px")]
///     pub size: usize,
/// }
///
/// let mut params = MyParams::default();
/// params.set("threshold", ParamValue::Float(0.5)).unwrap();
/// assert_eq!(params.threshold, 0.5);
/// assert!(params.set("threshold", ParamValue::Float(1.5)).is_err());
/// assert_eq!(MyParams::FIELDS[0].doc, "Detections below this score are dropped.");
/// ```
///
/// The fields of a struct can be flattened into another one, with other defaults there:
///
/// ```
/// # use opendr_engine::params::{Params, ParamValue};
/// # /// Parameters of a detector.
/// # #[derive(Debug, Clone, Params)]
/// # pub struct MyParams {
/// #     /// Side of the network's input in pixels.
/// #     #[param(default = 416, range = 32..=2048, unit = "px")]
/// #     pub size: usize,
/// # }
/// /// Parameters of a detector for large images.
/// #[derive(Debug, Clone, Params)]
/// pub struct LargeParams {
///     /// Parameters of the detector.
///     #[param(flatten, size = 1024)]
///     pub inner: MyParams,
/// }
///
/// assert_eq!(LargeParams::default().inner.size, 1024);
/// assert_eq!(LargeParams::FIELDS[0].default.value(), ParamValue::Int(1024));
/// ```
pub trait Params: Clone + Debug + Default + Send + Sync + 'static {
    /// Table of fields, in order of declaration.
    const FIELDS: &'static [Field];

    /// Returns the value of field `index`.
    #[doc(hidden)]
    fn get_at(&self, index: usize) -> ParamValue;

    /// Sets field `index`; returns `false` if the value is of the wrong type.
    #[doc(hidden)]
    fn set_at(&mut self, index: usize, value: &ParamValue) -> bool;

    /// Returns the value of a field.
    ///
    /// # Errors
    /// Returns `InvalidParam` if there is no such field.
    fn get(&self, name: &str) -> Result<ParamValue> {
        Ok(self.get_at(index_of(Self::FIELDS, name)?))
    }

    /// Sets a field.
    ///
    /// # Errors
    /// Returns `InvalidParam` if there is no such field, or the value is of the wrong type or out of range.
    fn set(&mut self, name: &str, value: ParamValue) -> Result<()> {
        let index = index_of(Self::FIELDS, name)?;
        let field = &Self::FIELDS[index];
        field.check(&value)?;
        if self.set_at(index, &value) { Ok(()) } else { Err(field.wrong_type(&value)) }
    }

    /// Sets a field from the text of a command line.
    ///
    /// # Errors
    /// As [`Params::set`].
    fn set_text(&mut self, name: &str, text: &str) -> Result<()> {
        let field = &Self::FIELDS[index_of(Self::FIELDS, name)?];
        self.set(name, field.parse(text)?)
    }

    /// Checks every field against its range and choices.
    ///
    /// # Errors
    /// Returns `InvalidParam` for the first field with an invalid value.
    fn check(&self) -> Result<()> {
        Self::FIELDS.iter().enumerate().try_for_each(|(index, field)| field.check(&self.get_at(index)))
    }

    /// Returns all values by name.
    fn to_map(&self) -> ParamMap {
        let fields = Self::FIELDS.iter().enumerate();
        fields.map(|(index, field)| (field.name.to_owned(), self.get_at(index))).collect()
    }

    /// Creates parameters with the values of `map`, and defaults for the rest.
    ///
    /// # Errors
    /// As [`Params::set`].
    fn from_map(map: &ParamMap) -> Result<Self> {
        let mut params = Self::default();
        map.iter().try_for_each(|(name, value)| params.set(name, value.clone()))?;
        Ok(params)
    }
}

/// An empty set of parameters.
#[derive(Debug, Clone, Params)]
pub struct NoParams {}

fn index_of(fields: &[Field], name: &str) -> Result<usize> {
    fields.iter().position(|field| field.is_called(name)).ok_or_else(|| {
        let names: Vec<_> = fields.iter().map(|field| field.name).collect();
        Error::invalid_param(match names.is_empty() {
            true => format!("no parameter {name:?}; there are no parameters"),
            false => format!("no parameter {name:?}; there are {}", names.join(", ")),
        })
    })
}

#[cfg(test)]
mod tests;
