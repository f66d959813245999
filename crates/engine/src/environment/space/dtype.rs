//! What the numbers of a box are elsewhere.

/// The type of a box's numbers, in NumPy's words. Elements are passed as `f32` in any case, which holds a byte and a
/// position exactly; other programs are told this one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Dtype {
    /// Single precision.
    #[default]
    Float32,
    /// Double precision.
    Float64,
    /// Whole numbers from 0 to 255: pictures.
    Uint8,
    /// Whole numbers.
    Int64,
}

impl Dtype {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Float32, Self::Float64, Self::Uint8, Self::Int64];

    /// NumPy's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float32 => "float32",
            Self::Float64 => "float64",
            Self::Uint8 => "uint8",
            Self::Int64 => "int64",
        }
    }

    /// The type of a name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|dtype| dtype.name() == name)
    }

    /// Whether numbers have to be whole.
    pub const fn is_whole(self) -> bool {
        matches!(self, Self::Uint8 | Self::Int64)
    }
}
