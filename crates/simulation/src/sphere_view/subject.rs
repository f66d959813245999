//! Kinds of subjects.

use opendr_engine::Random;

/// What an environment has to recognise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// One of twenty persons, by the front of the head.
    Face,
    /// One of fifteen products: three forms, five labels on the front of each.
    Object,
    /// One of ten poses of a figure whose arms are hidden from behind.
    Pose,
}

/// Number of persons in a gallery of faces.
pub(super) const PERSONS: u32 = 20;
/// Number of products: three forms with five labels each.
pub(super) const PRODUCTS: u32 = 15;
/// Number of poses of a figure.
pub(super) const POSES: u32 = 10;

impl Subject {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Face, Self::Object, Self::Pose];

    /// Returns the name, as on a command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Face => "face",
            Self::Object => "object",
            Self::Pose => "pose",
        }
    }

    /// Returns the id of its environment.
    pub fn id(self) -> &'static str {
        match self {
            Self::Face => "SphereView-Face-v1",
            Self::Object => "SphereView-Object-v1",
            Self::Pose => "SphereView-Pose-v1",
        }
    }

    /// Returns the number of classes.
    pub fn classes(self) -> u32 {
        match self {
            Self::Face => PERSONS,
            Self::Object => PRODUCTS,
            Self::Pose => POSES,
        }
    }

    /// Returns the random numbers of a generated subject; `what` separates classes, `number` instances.
    pub(super) fn random(self, what: u64, number: u64) -> Random {
        Random::from_key([0x5eed_5e7e, self as u64, what, number])
    }
}
