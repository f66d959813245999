//! The loop of every `fit`.

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
use crate::memory::{TRIED, check_memory};
use crate::optimizer::optimizer;
use crate::schedule::Schedule;
use crate::standing::{Best, Setting, Standing};
use crate::{Container, Objective, TrainingParams, training_device};

/// What a validation found.
pub struct Score {
    /// What the number that counts is called.
    pub name: String,
    /// The number that counts.
    pub value: f64,
    /// Whether less of it is better.
    pub is_error: bool,
    /// All numbers, for the log.
    pub numbers: BTreeMap<String, f64>,
    /// A few samples with what was answered, for the log.
    pub picture: Option<Image>,
}

/// Measures a container on validation data.
pub type Validate<'a> = &'a mut dyn FnMut(&Path) -> Result<Score>;

/// Where random numbers of the network itself begin: first weights, dropout.
const NETWORK: u64 = u64::MAX - 1;
/// The folder of the checkpoints within the output folder.
const CHECKPOINTS: &str = "checkpoints";
/// The container that is validated, within the output folder.
const CANDIDATE: &str = "candidate";

/// The device of a job, with its random numbers begun anew, for a network to be made on.
///
/// # Errors
/// As [`training_device`].
pub fn begin(job: &FitJob<'_>, params: &TrainingParams) -> Result<Device> {
    let device = training_device(job.device)?;
    device.seed(Random::at([params.seed, NETWORK]).bits());
    Ok(device)
}

/// Trains `network` on `dataset` and writes the result as a container into [`FitJob::model`].
///
/// The same seed gives the same weights, bit for bit, on the processor of one machine, as long as no other training runs in
/// the same process: Burn has one stream of random numbers.
///
/// With `validate`, what is written is the network that did best; without, the last. When the user stops it, a checkpoint
/// is written from which a resumed training goes on as if nothing had happened, and the container of what was reached.
///
/// # Errors
/// `InvalidInput` for a data set that is empty or does not fit, or an output folder that holds another training;
/// `InvalidParam` for a resumed training with other parameters; `Internal` when the loss is no number; `Io` when nothing
/// can be written.
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
        return Err(Error::invalid_input("the data set to train on is empty"));
    }
    let _heap = KeptHeap::new();
    let mut training = Training::new(objective, network, params, dataset, job)?;
    let done = training.run(validate);
    job.progress.end();
    done?;
    Ok(training.standing.statistics)
}

/// Why the loop ended before its last epoch.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Halt {
    /// The user wants it.
    Stopped,
    /// All steps are done, or the metric gets no better.
    Done,
}

struct Training<'a, O: Objective> {
    objective: &'a O,
    params: &'a TrainingParams,
    dataset: &'a dyn DatasetIterator,
    job: &'a FitJob<'a>,
    /// Where gradients are recorded.
    device: Device,
    network: Option<O::Network>,
    average: Option<Average<O::Network>>,
    optimizer: ModuleOptimizer,
    gradients: GradientsAccumulator<O::Network>,
    /// Batches whose gradients wait for the optimiser.
    waiting: usize,
    schedule: Schedule,
    checkpoints: Checkpoints,
    log: RunLog,
    standing: Standing,
    steps: u64,
    begun: Instant,
    /// Seconds of earlier runs.
    before: f64,
    saved_at: Instant,
    shown_at: Instant,
    images: u64,
    halt: Option<Halt>,
}

/// Samples of a batch: no more than there are.
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
            waiting: 0,
            schedule: Schedule::new(params, steps, per_epoch),
            checkpoints,
            log: RunLog::open(None, None)?,
            standing: Standing { setting, ..Standing::default() },
            steps,
            begun: Instant::now(),
            before: 0.0,
            saved_at: Instant::now(),
            shown_at: Instant::now(),
            images: 0,
            halt: None,
        };
        training.resume()?;
        let resumed = (training.standing.step > 0).then_some(training.standing.step);
        training.log = RunLog::open(job.logging_path, resumed)?;
        Ok(training)
    }

    /// How the data set is gone through.
    fn loader_options(&self) -> LoaderOptions {
        LoaderOptions {
            batch_size: batch_size(self.params, self.dataset),
            threads: self.params.num_workers,
            seed: self.params.seed,
            // A last batch of one or two would spoil the statistics of batch normalisation.
            drop_last: true,
            skip_broken: self.job.skip_broken,
            ..LoaderOptions::default()
        }
    }

    /// Goes on from the last checkpoint, where the job says so and there is one.
    fn resume(&mut self) -> Result<()> {
        let Some(checkpoint) = self.checkpoints.latest()? else { return Ok(()) };
        if !self.job.resume {
            return Err(Error::invalid_input(format!(
                "{} holds a training that was left at step {}; resume it, or give another folder",
                self.job.output.display(),
                checkpoint.step
            )));
        }
        let saved = Saved::read(&checkpoint)?;
        saved.standing.setting.check(&self.standing.setting)?;
        let (Some(network), device) = (self.network.take(), &self.device) else {
            return Err(Error::internal("a training without a network"));
        };
        self.network = Some(saved.network_into(network.valid())?.to_device(device).train());
        if let Some(average) = self.average.take() {
            let network = saved.average_into(average.network().clone())?;
            self.average = Some(Average::new(network, self.params.ema));
        }
        self.optimizer = saved.optimizer_into(optimizer(self.params))?;
        let setting = std::mem::take(&mut self.standing.setting);
        self.standing = Standing { setting, ..saved.standing };
        self.before = self.standing.seconds;
        self.job.progress.note(&format!("resumed at step {} of {}", self.standing.step, self.steps));
        Ok(())
    }

    fn run(&mut self, mut validate: Option<Validate<'_>>) -> Result<()> {
        let options = self.loader_options();
        let loader = self.loader(options)?;
        check_memory(loader.options().batch_size, || self.try_step())?;
        self.job.progress.begin("training", Some(self.steps), Unit::Steps);
        self.job.progress.advance(self.standing.step);
        while self.standing.epoch < self.params.epochs as u64 && self.halt.is_none() {
            let (epoch, position) = (self.standing.epoch, self.standing.position);
            let skipped = loader.for_each(epoch, position, |batch| self.batch(batch))?;
            if let (Some(first), 0) = (skipped.first(), epoch) {
                self.job.progress.note(&format!(
                    "{} samples are left out; the first is {}: {}",
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

    /// A few samples forwards and backwards, without a trace: on a copy of the network.
    fn try_step(&self) -> Result<()> {
        let options = LoaderOptions { batch_size: TRIED, threads: 0, ..self.loader_options() };
        let loader = self.loader(options)?;
        let Some(network) = &self.network else {
            return Err(Error::internal("a training without a network"));
        };
        let network = network.valid().to_device(&self.device).train();
        let tried = loader.for_each(0, 0, |batch| {
            let loss = self.objective.loss(&network, &batch.content, &self.device)?;
            drop(loss.total.backward());
            Ok(ControlFlow::Break(()))
        });
        tried.map(drop)
    }

    /// One batch forwards and backwards, and a step of the optimiser where enough gradients are there.
    fn batch(&mut self, batch: Batch<<O::Collate as Collate>::Batch>) -> Result<ControlFlow<()>> {
        if self.standing.step >= self.steps {
            self.halt = Some(Halt::Done);
            return Ok(ControlFlow::Break(()));
        }
        let Some(network) = self.network.take() else {
            return Err(Error::internal("a training without a network"));
        };
        // Dropout follows from the place alone, so that a resumed training repeats it.
        let place = [self.params.seed, NETWORK, batch.epoch, batch.next_position as u64];
        self.device.seed(Random::at(place).bits());
        let loss = self.objective.loss(&network, &batch.content, &self.device)?;
        let value = scalar(loss.total.clone());
        if !value.is_finite() {
            return Err(self.no_number("loss", value, &batch.indices));
        }
        let share = 1.0 / self.params.accumulate as f64;
        let gradients = GradientsParams::from_grads((loss.total * share).backward(), &network);
        self.gradients.accumulate(&network, gradients);
        self.waiting += 1;
        self.images += batch.indices.len() as u64;
        self.standing.loss_sum += value;
        self.standing.batches += 1;
        self.standing.position = batch.next_position;
        let last = self.dataset.len() - batch.next_position < self.params.batch_size;
        self.network = Some(if self.waiting == self.params.accumulate || last {
            self.step(network, &batch.indices)?
        } else {
            network
        });
        if self.waiting == 0 {
            self.after_step(value, &loss.parts)?;
        }
        if self.job.progress.stopped() && self.waiting == 0 {
            self.halt = Some(Halt::Stopped);
            return Ok(ControlFlow::Break(()));
        }
        Ok(ControlFlow::Continue(()))
    }

    fn step(&mut self, network: O::Network, indices: &[usize]) -> Result<O::Network> {
        let mut gradients = self.gradients.grads();
        self.waiting = 0;
        if self.params.grad_clip > 0.0 {
            let norm = gradient_norm(&network, &gradients);
            if !norm.is_finite() {
                return Err(self.no_number("gradient", norm, indices));
            }
            if norm > self.params.grad_clip {
                gradients = scaled(&network, gradients, self.params.grad_clip / norm);
            }
        }
        let lr = self.schedule.lr(self.standing.step);
        let network = self.optimizer.step(lr, network, gradients);
        self.standing.step += 1;
        if let Some(average) = self.average.take() {
            self.average = Some(average.update(&network.valid(), self.standing.step));
        }
        Ok(network)
    }

    /// Logs, shows and saves where it is time to.
    fn after_step(&mut self, loss: f64, parts: &[(&'static str, Tensor<1>)]) -> Result<()> {
        let step = self.standing.step;
        self.job.progress.advance(1);
        if step.is_multiple_of(self.params.log_after) || step == 1 {
            self.log.scalar("train/loss", step, loss)?;
            self.log.scalar("train/lr", step, self.schedule.lr(step - 1))?;
            for (name, part) in parts {
                self.log.scalar(&format!("train/{name}"), step, scalar(part.clone()))?;
            }
        }
        if self.shown_at.elapsed() > Duration::from_millis(200) {
            let rate = self.images as f64 / self.begun.elapsed().as_secs_f64();
            let best = self.standing.best.as_ref().map(|best| format!(", best {:.4}", best.value));
            self.job.progress.status(&format!(
                "epoch {}/{}, loss {:.4}{}, {rate:.1} samples/s",
                self.standing.epoch + 1,
                self.params.epochs,
                self.standing.loss_sum / self.standing.batches.max(1) as f64,
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
        let Standing { loss_sum, batches, .. } = self.standing;
        if batches > 0 {
            let mean = loss_sum / batches as f64;
            self.standing.statistics.push("loss", mean);
            self.log.scalar("train/epoch_loss", self.standing.step, mean)?;
        }
        self.standing.epoch += 1;
        (self.standing.position, self.standing.loss_sum, self.standing.batches) = (0, 0.0, 0);
        let last = self.standing.epoch == self.params.epochs as u64 || self.standing.step >= self.steps;
        let due = self.standing.epoch.is_multiple_of(self.params.val_after as u64) || last;
        match validate {
            Some(validate) if due => self.validate(validate),
            _ => Ok(()),
        }
    }

    /// Measures the network as it stands; the best is what stays.
    fn validate(&mut self, validate: &mut Validate<'_>) -> Result<()> {
        let candidate = self.job.output.join(CANDIDATE);
        self.container()?.write(&candidate)?;
        let Score { name, value, is_error, numbers, picture } = validate(&candidate)?;
        // The evaluation had the bar.
        self.job.progress.begin("training", Some(self.steps), Unit::Steps);
        self.job.progress.advance(self.standing.step);
        let step = self.standing.step;
        for (name, value) in &numbers {
            self.standing.statistics.push(format!("val_{name}"), *value);
            self.log.scalar(&format!("val/{name}"), step, *value)?;
        }
        if let Some(picture) = picture {
            self.log.picture("val/answers", step, &picture)?;
        }
        self.log.flush()?;
        let better = |best: &Best| if is_error { value < best.value } else { value > best.value };
        if self.standing.best.as_ref().is_none_or(better) {
            self.standing.best = Some(Best { value, step });
            self.standing.since_best = 0;
            self.container()?.write(&self.job.model())?;
        } else {
            self.standing.since_best += 1;
        }
        self.job.progress.note(&format!("epoch {}: {name} {value:.4}", self.standing.epoch));
        if self.params.early_stop > 0 && self.standing.since_best >= self.params.early_stop {
            self.job
                .progress
                .note(&format!("no better {name} in {} validations: done", self.params.early_stop));
            self.halt = Some(Halt::Done);
        }
        Ok(())
    }

    fn finish(&mut self, validate: Option<Validate<'_>>) -> Result<()> {
        self.save()?;
        if self.standing.best.is_none() || validate.is_none() {
            self.container()?.write(&self.job.model())?;
        }
        let candidate = self.job.output.join(CANDIDATE);
        if candidate.exists() {
            std::fs::remove_dir_all(&candidate).context(|| candidate.display().to_string())?;
        }
        if self.halt == Some(Halt::Stopped) {
            self.job.progress.note(&format!(
                "stopped at step {} of {}; resume it with the output folder {}",
                self.standing.step,
                self.steps,
                self.job.output.display()
            ));
        }
        let statistics = &mut self.standing.statistics;
        statistics.set("steps", self.standing.step as f64);
        statistics.set("epochs", self.standing.epoch as f64);
        statistics.set("seconds", self.standing.seconds);
        if let Some(best) = &self.standing.best {
            statistics.set("best", best.value);
            statistics.set("best_step", best.step as f64);
        }
        self.log.flush()
    }

    /// The network that counts: the average where there is one.
    fn container(&self) -> Result<Container> {
        match (&self.average, &self.network) {
            (Some(average), _) => self.objective.container(average.network()),
            (None, Some(network)) => self.objective.container(&network.valid()),
            (None, None) => Err(Error::internal("a training without a network")),
        }
    }

    fn save(&mut self) -> Result<()> {
        self.standing.seconds = self.before + self.begun.elapsed().as_secs_f64();
        let Some(network) = &self.network else {
            return Err(Error::internal("a training without a network"));
        };
        let average = self.average.as_ref().map(Average::network);
        // Rows before the checkpoint are not written again by a training that goes on from it.
        self.log.flush()?;
        let saved = Saved::files(&self.standing, network.valid(), average, &self.optimizer)?;
        let files: Vec<_> = saved.iter().map(|(name, bytes)| (*name, bytes.as_slice())).collect();
        self.checkpoints.save(self.standing.step, &files)?;
        self.saved_at = Instant::now();
        Ok(())
    }

    #[cold]
    fn no_number(&self, what: &str, value: f64, indices: &[usize]) -> Error {
        let names: Vec<String> = indices.iter().take(8).map(|index| self.dataset.name(*index)).collect();
        let more = indices.len().saturating_sub(names.len());
        let kept = match self.checkpoints.latest() {
            Ok(Some(checkpoint)) => format!("the last good checkpoint is {}", checkpoint.path().display()),
            _ => "there is no checkpoint yet".to_owned(),
        };
        Error::internal(format!(
            "the {what} of step {} is {value}, on the samples {}{}; {kept}; lower lr or set grad_clip",
            self.standing.step,
            names.join(", "),
            if more > 0 { format!(" and {more} more") } else { String::new() }
        ))
    }
}

fn scalar(tensor: Tensor<1>) -> f64 {
    f64::from(tensor.into_scalar::<f32>())
}
