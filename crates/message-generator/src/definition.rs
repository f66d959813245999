//! What a `.msg` or `.srv` file says.

use std::fmt;

/// A message type by package and name, e.g. `sensor_msgs` and `Image`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TypeName {
    /// The package.
    pub package: String,
    /// The name within the package.
    pub name: String,
}

impl TypeName {
    /// A name from its two parts.
    pub fn new(package: impl Into<String>, name: impl Into<String>) -> Self {
        Self { package: package.into(), name: name.into() }
    }

    /// ROS 2's spelling, e.g. `sensor_msgs/msg/Image`.
    pub fn ros2(&self) -> String {
        format!("{}/msg/{}", self.package, self.name)
    }
}

/// ROS 1's spelling, e.g. `sensor_msgs/Image`.
impl fmt::Display for TypeName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.package, self.name)
    }
}

/// A type of the language itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Primitive {
    Bool,
    Byte,
    Char,
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Int64,
    Uint64,
    Float32,
    Float64,
    String,
}

impl Primitive {
    /// Every one with its keyword, its Rust type and its number in a type description (REP 2016).
    pub const ALL: [(Self, &'static str, &'static str, u8); 14] = [
        (Self::Bool, "bool", "bool", 15),
        (Self::Byte, "byte", "u8", 16),
        (Self::Char, "char", "u8", 3),
        (Self::Int8, "int8", "i8", 2),
        (Self::Uint8, "uint8", "u8", 3),
        (Self::Int16, "int16", "i16", 4),
        (Self::Uint16, "uint16", "u16", 5),
        (Self::Int32, "int32", "i32", 6),
        (Self::Uint32, "uint32", "u32", 7),
        (Self::Int64, "int64", "i64", 8),
        (Self::Uint64, "uint64", "u64", 9),
        (Self::Float32, "float32", "f32", 10),
        (Self::Float64, "float64", "f64", 11),
        (Self::String, "string", "String", 17),
    ];

    /// The type of a keyword.
    pub fn from_keyword(keyword: &str) -> Option<Self> {
        Self::ALL.iter().find(|row| row.1 == keyword).map(|row| row.0)
    }

    fn row(self) -> &'static (Self, &'static str, &'static str, u8) {
        Self::ALL.iter().find(|row| row.0 == self).unwrap_or(&Self::ALL[0])
    }

    /// Its keyword in definitions.
    pub fn keyword(self) -> &'static str {
        self.row().1
    }

    /// Its type in Rust.
    pub fn rust(self) -> &'static str {
        self.row().2
    }

    /// Its number in a type description.
    pub fn type_id(self) -> u8 {
        self.row().3
    }
}

/// What a field holds, one or many of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum BaseType {
    /// A type of the language.
    Primitive(Primitive),
    /// Another message.
    Message(TypeName),
}

/// How many of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Array {
    /// One.
    None,
    /// Always so many.
    Fixed(usize),
    /// Any number up to this one.
    Bounded(usize),
    /// Any number.
    Unbounded,
}

/// The type of a field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldType {
    /// Of what.
    pub base: BaseType,
    /// How many.
    pub array: Array,
}

/// A field of a message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Its type.
    pub field_type: FieldType,
    /// Its value where nobody sets it, as written (ROS 2).
    pub default: Option<String>,
    /// The comment lines above it.
    pub doc: String,
}

/// A constant of a message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Constant {
    /// Its type.
    pub primitive: Primitive,
    /// Its name.
    pub name: String,
    /// Its value, as written.
    pub value: String,
}

/// A message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Definition {
    /// What it is called.
    pub name: TypeName,
    /// Its fields in order.
    pub fields: Vec<Field>,
    /// Its constants in order.
    pub constants: Vec<Constant>,
    /// The comment lines that it begins with.
    pub doc: String,
}

/// A service: two messages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Service {
    /// What it is called.
    pub name: TypeName,
    /// What is asked; called `NAME_Request`.
    pub request: Definition,
    /// What is answered; called `NAME_Response`.
    pub response: Definition,
}
