//! Values of XML-RPC and of the parameter server.

use std::collections::BTreeMap;

/// Value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum ParameterValue {
    /// `<boolean>`.
    Bool(bool),
    /// `<int>`: XML-RPC has no wider integer.
    Int(i32),
    /// `<double>`; ROS masters keep infinities and NaN too.
    Double(f64),
    /// `<string>`.
    String(String),
    /// `<array>`, of any mixture.
    List(Vec<Self>),
    /// `<struct>`, a namespace of the parameter server.
    Struct(BTreeMap<String, Self>),
    /// `<base64>`.
    Base64(Vec<u8>),
    /// `<dateTime.iso8601>` in its text form: `19980717T14:08:55`.
    DateTime(String),
}

impl ParameterValue {
    /// Returns the value of a Boolean.
    pub fn as_bool(&self) -> Option<bool> {
        if let Self::Bool(value) = self { Some(*value) } else { None }
    }

    /// Returns the value of an integer.
    pub fn as_int(&self) -> Option<i32> {
        if let Self::Int(value) = self { Some(*value) } else { None }
    }

    /// Returns the value of a double or an integer.
    pub fn as_double(&self) -> Option<f64> {
        match self {
            Self::Double(value) => Some(*value),
            Self::Int(value) => Some(f64::from(*value)),
            _ => None,
        }
    }

    /// Returns the text of a string.
    pub fn as_str(&self) -> Option<&str> {
        if let Self::String(value) = self { Some(value) } else { None }
    }

    /// Returns the elements of a list.
    pub fn as_list(&self) -> Option<&[Self]> {
        if let Self::List(values) = self { Some(values) } else { None }
    }

    /// Returns the members of a struct.
    pub fn as_struct(&self) -> Option<&BTreeMap<String, Self>> {
        if let Self::Struct(members) = self { Some(members) } else { None }
    }
}

macro_rules! from {
    ($($type:ty => $variant:ident;)*) => {$(
        impl From<$type> for ParameterValue {
            fn from(value: $type) -> Self { Self::$variant(value.into()) }
        }
    )*};
}

from! {
    bool => Bool;
    i32 => Int;
    f64 => Double;
    &str => String;
    String => String;
    Vec<Self> => List;
    BTreeMap<String, Self> => Struct;
}
