//! The training loop of every `fit`.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use burn::optim::ModuleOptimizer;
use burn::tensor::{Device, Tensor};
use opendr_datasets::loader::{Batch, Loader, LoaderOptions};
use opendr_engine::data::Image;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{FitJob, TrainingGroup};
use opendr_engine::params::Params;
use opendr_engine::{Error, Random, Result, ResultExt, Statistics, Unit};
use opendr_runlog::{Checkpoint, Checkpoints, RunLog};

use crate::any_collate::{AnyBatch, AnyCollate};
use crate::checkpoint::{Saved, checkpoint_bytes, save_checkpoint, state_files};
use crate::gradients::NetworkGradients;
use crate::kept_heap::KeptHeap;
use crate::memory::{TRIAL_SAMPLES, check_memory};
use crate::optimizer::optimizer;
use crate::payload::take;
use crate::running_statistics::running_statistics;
use crate::schedule::Schedule;
use crate::step_sum::{BatchResult, StepSum};
use crate::trained_network::{NetworkOf, TrainedNetwork};
use crate::training_state::{Best, Setting, TrainingState};
use crate::{Loss, Objective, TrainingParams, training_device};

/// Result of a validation.
pub struct Score {
    /// Name of the headline metric.
    pub name: String,
    /// Value of the headline metric.
    pub value: f64,
    /// Whether a lower value is better.
    pub is_error: bool,
    /// All metrics, for the log.
    pub numbers: BTreeMap<String, f64>,
    /// A few samples with predictions, for the log.
    pub image: Option<Image>,
}

/// Evaluates a container on validation data.
pub type Validate<'a> = &'a mut dyn FnMut(&Path) -> Result<Score>;

/// Seed offset of the network's random numbers: initial weights, dropout.
const NETWORK: u64 = u64::MAX - 1;
/// Folder of the checkpoints within the output folder.
const CHECKPOINTS: &str = "checkpoints";
/// Container that is validated, within the output folder.
const CANDIDATE: &str = "candidate";

/// Returns the device of a job with a seeded random number generator, on which the network is created.
///
/// # Errors
/// The errors of [`training_device`].
pub fn seeded_device(job: &FitJob<'_>, params: &TrainingParams) -> Result<Device> {
    let device = training_device(job.device)?;
    device.seed(Random::from_key([params.seed, NETWORK]).bits());
    Ok(device)
}

/// Trains `network` on `dataset` and writes the result as a container into [`FitJob::model`].
///
/// The processes of [`FitJob::group`] share the batches of each step, of which there are [`TrainingParams::accumulate`]: the weights are
/// those of one process with the same parameters, bit for bit.
///
/// On the CPU of one machine, the same seed yields the same weights, bit for bit, as long as no other training runs in the same
/// process: Burn has one random number generator.
///
/// With `validate`, the network with the best score is written; without, the last one. When the user stops the training, a
/// checkpoint, from which a resumed training continues identically, and the current container are written.
///
/// # Errors
/// `InvalidInput` for a data set that is empty or does not fit, or an output folder with another training; `InvalidParam` for a
/// resumed training with other parameters; `Internal` when the loss is not finite; `Io` when a file cannot be written.
pub fn fit_network<O: Objective>(
    objective: &O,
    network: O::Network,
    params: &TrainingParams,
    dataset: &dyn DatasetIterator,
    validate: Option<Validate<'_>>,
    job: &FitJob<'_>,
) -> Result<Statistics> {
    params.check()?;
    let device = training_device(job.device)?.autodiff();
    let mut network = NetworkOf::new(objective, network, params.ema > 0.0, &device);
    fit_any_network(&mut network, params, dataset, validate, job)
}

/// [`fit_network`] for a network of any type.
fn fit_any_network(
    network: &mut dyn TrainedNetwork,
    params: &TrainingParams,
    dataset: &dyn DatasetIterator,
    validate: Option<Validate<'_>>,
    job: &FitJob<'_>,
) -> Result<Statistics> {
    if dataset.is_empty() {
        return Err(Error::invalid_input("the training data set is empty"));
    }
    let (accumulate, size) = (params.accumulate, job.group.map_or(1, TrainingGroup::size));
    if !accumulate.is_multiple_of(size) {
        return Err(Error::invalid_param(format!(
            "accumulate = {accumulate} batches of a step cannot be divided among {size} processes; set it to a multiple of {size}"
        )));
    }
    let _heap = KeptHeap::new();
    let mut training = Training::new(network, params, dataset, job)?;
    let done = training.run(validate);
    job.progress.end();
    done?;
    Ok(training.state.statistics)
}

/// Reason for the end of the loop.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Halt {
    /// Stopped by the user.
    Stopped,
    /// All steps are done, or the metric no longer improves.
    Done,
}

/// What is logged and reported of a batch.
struct LastBatch {
    indices: Vec<usize>,
    parts: Vec<(&'static str, Tensor<1>)>,
}

struct Training<'a> {
    network: &'a mut dyn TrainedNetwork,
    params: &'a TrainingParams,
    dataset: &'a dyn DatasetIterator,
    job: &'a FitJob<'a>,
    /// Device that records gradients.
    device: Device,
    optimizer: ModuleOptimizer,
    /// Device of gradients.
    gradient_device: Device,
    /// Number of batches and of optimiser steps of an epoch.
    batches_per_epoch: usize,
    steps_per_epoch: usize,
    /// Number of the step within the epoch.
    step_of_epoch: usize,
    sum: StepSum,
    /// Running statistics of batch normalisation before the step; empty where a step has one batch.
    statistics: Vec<Vec<f32>>,
    /// Batches of the step for the other processes of a group.
    sent: Vec<u8>,
    /// The last batch of this process.
    last: Option<LastBatch>,
    schedule: Schedule,
    checkpoints: Checkpoints,
    log: RunLog,
    state: TrainingState,
    steps: u64,
    started_at: Instant,
    /// Seconds of earlier runs.
    earlier_seconds: f64,
    saved_at: Instant,
    shown_at: Instant,
    images: u64,
    halt: Option<Halt>,
}

/// Returns the number of samples of a batch, at most those of the data set.
fn batch_size(params: &TrainingParams, dataset: &dyn DatasetIterator) -> usize {
    params.batch_size.min(dataset.len())
}

impl<'a> Training<'a> {
    fn new(
        network: &'a mut dyn TrainedNetwork,
        params: &'a TrainingParams,
        dataset: &'a dyn DatasetIterator,
        job: &'a FitJob<'a>,
    ) -> Result<Self> {
        let gradient_device = training_device(job.device)?;
        let device = gradient_device.clone().autodiff();
        let checkpoints = Checkpoints::new(&job.output.join(CHECKPOINTS), params.checkpoints_kept)?;
        let setting = Setting { samples: dataset.len(), params: params.to_map() };
        let batches = (dataset.len() / batch_size(params, dataset)) as u64;
        let per_epoch = batches.div_ceil(params.accumulate as u64);
        let all = per_epoch * params.epochs as u64;
        let steps = if params.max_steps == 0 { all } else { all.min(params.max_steps) };
        let mut training = Self {
            network,
            params,
            dataset,
            job,
            device,
            optimizer: optimizer(params),
            gradient_device,
            batches_per_epoch: batches as usize,
            steps_per_epoch: per_epoch as usize,
            step_of_epoch: 0,
            sum: StepSum::default(),
            statistics: Vec::new(),
            sent: Vec::new(),
            last: None,
            schedule: Schedule::new(params, steps, per_epoch),
            checkpoints,
            log: RunLog::open(None, None)?,
            state: TrainingState { setting, ..TrainingState::default() },
            steps,
            started_at: Instant::now(),
            earlier_seconds: 0.0,
            saved_at: Instant::now(),
            shown_at: Instant::now(),
            images: 0,
            halt: None,
        };
        training.resume()?;
        training.check_group()?;
        let resumed = (training.state.step > 0).then_some(training.state.step);
        training.log = RunLog::open(job.logging_path, resumed)?;
        Ok(training)
    }

    /// Options of the data loader.
    fn loader_options(&self) -> LoaderOptions {
        LoaderOptions {
            batch_size: batch_size(self.params, self.dataset),
            threads: self.params.num_workers,
            seed: self.params.seed,
            // A last batch of one or two samples would distort the statistics of batch normalisation.
            drop_last: true,
            skip_broken: self.job.skip_broken,
            ..LoaderOptions::default()
        }
    }

    /// Returns the checkpoint of process 0, which the others save as theirs.
    fn checkpoint_of_group(
        &self,
        group: &dyn TrainingGroup,
        own: Option<Checkpoint>,
    ) -> Result<Option<Checkpoint>> {
        if group.rank() == 0 {
            group.all_gather(own.as_ref().map_or_else(|| Ok(Vec::new()), checkpoint_bytes)?)?;
            return Ok(own);
        }
        let all = group.all_gather(Vec::new())?;
        let Some(bytes) = all.first().filter(|bytes| !bytes.is_empty()) else { return Ok(None) };
        save_checkpoint(&self.checkpoints, bytes)?;
        self.checkpoints.latest()
    }

    /// Checks that all processes of a group train the same.
    fn check_group(&self) -> Result<()> {
        let Some(group) = self.job.group else { return Ok(()) };
        let TrainingState { setting, step, .. } = &self.state;
        let own = serde_json::to_vec(&(setting, step))
            .map_err(|error| Error::internal("the parameters of the training").with_source(error))?;
        let all = group.all_gather(own.clone())?;
        match all.iter().position(|other| *other != own) {
            Some(rank) => Err(Error::invalid_input(format!(
                "process {rank} of the training has other data, parameters or checkpoints than process {}",
                group.rank()
            ))),
            None => Ok(()),
        }
    }

    /// Resumes from the last checkpoint, where the job requests it and there is one.
    fn resume(&mut self) -> Result<()> {
        let own = self.checkpoints.latest()?;
        if let (Some(checkpoint), false) = (&own, self.job.resume) {
            return Err(Error::invalid_input(format!(
                "{} contains a training interrupted at step {}; resume it, or use another folder",
                self.job.output.display(),
                checkpoint.step
            )));
        }
        let Some(checkpoint) = (match self.job.group {
            Some(group) => self.checkpoint_of_group(group, own)?,
            None => own,
        }) else {
            return Ok(());
        };
        let saved = Saved::read(&checkpoint)?;
        saved.state.setting.check(&self.state.setting)?;
        self.network.load(&saved, &self.device)?;
        self.optimizer = saved.optimizer_into(optimizer(self.params))?;
        let setting = std::mem::take(&mut self.state.setting);
        self.state = TrainingState { setting, ..saved.state };
        self.earlier_seconds = self.state.seconds;
        self.job.progress.note(&format!("resumed at step {} of {}", self.state.step, self.steps));
        Ok(())
    }

    fn run(&mut self, mut validate: Option<Validate<'_>>) -> Result<()> {
        let options = self.loader_options();
        let loader = self.loader(options)?;
        check_memory(loader.options().batch_size, || self.trial_step())?;
        self.job.progress.begin("training", Some(self.steps), Unit::Steps);
        self.job.progress.advance_resumed(self.state.step);
        while self.state.epoch < self.params.epochs as u64 && self.halt.is_none() {
            let (epoch, position) = (self.state.epoch, self.state.position);
            self.step_of_epoch = position / loader.options().batch_size / self.params.accumulate;
            let skipped = loader.for_each(epoch, position, |batch| self.batch(batch))?;
            // Steps without a batch of this process.
            while self.halt.is_none() && self.step_of_epoch < self.steps_per_epoch {
                self.finish_step()?;
            }
            if let (Some(first), 0) = (skipped.first(), epoch) {
                self.job.progress.note(&format!(
                    "{} samples are skipped; the first is {}: {}",
                    skipped.len(),
                    first.name,
                    first.error
                ));
            }
            if self.halt.is_none() {
                self.end_epoch(&mut validate)?;
            }
        }
        self.finish(validate)
    }

    fn loader(&self, options: LoaderOptions) -> Result<Loader<'a, AnyCollate>> {
        let (pipeline, collate) = self.network.preparation()?;
        let loader = Loader::new(self.dataset, options)?.augment(pipeline).collate(collate);
        match self.job.group {
            Some(group) => loader.share(group.rank(), group.size()),
            None => Ok(loader),
        }
    }

    /// Runs a forward and backward pass of a few samples on a copy of the network, without side effects.
    fn trial_step(&self) -> Result<()> {
        let options = LoaderOptions { batch_size: TRIAL_SAMPLES, threads: 0, ..self.loader_options() };
        let tried = self.loader(options)?.for_each(0, 0, |batch| {
            self.network.try_step(&*batch.content, &self.device)?;
            Ok(ControlFlow::Break(()))
        });
        tried.map(drop)
    }

    /// Processes one batch, and runs an optimiser step after the last one of a step.
    fn batch(&mut self, batch: Batch<AnyBatch>) -> Result<ControlFlow<()>> {
        let batch_size = batch_size(self.params, self.dataset);
        let number = (batch.next_position / batch_size).saturating_sub(1);
        while self.step_of_epoch < number / self.params.accumulate && self.halt.is_none() {
            self.finish_step()?;
        }
        if self.state.step >= self.steps {
            self.halt = Some(Halt::Done);
        }
        if self.halt.is_some() {
            return Ok(ControlFlow::Break(()));
        }
        let has_several = self.params.accumulate > 1 || self.job.group.is_some();
        if has_several && self.statistics.is_empty() {
            self.statistics = self.running_statistics()?;
        }
        // Dropout depends on the position alone, so that a resumed training repeats it.
        let place = [self.params.seed, NETWORK, batch.epoch, batch.next_position as u64];
        self.device.seed(Random::from_key(place).bits());
        let Loss { total, parts } = self.network.loss(&*batch.content, &self.device)?;
        let loss = scalar(total.clone());
        if !loss.is_finite() {
            return Err(self.non_finite("loss", loss, &batch.indices));
        }
        let share = 1.0 / self.params.accumulate as f64;
        let mut result = BatchResult {
            number: number % self.params.accumulate,
            samples: batch.indices.len(),
            loss,
            statistics: Vec::new(),
            gradients: NetworkGradients::new(self.network.module()?, (total * share).backward()),
        };
        // Each batch of a step begins with the same statistics, so that their result does not depend on who processes them.
        if has_several {
            result.statistics = self.running_statistics()?;
            self.network.set_statistics(&self.statistics)?;
        }
        match self.job.group {
            Some(_) => result.write(&mut self.sent),
            None => self.sum.add(result),
        }
        self.last = Some(LastBatch { indices: batch.indices, parts });
        let end = ((self.step_of_epoch + 1) * self.params.accumulate).min(self.batches_per_epoch);
        if number + self.job.group.map_or(1, TrainingGroup::size) >= end {
            self.finish_step()?;
        }
        Ok(if self.halt.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    /// Ends a step of the epoch: adds the batches of the other processes, and changes the weights where there were batches.
    fn finish_step(&mut self) -> Result<()> {
        if self.state.step >= self.steps {
            self.halt = Some(Halt::Done);
            return Ok(());
        }
        let stopped = match self.job.group {
            Some(group) => self.add_batches_of_group(group)?,
            None => false,
        };
        self.step_of_epoch += 1;
        let end = (self.step_of_epoch * self.params.accumulate).min(self.batches_per_epoch);
        self.state.position = end * batch_size(self.params, self.dataset);
        let sum = std::mem::take(&mut self.sum);
        let last = self.last.take();
        let statistics = std::mem::take(&mut self.statistics);
        let Some(&loss) = sum.losses.last() else { return Ok(()) };
        self.state.loss_sum = sum.losses.iter().fold(self.state.loss_sum, |sum, loss| sum + loss);
        self.state.batches += sum.losses.len() as u64;
        self.images += sum.samples as u64;
        if !statistics.is_empty() {
            self.network.set_statistics(&sum.statistics())?;
        }
        self.step(sum.gradients, last.as_ref().map_or(&[][..], |last| &last.indices))?;
        self.after_step(loss, last.as_ref().map_or(&[][..], |last| &last.parts))?;
        // Processes of a group stop at the same step.
        if stopped || (self.job.group.is_none() && self.job.progress.stopped()) {
            self.halt = Some(Halt::Stopped);
        }
        Ok(())
    }

    /// Sums the batches of all processes of the group in their order. Returns whether the user of one of them stops the training.
    fn add_batches_of_group(&mut self, group: &dyn TrainingGroup) -> Result<bool> {
        let mut own = vec![u8::from(self.job.progress.stopped())];
        own.append(&mut self.sent);
        if self.statistics.is_empty() {
            self.statistics = self.running_statistics()?;
        }
        let network = self.network.module()?;
        let (mut batches, mut stopped) = (Vec::new(), false);
        for payload in group.all_gather(own)? {
            let mut bytes = payload.as_slice();
            stopped |= take(&mut bytes)? != [0];
            while !bytes.is_empty() {
                batches.push(BatchResult::read(
                    network,
                    &self.gradient_device,
                    &self.statistics,
                    &mut bytes,
                )?);
            }
        }
        batches.sort_by_key(|batch| batch.number);
        batches.into_iter().for_each(|batch| self.sum.add(batch));
        Ok(stopped)
    }

    /// Returns the running statistics of batch normalisation.
    fn running_statistics(&self) -> Result<Vec<Vec<f32>>> {
        self.network.settle_statistics()?;
        Ok(running_statistics(self.network.module()?))
    }

    fn step(&mut self, mut gradients: NetworkGradients, indices: &[usize]) -> Result<()> {
        if self.params.grad_clip > 0.0 {
            let norm = gradients.norm();
            if !norm.is_finite() {
                return Err(self.non_finite("gradient", norm, indices));
            }
            if norm > self.params.grad_clip {
                gradients.scale(self.params.grad_clip / norm);
            }
        }
        let gradients = gradients.into_params(self.network.module()?);
        self.network.step(&mut self.optimizer, self.schedule.lr(self.state.step), gradients)?;
        self.state.step += 1;
        self.network.update_average(self.params.ema, self.state.step)
    }

    /// Logs, reports progress and saves a checkpoint where due.
    fn after_step(&mut self, loss: f64, parts: &[(&'static str, Tensor<1>)]) -> Result<()> {
        let step = self.state.step;
        self.job.progress.advance(1);
        if step.is_multiple_of(self.params.log_after) || step == 1 {
            self.log.scalar("train/loss", step, loss)?;
            self.log.scalar("train/lr", step, self.schedule.lr(step - 1))?;
            for (name, part) in parts {
                self.log.scalar(&format!("train/{name}"), step, scalar(part.clone()))?;
            }
        }
        if self.shown_at.elapsed() > Duration::from_millis(200) {
            let rate = self.images as f64 / self.started_at.elapsed().as_secs_f64();
            let best = self.state.best.as_ref().map(|best| format!(", best {:.4}", best.value));
            self.job.progress.status(&format!(
                "epoch {}/{}, loss {:.4}{}, {rate:.1} samples/s",
                self.state.epoch + 1,
                self.params.epochs,
                self.state.loss_sum / self.state.batches.max(1) as f64,
                best.unwrap_or_default(),
            ));
            self.shown_at = Instant::now();
        }
        let after = self.params.checkpoint_after_iter;
        let minutes = Duration::from_secs_f64(self.params.checkpoint_minutes * 60.0);
        let due = (after > 0 && step.is_multiple_of(after))
            || (!minutes.is_zero() && self.saved_at.elapsed() >= minutes);
        if due { self.save() } else { Ok(()) }
    }

    fn end_epoch(&mut self, validate: &mut Option<Validate<'_>>) -> Result<()> {
        let TrainingState { loss_sum, batches, .. } = self.state;
        if batches > 0 {
            let mean = loss_sum / batches as f64;
            self.state.statistics.push("loss", mean);
            self.log.scalar("train/epoch_loss", self.state.step, mean)?;
        }
        self.state.epoch += 1;
        (self.state.position, self.state.loss_sum, self.state.batches) = (0, 0.0, 0);
        let last = self.state.epoch == self.params.epochs as u64 || self.state.step >= self.steps;
        let due = self.state.epoch.is_multiple_of(self.params.val_after as u64) || last;
        if let (Some(validate), true) = (validate, due) {
            self.validate(validate)?;
        }
        // Process 0 validates, and may end the training.
        if let Some(group) = self.job.group {
            let ends = group.all_gather(vec![u8::from(self.halt.is_some())])?;
            if ends.iter().any(|end| *end != [0]) {
                self.halt = Some(Halt::Done);
            }
        }
        Ok(())
    }

    /// Validates the current network and keeps the best one.
    fn validate(&mut self, validate: &mut Validate<'_>) -> Result<()> {
        let candidate = self.job.output.join(CANDIDATE);
        self.network.container()?.write(&candidate)?;
        let Score { name, value, is_error, numbers, image: picture } = validate(&candidate)?;
        // The evaluation used the progress bar.
        self.job.progress.begin("training", Some(self.steps), Unit::Steps);
        self.job.progress.advance_resumed(self.state.step);
        let step = self.state.step;
        for (name, value) in &numbers {
            self.state.statistics.push(format!("val_{name}"), *value);
            self.log.scalar(&format!("val/{name}"), step, *value)?;
        }
        if let Some(picture) = picture {
            self.log.image("val/answers", step, &picture)?;
        }
        self.log.flush()?;
        let better = |best: &Best| if is_error { value < best.value } else { value > best.value };
        if self.state.best.as_ref().is_none_or(better) {
            self.state.best = Some(Best { value, step });
            self.state.since_best = 0;
            self.network.container()?.write(&self.job.model())?;
        } else {
            self.state.since_best += 1;
        }
        self.job.progress.note(&format!("epoch {}: {name} {value:.4}", self.state.epoch));
        if self.params.early_stop > 0 && self.state.since_best >= self.params.early_stop {
            self.job
                .progress
                .note(&format!("no better {name} in {} validations; training ends", self.params.early_stop));
            self.halt = Some(Halt::Done);
        }
        Ok(())
    }

    fn finish(&mut self, validate: Option<Validate<'_>>) -> Result<()> {
        self.save()?;
        if self.state.best.is_none() || validate.is_none() {
            self.network.container()?.write(&self.job.model())?;
        }
        let candidate = self.job.output.join(CANDIDATE);
        if candidate.exists() {
            std::fs::remove_dir_all(&candidate).context(|| candidate.display().to_string())?;
        }
        if self.halt == Some(Halt::Stopped) {
            self.job.progress.note(&format!(
                "stopped at step {} of {}; resume with the output folder {}",
                self.state.step,
                self.steps,
                self.job.output.display()
            ));
        }
        let statistics = &mut self.state.statistics;
        statistics.set("steps", self.state.step as f64);
        statistics.set("epochs", self.state.epoch as f64);
        statistics.set("seconds", self.state.seconds);
        if let Some(best) = &self.state.best {
            statistics.set("best", best.value);
            statistics.set("best_step", best.step as f64);
        }
        self.log.flush()
    }

    fn save(&mut self) -> Result<()> {
        if self.job.group.is_some_and(|group| group.rank() > 0) {
            return Ok(());
        }
        self.state.seconds = self.earlier_seconds + self.started_at.elapsed().as_secs_f64();
        // Rows before the checkpoint are not written again by a resumed training.
        self.log.flush()?;
        let (state, network) = (state_files(&self.state, &self.optimizer)?, self.network.files()?);
        let files: Vec<_> =
            state.iter().chain(&network).map(|(name, bytes)| (*name, bytes.as_slice())).collect();
        self.checkpoints.save(self.state.step, &files)?;
        self.saved_at = Instant::now();
        Ok(())
    }

    #[cold]
    fn non_finite(&self, what: &str, value: f64, indices: &[usize]) -> Error {
        let names: Vec<String> = indices.iter().take(8).map(|index| self.dataset.name(*index)).collect();
        let more = indices.len().saturating_sub(names.len());
        let kept = match self.checkpoints.latest() {
            Ok(Some(checkpoint)) => format!("the last good checkpoint is {}", checkpoint.path().display()),
            _ => "there is no checkpoint yet".to_owned(),
        };
        Error::internal(format!(
            "the {what} of step {} is {value} on the samples {}{}; {kept}; lower lr or set grad_clip",
            self.state.step,
            names.join(", "),
            if more > 0 { format!(" and {more} more") } else { String::new() }
        ))
    }
}

fn scalar(tensor: Tensor<1>) -> f64 {
    f64::from(tensor.into_scalar::<f32>())
}
