//! The Rust types of parameters.

use std::fmt;

use crate::params::ParamValue;

/// Type of a parameter on the surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ParamKind {
    /// A floating-point number.
    Float,
    /// An integer.
    Int,
    /// A boolean.
    Bool,
    /// Text, possibly from a fixed set.
    Text,
    /// A list of values.
    List,
}

impl fmt::Display for ParamKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Float => "a float",
            Self::Int => "an int",
            Self::Bool => "a bool",
            Self::Text => "a str",
            Self::List => "a list",
        })
    }
}

/// A type that can be a field of a struct of parameters.
pub trait Param: Sized {
    /// Type on the surfaces.
    const KIND: ParamKind;
    /// Whether the value may be absent.
    const OPTIONAL: bool = false;
    /// Allowed texts; empty if any text is allowed.
    const CHOICES: &'static [&'static str] = &[];

    /// Converts from a value; `None` if it is of the wrong type or does not fit.
    fn from_value(value: &ParamValue) -> Option<Self>;

    /// Converts to a value.
    fn to_value(&self) -> ParamValue;
}

macro_rules! integer {
    ($($type:ty),*) => {$(
        impl Param for $type {
            const KIND: ParamKind = ParamKind::Int;

            fn from_value(value: &ParamValue) -> Option<Self> {
                Self::try_from(value.as_int()?).ok()
            }

            fn to_value(&self) -> ParamValue {
                i64::try_from(*self).map_or(ParamValue::Int(i64::MAX), ParamValue::Int)
            }
        }
    )*};
}

integer!(i32, i64, u32, u64, usize);

impl Param for f32 {
    const KIND: ParamKind = ParamKind::Float;

    fn from_value(value: &ParamValue) -> Option<Self> {
        value.as_float().map(|number| number as Self)
    }

    // Through the shortest text: 0.35 remains 0.35 and does not become 0.3499999940395355.
    fn to_value(&self) -> ParamValue {
        ParamValue::Float(self.to_string().parse().unwrap_or_else(|_| f64::from(*self)))
    }
}

impl Param for f64 {
    const KIND: ParamKind = ParamKind::Float;

    fn from_value(value: &ParamValue) -> Option<Self> {
        value.as_float()
    }

    fn to_value(&self) -> ParamValue {
        ParamValue::Float(*self)
    }
}

impl Param for bool {
    const KIND: ParamKind = ParamKind::Bool;

    fn from_value(value: &ParamValue) -> Option<Self> {
        match value {
            ParamValue::Bool(value) => Some(*value),
            _ => None,
        }
    }

    fn to_value(&self) -> ParamValue {
        ParamValue::Bool(*self)
    }
}

impl Param for String {
    const KIND: ParamKind = ParamKind::Text;

    fn from_value(value: &ParamValue) -> Option<Self> {
        match value {
            ParamValue::Text(text) => Some(text.clone()),
            _ => None,
        }
    }

    fn to_value(&self) -> ParamValue {
        ParamValue::Text(self.clone())
    }
}

impl<T: Param> Param for Option<T> {
    const KIND: ParamKind = T::KIND;
    const OPTIONAL: bool = true;
    const CHOICES: &'static [&'static str] = T::CHOICES;

    fn from_value(value: &ParamValue) -> Option<Self> {
        match value {
            ParamValue::None => Some(None),
            value => T::from_value(value).map(Some),
        }
    }

    fn to_value(&self) -> ParamValue {
        self.as_ref().map_or(ParamValue::None, T::to_value)
    }
}

impl<T: Param> Param for Vec<T> {
    const KIND: ParamKind = ParamKind::List;

    fn from_value(value: &ParamValue) -> Option<Self> {
        match value {
            ParamValue::List(items) => items.iter().map(T::from_value).collect(),
            value => T::from_value(value).map(|item| vec![item]),
        }
    }

    fn to_value(&self) -> ParamValue {
        ParamValue::List(self.iter().map(T::to_value).collect())
    }
}
