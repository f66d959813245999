//! Optimisation of a learner's container with a data set.

use std::path::Path;

use opendr_datasets::Problems;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{AnyLearner, Entry, Ports};
use opendr_engine::model::Model;
use opendr_engine::params::ParamMap;
use opendr_engine::{Device, Error, Progress, Result, ResultExt, Unit};
use opendr_evaluation::{Evaluation, Subject, metric_of};
use opendr_inference::recording::{self, Recording};

use crate::optimize::{MetricValue, optimize};
use crate::options::{OptimizeOptions, Precision};
use crate::report::Report;

/// Maximum memory of recorded session inputs, in bytes; enough for hundreds of images.
const MOST_BYTES: usize = 1 << 30;

/// The optimisation of a learner's container: INT8 or FP16, with calibration and validation data.
#[derive(Clone, Copy)]
pub struct OptimizeJob<'a> {
    /// The learner.
    pub entry: &'a Entry,
    /// Path of its container.
    pub model: &'a Path,
    /// Options.
    pub options: &'a OptimizeOptions,
    /// Samples for the calibration of `int8`, spread over the data set. Annotations are not needed.
    pub calibration: Option<&'a dyn DatasetIterator>,
    /// Samples with annotations for the task's metric before and after.
    pub validation: Option<&'a dyn DatasetIterator>,
    /// Path of the written container.
    pub output: &'a Path,
    /// Device of the networks.
    pub device: Device,
    /// Receiver of progress; also asked whether to stop.
    pub progress: &'a dyn Progress,
}

impl OptimizeJob<'_> {
    /// Writes the optimised container.
    ///
    /// # Errors
    /// Those of [`optimize`](crate::optimize()), and those of the learner and the data sets.
    pub fn run(&self) -> Result<Report> {
        let model = Model::open(self.model)?;
        let recordings = match (self.options.precision, self.calibration) {
            (Precision::Int8, Some(dataset)) => self.record(dataset)?,
            _ => Vec::new(),
        };
        let mut judge = |model: &Model| self.measure(model);
        let judge = self.validation.is_some().then_some(&mut judge as _);
        optimize(&model, self.options, &recordings, judge, self.device, self.output, self.progress)
    }

    fn learner(&self, model: &Path) -> Result<Box<dyn AnyLearner>> {
        let mut learner = self.entry.make(&ParamMap::new(), self.device)?;
        learner.load(model)?;
        Ok(learner)
    }

    /// Records the inputs of the learner's sessions for samples spread over the data set.
    fn record(&self, dataset: &dyn DatasetIterator) -> Result<Vec<Recording>> {
        let mut learner = self.learner(self.model)?;
        let count = self.options.samples.min(dataset.len());
        let mut recordings = Vec::new();
        let mut bytes = 0;
        self.progress.begin("calibrating", Some(count as u64), Unit::Items);
        for at in (0..count).map(|at| at * dataset.len() / count) {
            if self.progress.stopped() {
                self.progress.end();
                return Err(Error::invalid_input("stopped: nothing was written"));
            }
            learner.reset();
            let sample = dataset.get(at)?;
            let ports = self.entry.ports.iter().zip(&sample.data);
            let ports = ports.fold(Ports::default(), |named, (port, value)| named.with(port.name, value));
            recording::start();
            let inferred = learner.infer(&ports);
            let runs = recording::take();
            inferred.context(|| format!("sample {}", dataset.name(at)))?;
            bytes += runs.iter().map(Recording::bytes).sum::<usize>();
            recordings.extend(runs);
            self.progress.advance(1);
            if bytes > MOST_BYTES {
                break;
            }
        }
        self.progress.end();
        Ok(recordings)
    }

    /// Measures the selected value of the task's metric.
    fn measure(&self, model: &Model) -> Result<MetricValue> {
        let dataset = self.validation.ok_or_else(|| Error::internal("no validation data"))?;
        let metric = opendr_metrics::find(metric_of(self.entry.spec.task)?)?;
        let problems = Problems::strict();
        let subject = Subject { learner: self.entry.spec.name.to_owned(), ..Subject::default() };
        let evaluation =
            Evaluation { progress: self.progress, ..Evaluation::new(subject, metric, &problems) };
        let mut learners = [self.learner(model.path())?];
        let outcome = evaluation.run(&mut learners, self.entry, dataset)?;
        if !outcome.complete {
            return Err(Error::invalid_input("stopped while measuring"));
        }
        let name = self.options.measured_by.clone().unwrap_or(outcome.report.headline);
        let scalars = &outcome.report.statistics.scalars;
        let value = scalars.get(&name).copied().ok_or_else(|| {
            let names: Vec<_> = scalars.keys().map(String::as_str).collect();
            Error::invalid_param(format!(
                "measured_by: the metric {} has no value {name:?}; it has {}",
                metric.name,
                names.join(", ")
            ))
        })?;
        Ok(MetricValue { is_error: metric.is_lower_better(&name), name, value })
    }
}
