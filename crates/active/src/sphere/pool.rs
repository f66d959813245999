//! Subjects that episodes choose from.

use std::sync::Arc;

use opendr_engine::{Error, Result};
use opendr_simulation::sphere_view::{Asset, Subject};

/// Generated subjects: ten persons, or some instances of every class.
#[derive(Debug, Clone)]
pub struct SubjectPool {
    /// What they are.
    pub subject: Subject,
    /// The subjects of class 0, of class 1, and so on.
    pub assets: Arc<Vec<Asset>>,
    /// Subjects of each class; one of a person.
    pub each: usize,
}

impl SubjectPool {
    /// The ten persons from number `first` on, or `each` instances from number `first` on of every class.
    ///
    /// # Errors
    /// `InvalidParam` for no instance.
    pub fn generate(subject: Subject, first: u32, each: usize) -> Result<Self> {
        let each = if subject == Subject::Face { 1 } else { each };
        if each == 0 {
            return Err(Error::invalid_param("no subject of each class to choose from; give at least 1"));
        }
        let asset = |class: u32, at: u32| match subject {
            Subject::Face => Asset::generate(subject, first + class, 0),
            Subject::Object | Subject::Pose => Asset::generate(subject, class, u64::from(first + at)),
        };
        let all = (0..subject.classes()).flat_map(|class| (0..each as u32).map(move |at| (class, at)));
        let assets = all.map(|(class, at)| asset(class, at)).collect::<Result<Vec<_>>>()?;
        Ok(Self { subject, assets: Arc::new(assets), each })
    }
}

/// Scales to length 1 and returns the length it had; of zeros nothing is made.
pub(super) fn normalise(direction: &mut [f32]) -> f32 {
    let length = direction.iter().map(|part| part * part).sum::<f32>().sqrt().max(1e-12);
    direction.iter_mut().for_each(|part| *part /= length);
    length
}
