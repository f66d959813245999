//! What can stand in the middle of the sphere.

use opendr_engine::Random;

/// What is to be recognised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// One of ten persons, by a head whose back says nothing.
    Face,
    /// One of fifteen products: three forms, five labels on the front of each.
    Object,
    /// One of ten poses of a figure whose arms are hidden from behind.
    Pose,
}

/// Persons in a gallery of faces.
pub const CLASSES: u32 = 10;

impl Subject {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Face, Self::Object, Self::Pose];

    /// Name, as on a command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Face => "face",
            Self::Object => "object",
            Self::Pose => "pose",
        }
    }

    /// Id of its environment.
    pub fn id(self) -> &'static str {
        match self {
            Self::Face => "SphereView-Face-v1",
            Self::Object => "SphereView-Object-v1",
            Self::Pose => "SphereView-Pose-v1",
        }
    }

    /// Number of classes that an episode decides between.
    pub fn classes(self) -> u32 {
        match self {
            Self::Face => CLASSES,
            Self::Object => super::object::CLASSES,
            Self::Pose => super::figure::CLASSES,
        }
    }

    /// The random numbers of what is generated: `what` separates classes, persons, instances.
    pub(super) fn random(self, what: u64, number: u64) -> Random {
        Random::from_key([0x5eed_5e7e, self as u64, what, number])
    }
}
