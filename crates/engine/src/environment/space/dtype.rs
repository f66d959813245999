//! Element types of box spaces.

/// Element type of a box space, as in NumPy. Elements are passed as `f32` in any case, which represents bytes and
/// positions exactly; the type is for other programs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Dtype {
    /// Single precision.
    #[default]
    Float32,
    /// Double precision.
    Float64,
    /// Integers from 0 to 255, for images.
    Uint8,
    /// Integers.
    Int64,
}

impl Dtype {
    /// All types.
    pub const ALL: [Self; 4] = [Self::Float32, Self::Float64, Self::Uint8, Self::Int64];

    /// Returns the name of the type in NumPy.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float32 => "float32",
            Self::Float64 => "float64",
            Self::Uint8 => "uint8",
            Self::Int64 => "int64",
        }
    }

    /// Returns the type with this name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|dtype| dtype.name() == name)
    }

    /// Returns whether the type is an integer type.
    pub const fn is_whole(self) -> bool {
        matches!(self, Self::Uint8 | Self::Int64)
    }
}
