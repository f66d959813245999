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
}

impl Spec {
    /// A learner called `name`.
    pub const fn new(name: &'static str, task: Task) -> Self {
        Self { name, task, class: "", about: "" }
    }

    /// Sets the class name.
    #[must_use]
    pub const fn class(self, class: &'static str) -> Self {
        Self { class, ..self }
    }

    /// Sets the sentence.
    #[must_use]
    pub const fn about(self, about: &'static str) -> Self {
        Self { about, ..self }
    }
}
