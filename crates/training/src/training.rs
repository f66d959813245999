//! The training loop of every `fit`.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use burn::module::Module;
use burn::optim::{GradientsAccumulator, GradientsParams, ModuleOptimizer};
use burn::tensor::{Device, Tensor};
use opendr_datasets::loader::{Batch, Collate, Loader, LoaderOptions};
use opendr_engine::data::Image;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::FitJob;
use opendr_engine::params::Params;
use opendr_engine::{Error, Random, Result, ResultExt, Statistics, Unit};
use opendr_runlog::{Checkpoints, RunLog};

use crate::average::Average;
use crate::checkpoint::Saved;
use crate::gradient::{gradient_norm, scaled};
use crate::kept_heap::KeptHeap;
use crate::memory::{TRIAL_SAMPLES, check_memory};
use crate::optimizer::optimizer;
use crate::schedule::Schedule;
use crate::training_state::{Best, Setting, TrainingState};
use crate::{Container, Objective, TrainingParams, training_device};

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
    if dataset.is_empty() {
        return Err(Error::invalid_input("the training data set is empty"));
    }
    let _heap = KeptHeap::new();
    let mut training = Training::new(objective, network, params, dataset, job)?;
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

struct Training<'a, O: Objective> {
    objective: &'a O,
    params: &'a TrainingParams,
    dataset: &'a dyn DatasetIterator,
    job: &'a FitJob<'a>,
    /// Device that records gradients.
    device: Device,
    network: Option<O::Network>,
    average: Option<Average<O::Network>>,
    optimizer: ModuleOptimizer,
    gradients: GradientsAccumulator<O::Network>,
    /// Number of batches whose gradients are accumulated.
    accumulated: usize,
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

impl<'a, O: Objective> Training<'a, O> {
    fn new(
        objective: &'a O,
        network: O::Network,
        params: &'a TrainingParams,
        dataset: &'a dyn DatasetIterator,
        job: &'a FitJob<'a>,
    ) -> Result<Self> {
        let device = training_device(job.device)?.autodiff();
        let checkpoints = Checkpoints::new(&job.output.join(CHECKPOINTS), params.checkpoints_kept)?;
        let setting = Setting { samples: dataset.len(), params: params.to_map() };
        let batches = (dataset.len() / batch_size(params, dataset)) as u64;
        let per_epoch = batches.div_ceil(params.accumulate as u64);
        let all = per_epoch * params.epochs as u64;
        let steps = if params.max_steps == 0 { all } else { all.min(params.max_steps) };
        let mut training = Self {
            objective,
            params,
            dataset,
            job,
            average: (params.ema > 0.0).then(|| Average::new(network.valid(), params.ema)),
            network: Some(network.to_device(&device).train()),
            device,
            optimizer: optimizer(params),
            gradients: GradientsAccumulator::new(),
            accumulated: 0,
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

    /// Resumes from the last checkpoint, where the job requests it and there is one.
    fn resume(&mut self) -> Result<()> {
        let Some(checkpoint) = self.checkpoints.latest()? else { return Ok(()) };
        if !self.job.resume {
            return Err(Error::invalid_input(format!(
                "{} contains a training interrupted at step {}; resume it, or use another folder",
                self.job.output.display(),
                checkpoint.step
            )));
        }
        let saved = Saved::read(&checkpoint)?;
        saved.state.setting.check(&self.state.setting)?;
        let (Some(network), device) = (self.network.take(), &self.device) else {
            return Err(Error::internal("the training has no network"));
        };
        self.network = Some(saved.network_into(network.valid())?.to_device(device).train());
        if let Some(average) = self.average.take() {
            let network = saved.average_into(average.network().clone())?;
            self.average = Some(Average::new(network, self.params.ema));
        }
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
            let skipped = loader.for_each(epoch, position, |batch| self.batch(batch))?;
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

    fn loader(&self, options: LoaderOptions) -> Result<Loader<'a, O::Collate>> {
        let loader = Loader::new(self.dataset, options)?.augment(self.objective.pipeline()?);
        Ok(loader.collate(self.objective.collate()?))
    }

    /// Runs a forward and backward pass of a few samples on a copy of the network, without side effects.
    fn trial_step(&self) -> Result<()> {
        let options = LoaderOptions { batch_size: TRIAL_SAMPLES, threads: 0, ..self.loader_options() };
        let loader = self.loader(options)?;
        let Some(network) = &self.network else {
            return Err(Error::internal("the training has no network"));
        };
        let network = network.valid().to_device(&self.device).train();
        let tried = loader.for_each(0, 0, |batch| {
            let loss = self.objective.loss(&network, &batch.content, &self.device)?;
            drop(loss.total.backward());
            Ok(ControlFlow::Break(()))
        });
        tried.map(drop)
    }

    /// Processes one batch, and runs an optimiser step once enough gradients are accumulated.
    fn batch(&mut self, batch: Batch<<O::Collate as Collate>::Batch>) -> Result<ControlFlow<()>> {
        if self.state.step >= self.steps {
            self.halt = Some(Halt::Done);
            return Ok(ControlFlow::Break(()));
        }
        let Some(network) = self.network.take() else {
            return Err(Error::internal("the training has no network"));
        };
        // Dropout depends on the position alone, so that a resumed training repeats it.
        let place = [self.params.seed, NETWORK, batch.epoch, batch.next_position as u64];
        self.device.seed(Random::from_key(place).bits());
        let loss = self.objective.loss(&network, &batch.content, &self.device)?;
        let value = scalar(loss.total.clone());
        if !value.is_finite() {
            return Err(self.non_finite("loss", value, &batch.indices));
        }
        let share = 1.0 / self.params.accumulate as f64;
        let gradients = GradientsParams::from_grads((loss.total * share).backward(), &network);
        self.gradients.accumulate(&network, gradients);
        self.accumulated += 1;
        self.images += batch.indices.len() as u64;
        self.state.loss_sum += value;
        self.state.batches += 1;
        self.state.position = batch.next_position;
        let last = self.dataset.len() - batch.next_position < self.params.batch_size;
        self.network = Some(if self.accumulated == self.params.accumulate || last {
            self.step(network, &batch.indices)?
        } else {
            network
        });
        if self.accumulated == 0 {
            self.after_step(value, &loss.parts)?;
        }
        if self.job.progress.stopped() && self.accumulated == 0 {
            self.halt = Some(Halt::Stopped);
            return Ok(ControlFlow::Break(()));
        }
        Ok(ControlFlow::Continue(()))
    }

    fn step(&mut self, network: O::Network, indices: &[usize]) -> Result<O::Network> {
        let mut gradients = self.gradients.grads();
        self.accumulated = 0;
        if self.params.grad_clip > 0.0 {
            let norm = gradient_norm(&network, &gradients);
            if !norm.is_finite() {
                return Err(self.non_finite("gradient", norm, indices));
            }
            if norm > self.params.grad_clip {
                gradients = scaled(&network, gradients, self.params.grad_clip / norm);
            }
        }
        let lr = self.schedule.lr(self.state.step);
        let network = self.optimizer.step(lr, network, gradients);
        self.state.step += 1;
        if let Some(average) = self.average.take() {
            self.average = Some(average.update(&network.valid(), self.state.step));
        }
        Ok(network)
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
        match validate {
            Some(validate) if due => self.validate(validate),
            _ => Ok(()),
        }
    }

    /// Validates the current network and keeps the best one.
    fn validate(&mut self, validate: &mut Validate<'_>) -> Result<()> {
        let candidate = self.job.output.join(CANDIDATE);
        self.container()?.write(&candidate)?;
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
            self.container()?.write(&self.job.model())?;
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
            self.container()?.write(&self.job.model())?;
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

    /// Returns the container of the network: of the average where there is one.
    fn container(&self) -> Result<Container> {
        match (&self.average, &self.network) {
            (Some(average), _) => self.objective.container(average.network()),
            (None, Some(network)) => self.objective.container(&network.valid()),
            (None, None) => Err(Error::internal("the training has no network")),
        }
    }

    fn save(&mut self) -> Result<()> {
        self.state.seconds = self.earlier_seconds + self.started_at.elapsed().as_secs_f64();
        let Some(network) = &self.network else {
            return Err(Error::internal("the training has no network"));
        };
        let average = self.average.as_ref().map(Average::network);
        // Rows before the checkpoint are not written again by a resumed training.
        self.log.flush()?;
        let saved = Saved::files(&self.state, network.valid(), average, &self.optimizer)?;
        let files: Vec<_> = saved.iter().map(|(name, bytes)| (*name, bytes.as_slice())).collect();
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
