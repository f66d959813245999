//! What a supervisor can do: read and change the scene.

use opendr_engine::{Error, Result};

/// A node of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NodeRef(pub(crate) usize);

/// A field of a node, with its type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FieldRef {
    pub(crate) node: usize,
    pub(crate) id: usize,
    pub(crate) kind: FieldKind,
}

impl FieldRef {
    /// Returns the type of its value.
    pub fn kind(&self) -> FieldKind {
        self.kind
    }
}

macro_rules! field_kinds {
    ($($(#[$doc:meta])* $name:ident($value:ty) = $number:literal;)*) => {
        /// The type of a field with one value.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum FieldKind {
            $($(#[$doc])* $name = $number,)*
        }

        /// The value of a field.
        #[derive(Debug, Clone, PartialEq)]
        pub enum FieldValue {
            $($(#[$doc])* $name($value),)*
        }

        impl FieldKind {
            /// Returns the type with this number in Webots.
            pub(crate) fn numbered(number: i32) -> Option<Self> {
                match number {
                    $($number => Some(Self::$name),)*
                    _ => None,
                }
            }
        }

        impl FieldValue {
            /// Returns the type.
            pub fn kind(&self) -> FieldKind {
                match self {
                    $(Self::$name(_) => FieldKind::$name,)*
                }
            }
        }
    };
}

field_kinds! {
    /// True or false.
    Bool(bool) = 1;
    /// An integer.
    Int32(i32) = 2;
    /// A number.
    Float(f64) = 3;
    /// Two numbers.
    Vec2([f64; 2]) = 4;
    /// Three numbers, such as a translation.
    Vec3([f64; 3]) = 5;
    /// An axis and an angle in rad.
    Rotation([f64; 4]) = 6;
    /// Red, green and blue, 0 to 1.
    Color([f64; 3]) = 7;
    /// A text.
    Text(String) = 8;
}

impl FieldValue {
    /// Checks that a field of type `kind` can have this value.
    pub(crate) fn check(&self, kind: FieldKind) -> Result<()> {
        let is_finite = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
        let is_valid = match self {
            Self::Bool(_) | Self::Int32(_) => true,
            Self::Float(number) => number.is_finite(),
            Self::Vec2(parts) => is_finite(parts),
            Self::Vec3(parts) | Self::Color(parts) => is_finite(parts),
            Self::Rotation(parts) => is_finite(parts),
            Self::Text(text) => !text.contains('\0'),
        };
        if self.kind() == kind && is_valid {
            return Ok(());
        }
        Err(Error::invalid_param(format!("{self:?} is no value of a field of type {kind:?}")))
    }
}

/// Access to the scene, which robots with `supervisor TRUE` have.
pub trait Supervisor {
    /// Returns the node with this DEF name.
    ///
    /// # Errors
    /// Returns `NotFound` if there is none, `Unsupported` if the link does not know the requests of this version.
    fn node(&mut self, def: &str) -> Result<NodeRef>;

    /// Returns a field of a node.
    ///
    /// # Errors
    /// Returns `NotFound` if there is none, `Unsupported` for fields with several values and as [`Self::node`].
    fn field(&mut self, node: NodeRef, name: &str) -> Result<FieldRef>;

    /// Returns the value of a field.
    ///
    /// # Errors
    /// Returns `Network` if the connection is lost.
    fn value(&mut self, field: FieldRef) -> Result<FieldValue>;

    /// Sets a field with the next step.
    ///
    /// # Errors
    /// Returns `InvalidParam` if the value is not of the field's type or not finite.
    fn set_value(&mut self, field: FieldRef, value: &FieldValue) -> Result<()>;

    /// Returns the position of a node in the world, in m.
    ///
    /// # Errors
    /// Returns `Network` if the connection is lost.
    fn position(&mut self, node: NodeRef) -> Result<[f64; 3]>;

    /// Returns linear and angular velocity of a solid, in m/s and rad/s.
    ///
    /// # Errors
    /// Returns `Network` if the connection is lost.
    fn velocity(&mut self, node: NodeRef) -> Result<[f64; 6]>;

    /// Sets linear and angular velocity of a solid.
    ///
    /// # Errors
    /// Returns `Network` if the connection is lost.
    fn set_velocity(&mut self, node: NodeRef, velocity: &[f64; 6]) -> Result<()>;

    /// Stops a solid: sets its velocities to 0.
    ///
    /// # Errors
    /// Returns `Network` if the connection is lost.
    fn reset_physics(&mut self, node: NodeRef) -> Result<()>;

    /// Resets the whole simulation to its initial state; controllers continue.
    ///
    /// # Errors
    /// Returns `Network` if the connection is lost.
    fn reset_simulation(&mut self) -> Result<()>;
}
