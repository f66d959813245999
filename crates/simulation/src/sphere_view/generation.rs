//! Generation of subjects by class and instance.

use opendr_engine::Result;

use super::{Asset, Subject, figure, head, object};

impl Asset {
    /// Generates a subject of a class; `instance` selects one of that class. A face is a class of its own, so that `class` is
    /// the number of the person and the instance has no effect.
    ///
    /// # Errors
    /// `InvalidParam` for an unknown class.
    pub fn generate(subject: Subject, class: u32, instance: u64) -> Result<Self> {
        match subject {
            Subject::Face => head::generate(class),
            Subject::Object => object::generate(class, instance),
            Subject::Pose => figure::generate(class, instance),
        }
    }
}
