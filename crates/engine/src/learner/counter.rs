//! A learner for tests, with two ports, an init port, state, two outputs, streaming and training. It counts boxes. The
//! tests of every surface use it (feature `test-learner`).

use std::fs;
use std::path::Path;

use crate::data::Image;
use crate::dataset::{DatasetIterator, DatasetRef};
use crate::learner::{Fit, FitJob, Inputs, Learner, Spec, Streaming, Targets};
use crate::model::{Manifest, Model, ModelWriter};
use crate::params::{ParamMap, Params};
use crate::target::{BoundingBox, BoundingBoxList, PoseList};
use crate::{Device, Error, Result, ResultExt, Statistics, Task, Unit, Value};

/// The only file of its container: one byte, the initial count.
const BIAS: &str = "bias.bin";
/// Checkpoint file of a training: the loss of each epoch so far.
const CHECKPOINT: &str = "checkpoint.json";

/// Parameters of [`Counter`].
#[derive(Debug, Clone, Params)]
pub struct CounterParams {
    /// Boxes below this score are dropped.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Factor of the count.
    #[param(default = 2, range = 1..=9, former = "scale")]
    pub factor: i64,
}

/// Training parameters of [`Counter`].
#[derive(Debug, Clone, Params)]
pub struct CounterFitParams {
    /// Number of passes over the data set.
    #[param(default = 1, range = 1..=100, alias = "iters")]
    pub epochs: usize,
    /// Factor of the loss.
    #[param(default = 1.0, range = 0.0..=10.0)]
    pub lr: f64,
}

/// Inputs of [`Counter`].
#[derive(Inputs)]
pub struct CounterInputs<'a> {
    /// An image.
    pub image: &'a Image,
    /// The detections to count.
    pub detections: &'a BoundingBoxList,
    /// Boxes whose number is the initial count.
    #[port(init)]
    pub first: Option<&'a BoundingBoxList>,
}

/// Outputs of [`Counter`].
#[derive(Default, Targets)]
pub struct CounterTargets {
    /// One box whose left edge is the count.
    pub count: BoundingBoxList,
    /// An empty list.
    pub poses: PoseList,
}

/// State of a stream: the initial count and the number of boxes so far.
#[derive(Default)]
pub struct CounterState {
    begin: f32,
    total: usize,
}

/// A learner that counts the boxes of its input.
pub struct Counter {
    params: CounterParams,
    bias: f32,
}

impl Learner for Counter {
    const SPEC: Spec =
        Spec::new("counter", Task::ObjectDetection2d).class("CounterLearner").about("Counts boxes.");
    type Params = CounterParams;
    type Input<'a> = CounterInputs<'a>;
    type Target = CounterTargets;
    type State = CounterState;

    fn load(model: &Model, params: CounterParams, _device: Device) -> Result<Self> {
        let Some(bias) = model.file(BIAS)?.first().copied() else {
            return Err(Error::format(format!("{BIAS} is empty; write the model again")));
        };
        Ok(Self { params, bias: f32::from(bias) })
    }

    fn params(&self) -> &CounterParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut CounterParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut CounterState,
        input: CounterInputs<'_>,
        target: &mut CounterTargets,
    ) -> Result<()> {
        if let Some(first) = input.first {
            state.begin = first.boxes.len() as f32;
        }
        let boxes = input.detections.boxes.iter();
        state.total += boxes.filter(|detection| detection.confidence >= self.params.threshold).count();
        let count = state.begin + self.bias + state.total as f32 * self.params.factor as f32;
        target.count.boxes.clear();
        target.count.boxes.push(BoundingBox::new(0, count, input.image.width() as f32, 1.0, 1.0, 1.0));
        Ok(())
    }
}

impl Streaming for Counter {
    fn push(
        &self,
        state: &mut CounterState,
        piece: CounterInputs<'_>,
        emit: &mut dyn FnMut(CounterTargets),
    ) -> Result<()> {
        let mut target = CounterTargets::default();
        self.infer_into(state, piece, &mut target)?;
        if state.total.is_multiple_of(2) {
            emit(target);
        }
        Ok(())
    }

    fn flush(&self, state: &mut CounterState, emit: &mut dyn FnMut(CounterTargets)) -> Result<()> {
        let mut target = CounterTargets::default();
        target.count.boxes.push(BoundingBox::new(0, state.total as f32, 0.0, 0.0, 0.0, 0.0));
        emit(target);
        Ok(())
    }
}

impl Fit for Counter {
    type FitParams = CounterFitParams;

    fn fit(
        _base: Option<&Model>,
        params: &CounterParams,
        fit_params: &CounterFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        job.check_single(Self::SPEC.name)?;
        let dataset = samples(dataset)?;
        let val_dataset = val_dataset.map(samples).transpose()?;
        let checkpoint = job.output.join(CHECKPOINT);
        let mut losses = if job.resume { read_checkpoint(&checkpoint)? } else { Vec::new() };
        let steps = (fit_params.epochs * dataset.len()) as u64;
        job.progress.begin("training", Some(steps), Unit::Items);
        while losses.len() < fit_params.epochs {
            let Some(boxes) = mean_boxes(dataset, job)? else { break };
            losses.push(boxes * fit_params.lr);
            job.progress.status(&format!("loss {boxes:.2}"));
            fs::create_dir_all(job.output)?;
            fs::write(&checkpoint, format!("{losses:?}"))?;
        }
        job.progress.end();
        let mut statistics = Statistics::default();
        if let Some(val_dataset) = val_dataset
            && let Some(boxes) = mean_boxes(val_dataset, job)?
        {
            statistics.push("val_boxes", boxes);
        }
        statistics.set("epochs", losses.len() as f64);
        losses.into_iter().for_each(|loss| statistics.push("loss", loss));
        write_model(&job.model(), dataset.len() as u8, &params.to_map())?;
        Ok(statistics)
    }
}

fn samples(dataset: DatasetRef<'_>) -> Result<&dyn DatasetIterator> {
    match dataset {
        DatasetRef::Iterator(dataset) => Ok(dataset),
        DatasetRef::External(_) => Err(Error::invalid_input("a counter trains on a DatasetIterator only")),
    }
}

/// Returns the mean number of boxes per sample; `None` if the user stopped the training.
fn mean_boxes(dataset: &dyn DatasetIterator, job: &FitJob<'_>) -> Result<Option<f64>> {
    let mut boxes = 0;
    for index in 0..dataset.len() {
        if job.progress.stopped() {
            return Ok(None);
        }
        boxes += match dataset.target(index)? {
            Some(Value::BoundingBoxList(list)) => list.boxes.len(),
            _ => 0,
        };
        job.progress.advance(1);
    }
    Ok(Some(boxes as f64 / dataset.len().max(1) as f64))
}

fn read_checkpoint(path: &Path) -> Result<Vec<f64>> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let context = || format!("reading {}", path.display());
    let text = fs::read_to_string(path).context(context)?;
    serde_json::from_str(&text)
        .map_err(|error| Error::format("not a list of numbers").with_source(error))
        .context(context)
}

/// Writes a container of the learner to `folder`, with the initial count `bias` and parameters `params`.
///
/// # Errors
/// As [`ModelWriter`].
pub fn write_model(folder: &Path, bias: u8, params: &ParamMap) -> Result<()> {
    let manifest = Manifest { params: params.clone(), ..Manifest::new(Counter::SPEC.name, "") };
    let mut writer = ModelWriter::new(folder, manifest)?;
    writer.add(BIAS, &[bias])?;
    writer.finish().map(drop)
}
