//! `fit` of a learner, validated with the metric of its task.

use std::path::Path;

use opendr_datasets::{Problems, draw_sample};
use opendr_engine::data::Image;
use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{AnyLearner, Entry, FitJob, Learner, Ports, Probe};
use opendr_engine::params::Params;
use opendr_engine::{Device, Error, Result, Statistics};
use opendr_evaluation::{Evaluation, Subject, metric_of, open_for_metric};
use opendr_metrics::{MetricEntry, find};
use opendr_vision::draw;

use crate::training::Score;
use crate::{Objective, TrainingParams, fit_network};

/// Trains the network of a learner on `dataset`. With validation data, it keeps the network with the best value of the task's
/// metric, measured through the learner.
///
/// # Errors
/// The errors of [`fit_network`] and of the evaluation.
pub fn fit_learner<L: Learner, O: Objective>(
    objective: &O,
    network: O::Network,
    learner_params: &L::Params,
    params: &TrainingParams,
    dataset: &dyn DatasetIterator,
    val_dataset: Option<DatasetRef<'_>>,
    job: &FitJob<'_>,
) -> Result<Statistics> {
    let Some(val_dataset) = val_dataset else {
        return fit_network(objective, network, params, dataset, None, job);
    };
    let metric = find(metric_of(L::SPEC.task)?)?;
    let problems = Problems::strict();
    let val_dataset = match val_dataset {
        DatasetRef::Iterator(dataset) => Box::new(dataset),
        DatasetRef::External(external) => open_for_metric(metric, external, None, &problems)?,
    };
    let entry = Entry::of::<L>(Probe::<L>::abilities(None, None, None, None));
    let mut validate = |container: &Path| -> Result<Score> {
        let learner = entry.make(&learner_params.to_map(), Device::Auto)?;
        score(learner, &entry, metric, &*val_dataset, container, &problems, job)
    };
    fit_network(objective, network, params, dataset, Some(&mut validate), job)
}

/// Evaluates a container through the learner; the metric's headline is the score.
fn score(
    mut learner: Box<dyn AnyLearner>,
    entry: &Entry,
    metric: &'static MetricEntry,
    dataset: &dyn DatasetIterator,
    container: &Path,
    problems: &Problems,
    job: &FitJob<'_>,
) -> Result<Score> {
    learner.load(container)?;
    let picture = predictions_sheet(&mut *learner, entry, dataset);
    let subject = Subject { learner: entry.spec.name.to_owned(), model: None, params: learner.params() };
    let evaluation = Evaluation { progress: job.progress, ..Evaluation::new(subject, metric, problems) };
    let outcome = evaluation.run(std::slice::from_mut(&mut learner), entry, dataset)?;
    let name = outcome.report.headline;
    let numbers = outcome.report.statistics.scalars;
    let value = numbers.get(&name).copied().ok_or_else(|| {
        Error::invalid_input(format!(
            "the metric {} has no {name} on the validation data; check that the data are annotated",
            metric.name
        ))
    })?;
    let is_error = metric.is_lower_better(&name);
    Ok(Score { name, value, is_error, numbers, image: picture })
}

/// Number of predictions in the log.
const LOGGED_SAMPLES: usize = 6;
/// Side of an image in the log, in pixels.
const SIDE: usize = 300;

/// Returns a contact sheet of the first samples with their predictions, where these can be drawn. Samples that fail are
/// skipped; the evaluation reports them.
fn predictions_sheet(
    learner: &mut dyn AnyLearner,
    entry: &Entry,
    dataset: &dyn DatasetIterator,
) -> Option<Image> {
    let mut pictures = Vec::new();
    for index in 0..dataset.len().min(LOGGED_SAMPLES) {
        learner.reset();
        let Ok(mut sample) = dataset.get(index) else { continue };
        let Ok(outputs) = learner.infer(&Ports::of_sample(entry.ports, &sample.data)) else { continue };
        sample.target = outputs.iter().next().map(|(_, value)| value.clone());
        pictures.extend(draw_sample(&sample).map(|picture| (picture, dataset.name(index))));
    }
    learner.reset();
    (!pictures.is_empty()).then(|| draw::contact_sheet(&pictures, pictures.len().min(3), SIDE).ok())?
}
