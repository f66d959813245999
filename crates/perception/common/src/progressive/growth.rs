//! Training of a network in stages, of which each has a block or a layer more.

use std::path::PathBuf;

use burn::module::Module;
use opendr_engine::learner::FitJob;
use opendr_engine::model::Model;
use opendr_engine::{Error, Result, Statistics};
use opendr_training::{Container, TrainingParams};

use super::TopologyParams;
use super::inheritance::inherited;
use super::stage_progress::StageProgress;
use crate::trainable_weights::network_from_base;

/// Folder of the stages within the output folder.
const FOLDER: &str = "growth";
/// Curve of the training loss among the statistics of a training.
const LOSS: &str = "loss";
/// Curve of the loss of each stage.
const STAGE_LOSS: &str = "growth_loss";
/// Numbers of a training that are added up over the stages.
const SUMS: [&str; 3] = ["steps", "epochs", "seconds"];

/// A training of one topology: the whole training, or a stage of the growth.
pub struct Stage<'a> {
    /// Number of blocks of each layer.
    pub topology: &'a [usize],
    /// Parameters of the training.
    pub training: &'a TrainingParams,
    /// Output folder and progress of the training.
    pub job: &'a FitJob<'a>,
    /// The model to start from.
    start: Start<'a>,
}

#[derive(Clone, Copy)]
enum Start<'a> {
    /// Initial weights, or those of a model with the same topology.
    Base(Option<&'a Model>),
    /// The weights of a smaller network.
    Smaller(&'a Grown),
}

/// A network that was trained in a stage.
#[derive(Clone)]
struct Grown {
    topology: Vec<usize>,
    /// Folder of its container, which a training that was stopped early may not have written.
    model: PathBuf,
    /// Training loss of the last epoch; none where no epoch was completed.
    loss: Option<f64>,
    statistics: Statistics,
}

impl Stage<'_> {
    /// Returns `network`, which has the stage's topology and initial weights, with the weights to start from. `smaller` makes a
    /// network of another topology; the last layer of both is the field `classifier`.
    ///
    /// # Errors
    /// As [`network_from_base`], and those of `smaller`.
    pub fn network<M: Module>(&self, network: M, smaller: impl FnOnce(&[usize]) -> Result<M>) -> Result<M> {
        match self.start {
            Start::Base(base) => network_from_base(network, base),
            Start::Smaller(grown) => {
                let model = Model::open(&grown.model)?;
                let smaller = network_from_base(smaller(&grown.topology)?, Some(&model))?;
                Ok(inherited(network, &smaller, self.topology.len() > grown.topology.len()))
            }
        }
    }
}

/// Trains a network of a given topology with one call of `train`, or finds a topology by training in stages, and writes the
/// container to [`FitJob::model`].
///
/// The first stage has one layer of one block. Each further one adds a block to the last layer, with the weights of the stage
/// before in it. When the training loss no longer decreases by more than `block_threshold`, the block is removed and a layer of
/// one block is added; when a layer no longer decreases it by more than `layer_threshold`, the layer is removed and the growth
/// ends. All weights are trained in each stage. `max_steps` limits the steps of all stages together, every other parameter of
/// the training applies to each stage. Stages have folders of their own, from which a training that was stopped resumes.
///
/// # Errors
/// Those of `train`; `InvalidParam` for a model to start from without a topology.
pub fn train_topology(
    params: &TopologyParams,
    training: &TrainingParams,
    base: Option<&Model>,
    job: &FitJob<'_>,
    train: &mut dyn FnMut(&Stage<'_>) -> Result<Statistics>,
) -> Result<Statistics> {
    match (params.topology.as_slice(), base) {
        ([], None) => {
            Growth { params, training, job, train, grown: None, totals: Statistics::default() }.run()
        }
        ([], Some(base)) => Err(Error::invalid_param(format!(
            "{} has no topology, so it cannot be trained further; give the topology of its training, or train a new model",
            base.path().display()
        ))),
        (topology, base) => train(&Stage { topology, training, job, start: Start::Base(base) }),
    }
}

struct Growth<'a, 't> {
    params: &'a TopologyParams,
    training: &'a TrainingParams,
    job: &'a FitJob<'a>,
    train: &'a mut (dyn FnMut(&Stage<'_>) -> Result<Statistics> + 't),
    /// The network so far.
    grown: Option<Grown>,
    /// Sums over all stages, and the loss of each.
    totals: Statistics,
}

impl Growth<'_, '_> {
    fn run(mut self) -> Result<Statistics> {
        for _ in 0..self.params.num_layers {
            let before = self.grown.clone();
            let goes_on = self.grow_layer()?;
            let loss = self.grown.as_ref().and_then(|grown| grown.loss);
            let removed = before
                .as_ref()
                .is_some_and(|before| goes_on && !decreases(before.loss, loss, self.params.layer_threshold));
            if removed {
                self.job.progress.note("the last layer does not decrease the loss: removed");
                self.grown = before;
            }
            if removed || !goes_on {
                break;
            }
        }
        self.finish()
    }

    /// Adds a layer and grows it; returns whether the growth goes on.
    fn grow_layer(&mut self) -> Result<bool> {
        let mut topology = self.grown.as_ref().map_or_else(Vec::new, |grown| grown.topology.clone());
        topology.push(0);
        for block in 1..=self.params.num_blocks {
            if let Some(last) = topology.last_mut() {
                *last = block;
            }
            let stage = self.stage(&topology)?;
            let before = self.grown.as_ref().map(|grown| grown.loss);
            if self.has_ended() {
                // A stage that was not completed counts where it is already better.
                if before.is_none_or(|before| decreases(before, stage.loss, 0.0)) {
                    self.grown = Some(stage);
                }
                return Ok(false);
            }
            let kept = block == 1
                || before.is_some_and(|before| decreases(before, stage.loss, self.params.block_threshold));
            self.job.progress.note(&format!(
                "blocks {}: loss {:.4}{}",
                name_of(&topology),
                stage.loss.unwrap_or(f64::NAN),
                if kept { "" } else { ", the last block is removed" }
            ));
            if !kept {
                break;
            }
            self.grown = Some(stage);
        }
        Ok(true)
    }

    /// Trains a topology from the network so far.
    fn stage(&mut self, topology: &[usize]) -> Result<Grown> {
        let steps = self.steps();
        let mut training = self.training.clone();
        if training.max_steps > 0 {
            training.max_steps = training.max_steps.saturating_sub(steps).max(1);
        }
        let name = name_of(topology);
        let output = self.job.output.join(FOLDER).join(&name);
        let logging_path = self.job.logging_path.map(|path| path.join(&name));
        let progress = StageProgress { inner: self.job.progress, name: &name, steps };
        let logging_path = logging_path.as_deref();
        let job = FitJob { output: &output, logging_path, progress: &progress, ..*self.job };
        let start = self.grown.as_ref().map_or(Start::Base(None), Start::Smaller);
        let statistics = (self.train)(&Stage { topology, training: &training, job: &job, start })?;
        let loss = statistics.curves.get(LOSS).and_then(|losses| losses.last().copied());
        for sum in SUMS {
            let number = self.totals.get(sum).unwrap_or(0.0) + statistics.get(sum).unwrap_or(0.0);
            self.totals.set(sum, number);
        }
        if let Some(loss) = loss {
            self.totals.push(STAGE_LOSS, loss);
        }
        Ok(Grown { topology: topology.to_vec(), model: job.model(), loss, statistics })
    }

    fn steps(&self) -> u64 {
        self.totals.get(SUMS[0]).unwrap_or(0.0) as u64
    }

    /// Returns whether the user stopped the training or all steps are done.
    fn has_ended(&self) -> bool {
        let limit = self.training.max_steps;
        self.job.progress.stopped() || (limit > 0 && self.steps() >= limit)
    }

    /// Writes the container of the network and returns the statistics.
    fn finish(self) -> Result<Statistics> {
        let Some(grown) = self.grown else {
            return Err(Error::internal("no network was trained"));
        };
        if grown.model.exists() {
            let model = Model::open(&grown.model)?;
            let names = model.manifest().files.iter().map(|file| file.name.clone());
            let files = names.map(|name| Ok((name.clone(), model.file(&name)?))).collect::<Result<_>>()?;
            let mut manifest = model.manifest().clone();
            manifest.files.clear();
            Container { manifest, files }.write(&self.job.model())?;
        }
        let mut statistics = grown.statistics;
        statistics.scalars.extend(self.totals.scalars);
        statistics.curves.extend(self.totals.curves);
        Ok(statistics)
    }
}

/// Returns whether a loss decreases by more than the share `threshold`.
fn decreases(before: Option<f64>, after: Option<f64>, threshold: f64) -> bool {
    match (before, after) {
        (Some(before), Some(after)) => (before - after) / before > threshold,
        (before, after) => before.is_none() && after.is_some(),
    }
}

/// Returns the name of a topology: the number of blocks of each layer, e.g. `3-2`.
fn name_of(topology: &[usize]) -> String {
    topology.iter().map(ToString::to_string).collect::<Vec<_>>().join("-")
}

#[cfg(test)]
mod tests;
