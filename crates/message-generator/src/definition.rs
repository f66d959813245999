//! Parsed `.msg` and `.srv` files.

use std::fmt;

/// Package and name of a message type, such as `sensor_msgs` and `Image`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TypeName {
    /// Package.
    pub package: String,
    /// Name within the package.
    pub name: String,
}

impl TypeName {
    /// Creates a name from package and name.
    pub fn new(package: impl Into<String>, name: impl Into<String>) -> Self {
        Self { package: package.into(), name: name.into() }
    }

    /// Returns the name in ROS 2, such as `sensor_msgs/msg/Image`.
    pub fn ros2(&self) -> String {
        format!("{}/msg/{}", self.package, self.name)
    }
}

/// Writes the name in ROS 1, such as `sensor_msgs/Image`.
impl fmt::Display for TypeName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.package, self.name)
    }
}

/// A primitive type.
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
    /// All primitives with keyword, Rust type and id in type descriptions (REP 2016).
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

    /// Returns the type of a keyword.
    pub fn from_keyword(keyword: &str) -> Option<Self> {
        Self::ALL.iter().find(|row| row.1 == keyword).map(|row| row.0)
    }

    fn row(self) -> &'static (Self, &'static str, &'static str, u8) {
        Self::ALL.iter().find(|row| row.0 == self).unwrap_or(&Self::ALL[0])
    }

    /// Returns the keyword in definitions.
    pub fn keyword(self) -> &'static str {
        self.row().1
    }

    /// Returns the type in Rust.
    pub fn rust(self) -> &'static str {
        self.row().2
    }

    /// Returns the id in type descriptions.
    pub fn type_id(self) -> u8 {
        self.row().3
    }
}

/// Type of a field, or of its elements.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum BaseType {
    /// A primitive type.
    Primitive(Primitive),
    /// Another message.
    Message(TypeName),
}

/// Number of elements of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Array {
    /// A single value.
    None,
    /// An array of fixed length.
    Fixed(usize),
    /// An array of at most this length.
    Bounded(usize),
    /// An array of any length.
    Unbounded,
}

/// Type of a field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldType {
    /// Type of the value or elements.
    pub base: BaseType,
    /// Number of elements.
    pub array: Array,
}

/// A field of a message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Name.
    pub name: String,
    /// Type.
    pub field_type: FieldType,
    /// Default value as written (ROS 2).
    pub default: Option<String>,
    /// Comment lines above the field.
    pub doc: String,
}

/// A constant of a message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Constant {
    /// Type.
    pub primitive: Primitive,
    /// Name.
    pub name: String,
    /// Value as written.
    pub value: String,
}

/// A message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Definition {
    /// Name.
    pub name: TypeName,
    /// Fields in order.
    pub fields: Vec<Field>,
    /// Constants in order.
    pub constants: Vec<Constant>,
    /// Comment lines at the beginning.
    pub doc: String,
}

/// A service of two messages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Service {
    /// Name.
    pub name: TypeName,
    /// Request, named `NAME_Request`.
    pub request: Definition,
    /// Response, named `NAME_Response`.
    pub response: Definition,
}
