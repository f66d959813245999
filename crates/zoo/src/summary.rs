//! Models as the surfaces list them.

use opendr_engine::Task;
use opendr_engine::model::Licence;
use serde::Serialize;

use crate::card::{Accuracy, Grade, ItemKind};
use crate::item::Item;
use crate::zoo::Zoo;

/// A model of the zoo in numbers: an element of `opendr models --json` and of Python's `opendr.list_models()`.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct ModelSummary<'a> {
    /// `LEARNER/VARIANT`.
    pub model: String,
    /// Whether it is the learner's default variant.
    pub default: bool,
    /// Task of the learner.
    pub task: Option<Task>,
    /// Description in one line.
    pub description: &'a str,
    /// Data that the weights were trained and measured on; `None` for an algorithm without weights.
    pub grade: Option<Grade>,
    /// Accuracy on named data, if measured.
    pub accuracy: Option<Accuracy<'a>>,
    /// Size of the model's files in bytes.
    pub bytes: u64,
    /// Size of the download in bytes: that of the package which contains the files, if there is one.
    pub download_bytes: u64,
    /// Terms of use.
    pub licence: &'a Licence,
    /// First public source.
    pub source: String,
    /// Whether it is on this machine.
    pub cached: bool,
    /// Frames or calls per second.
    pub fps: Option<f64>,
    /// Processing time per second of audio.
    pub real_time_factor: Option<f64>,
    /// Median time of a call in milliseconds.
    pub p50_ms: Option<f64>,
    /// Peak memory of the process in MB.
    pub peak_mb: Option<f64>,
    /// CPU, threads and runtime of the measurement.
    pub measured_on: Option<&'a str>,
}

/// Which models are listed; by default all.
#[derive(Debug, Clone, Copy, Default)]
pub struct ModelFilter {
    /// Models for this task only.
    pub task: Option<Task>,
    /// Models of this grade or a better one only.
    pub grade: Option<Grade>,
    /// Models whose licences allow commercial use only.
    pub commercial: bool,
    /// Models on this machine only.
    pub cached: bool,
}

impl Zoo {
    /// Returns the models that pass the filter, in the order of the cards.
    pub fn models(&self, filter: &ModelFilter) -> Vec<ModelSummary<'_>> {
        let items = self.items().filter(|item| item.card.kind == ItemKind::Model);
        items.map(|item| self.summary(item)).filter(|model| filter.passes(model)).collect()
    }

    fn summary<'a>(&'a self, item: Item<'a>) -> ModelSummary<'a> {
        let (card, variant) = (item.card, item.variant);
        let speed = variant.speed.as_ref();
        ModelSummary {
            model: item.to_string(),
            default: variant.default,
            task: card.task,
            description: if variant.description.is_empty() {
                &card.description
            } else {
                &variant.description
            },
            grade: variant.grade,
            accuracy: variant.accuracy(),
            bytes: variant.size(),
            download_bytes: item.download_size(),
            licence: &variant.licence,
            source: item.public_source().map(ToString::to_string).unwrap_or_default(),
            cached: self.ready(&item).is_some(),
            fps: speed.and_then(|speed| speed.fps),
            real_time_factor: speed.and_then(|speed| speed.real_time_factor),
            p50_ms: speed.and_then(|speed| speed.p50_ms),
            peak_mb: speed.map(|speed| speed.peak_mb),
            measured_on: speed.map(|speed| speed.measured_on.as_str()),
        }
    }
}

impl ModelFilter {
    fn passes(&self, model: &ModelSummary<'_>) -> bool {
        self.task.is_none_or(|task| model.task == Some(task))
            && self.grade.is_none_or(|least| model.grade >= Some(least))
            && (!self.commercial || model.licence.commercial == Some(true))
            && (!self.cached || model.cached)
    }
}
