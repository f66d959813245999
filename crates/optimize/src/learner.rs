//! A learner's container, made smaller with a data set.

use std::path::Path;

use opendr_datasets::Problems;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{AnyLearner, Entry, Ports};
use opendr_engine::model::Model;
use opendr_engine::params::ParamMap;
use opendr_engine::{Device, Error, Progress, Result, ResultExt, Unit};
use opendr_evaluation::{Evaluation, Subject, metric_of};
use opendr_inference::recording::{self, Recording};

use crate::optimize::{Measured, optimize};
use crate::options::{OptimizeOptions, Precision};
use crate::report::Report;

/// Bytes of what sessions were given that are kept; enough for hundreds of pictures.
const MOST_BYTES: usize = 1 << 30;

/// A learner's container, made smaller with a data set.
#[derive(Clone, Copy)]
pub struct OptimizeJob<'a> {
    /// The learner.
    pub entry: &'a Entry,
    /// Its container.
    pub model: &'a Path,
    /// How.
    pub options: &'a OptimizeOptions,
    /// What the learner looks at, spread over the data set; `int8` takes its ranges from it. Annotations are not needed.
    pub calibration: Option<&'a dyn DatasetIterator>,
    /// What the task's metric is measured on before and after.
    pub validation: Option<&'a dyn DatasetIterator>,
    /// The container that is written.
    pub output: &'a Path,
    /// Where networks run.
    pub device: Device,
    /// To whom to report; asked whether to stop.
    pub progress: &'a dyn Progress,
}

impl OptimizeJob<'_> {
    /// Writes the smaller container.
    ///
    /// # Errors
    /// As [`optimize`](crate::optimize()), and what the learner meets in the data sets.
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

    /// What the learner gives its sessions while it looks at samples spread over the data set.
    fn record(&self, dataset: &dyn DatasetIterator) -> Result<Vec<Recording>> {
        let mut learner = self.learner(self.model)?;
        let count = self.options.samples.min(dataset.len());
        let mut recordings = Vec::new();
        let mut bytes = 0;
        self.progress.begin("looking at samples", Some(count as u64), Unit::Items);
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

    /// The number of the task's metric that counts.
    fn measure(&self, model: &Model) -> Result<Measured> {
        let dataset = self.validation.ok_or_else(|| Error::internal("nothing to measure on"))?;
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
                "measured_by: {} gives no {name:?}; it gives {}",
                metric.name,
                names.join(", ")
            ))
        })?;
        Ok(Measured { is_error: metric.is_error(&name), name, value })
    }
}
