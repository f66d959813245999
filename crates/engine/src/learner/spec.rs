//! Name and description of a learner.

use crate::Task;

/// Name, task and description of a learner; a constant beside its code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Spec {
    /// Registry name, also the file name and the command-line argument: `"nanodet"`.
    pub name: &'static str,
    /// Task of the learner.
    pub task: Task,
    /// Class name on the object-oriented surfaces, that of OpenDR if it has one: `"NanodetLearner"`.
    pub class: &'static str,
    /// One sentence: what the learner is and when to use it.
    pub about: &'static str,
    /// Arguments of OpenDR's class of this name that have no effect here, each with the reason.
    pub without_effect: &'static [(&'static str, &'static str)],
    /// Whether it loads ONNX files of other tools as they are; it recognises their inputs and outputs.
    pub recognises_networks: bool,
}

impl Spec {
    /// Reason for training arguments in [`Spec::without_effect`].
    pub const TRAINING_ONLY: &'static str = "it belongs to training, which this learner does not have";

    /// Creates the specification of a learner named `name`.
    pub const fn new(name: &'static str, task: Task) -> Self {
        Self { name, task, class: "", about: "", without_effect: &[], recognises_networks: false }
    }

    /// Sets the class name.
    #[must_use]
    pub const fn class(self, class: &'static str) -> Self {
        Self { class, ..self }
    }

    /// Sets the arguments of OpenDR that have no effect here, each with the reason.
    #[must_use]
    pub const fn without_effect(self, without_effect: &'static [(&'static str, &'static str)]) -> Self {
        Self { without_effect, ..self }
    }

    /// Sets the description.
    #[must_use]
    pub const fn about(self, about: &'static str) -> Self {
        Self { about, ..self }
    }

    /// States that the learner loads ONNX files of other tools as they are.
    #[must_use]
    pub const fn recognises_networks(self) -> Self {
        Self { recognises_networks: true, ..self }
    }
}
