//! Name and description of a learner.

use crate::Task;

/// Name, task and description of a learner; a constant beside its code.
#[derive(Debug, Clone, Copy)]
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
    /// For learners that load ONNX files of other tools as they are: returns whether the bytes of such a file are a network of the
    /// learner's task.
    pub recognises_network: Option<fn(&[u8]) -> bool>,
}

impl Spec {
    /// Reason for training arguments in [`Spec::without_effect`].
    pub const TRAINING_ONLY: &'static str = "it belongs to training, which this learner does not have";

    /// Creates the specification of a learner named `name`.
    pub const fn new(name: &'static str, task: Task) -> Self {
        Self { name, task, class: "", about: "", without_effect: &[], recognises_network: None }
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

    /// States that the learner loads ONNX files of other tools as they are, and which of them are of its task.
    #[must_use]
    pub const fn recognises_network(self, recognises: fn(&[u8]) -> bool) -> Self {
        Self { recognises_network: Some(recognises), ..self }
    }
}
