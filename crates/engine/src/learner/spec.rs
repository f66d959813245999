//! What a learner is called.

use crate::Task;

/// The identity of a learner; a constant beside its code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Spec {
    /// Registry name, file name, command-line argument: `"nanodet"`.
    pub name: &'static str,
    /// What it is for.
    pub task: Task,
    /// The class name on the object-oriented surfaces, OpenDR's where it had one: `"NanodetLearner"`.
    pub class: &'static str,
    /// One sentence: what it is, when to use it.
    pub about: &'static str,
    /// Arguments that OpenDR's class of this name takes and that have no effect here, each with the reason.
    pub without_effect: &'static [(&'static str, &'static str)],
}

impl Spec {
    /// Why an argument of [`Spec::without_effect`] that OpenDR trains with has none.
    pub const OF_TRAINING: &'static str = "it belongs to training, which this learner does not have";

    /// A learner called `name`.
    pub const fn new(name: &'static str, task: Task) -> Self {
        Self { name, task, class: "", about: "", without_effect: &[] }
    }

    /// Sets the class name.
    #[must_use]
    pub const fn class(self, class: &'static str) -> Self {
        Self { class, ..self }
    }

    /// Sets OpenDR's arguments that have no effect here, each with the reason.
    #[must_use]
    pub const fn without_effect(self, without_effect: &'static [(&'static str, &'static str)]) -> Self {
        Self { without_effect, ..self }
    }

    /// Sets the sentence.
    #[must_use]
    pub const fn about(self, about: &'static str) -> Self {
        Self { about, ..self }
    }
}
