//! A test-only learner with two ports, an init port, `State`, two outputs, pieces and training. It finds nothing; it
//! counts. Every surface is tested with it (feature `test-learner`).

use std::path::Path;

use crate::data::Image;
use crate::dataset::DatasetRef;
use crate::learner::{Fit, FitJob, Inputs, Learner, Spec, Streaming, Targets};
use crate::model::{Manifest, Model, ModelWriter};
use crate::params::{ParamMap, Params};
use crate::target::{BoundingBox, BoundingBoxList, PoseList};
use crate::{Device, Error, Result, Statistics, Task};

/// The only file of its container: one byte, where counting begins.
const BIAS: &str = "bias.bin";

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct CounterParams {
    /// Boxes below this score are dropped.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// What the count is multiplied with.
    #[param(default = 2, range = 1..=9)]
    pub factor: i64,
}

/// How it trains.
#[derive(Debug, Clone, Params)]
pub struct CounterFitParams {
    /// How often the data set is read.
    #[param(default = 1, range = 1..=100)]
    pub epochs: usize,
}

/// A picture and the boxes to count.
#[derive(Inputs)]
pub struct CounterInputs<'a> {
    /// A picture.
    pub image: &'a Image,
    /// What was found in it.
    pub detections: &'a BoundingBoxList,
    /// Where to begin.
    #[port(init)]
    pub first: Option<&'a BoundingBoxList>,
}

/// The count.
#[derive(Default, Targets)]
pub struct CounterTargets {
    /// One box whose left edge is the count.
    pub count: BoundingBoxList,
    /// Nothing.
    pub poses: PoseList,
}

/// What was counted so far.
#[derive(Default)]
pub struct CounterState {
    begin: f32,
    seen: usize,
}

/// Counts the boxes that it is given.
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
        state.seen += boxes.filter(|found| found.confidence >= self.params.threshold).count();
        let count = state.begin + self.bias + state.seen as f32 * self.params.factor as f32;
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
        if state.seen.is_multiple_of(2) {
            emit(target);
        }
        Ok(())
    }

    fn flush(&self, state: &mut CounterState, emit: &mut dyn FnMut(CounterTargets)) -> Result<()> {
        let mut target = CounterTargets::default();
        target.count.boxes.push(BoundingBox::new(0, state.seen as f32, 0.0, 0.0, 0.0, 0.0));
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
        _val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let DatasetRef::Iterator(dataset) = dataset else {
            return Err(Error::invalid_input("a counter trains on samples only"));
        };
        let mut statistics = Statistics::default();
        (0..fit_params.epochs).for_each(|_| statistics.push("loss", 0.0));
        write_model(&job.model(), dataset.len() as u8, &params.to_map())?;
        Ok(statistics)
    }
}

/// Writes a container of the learner to `folder`: counting begins at `bias`, `params` replace defaults.
///
/// # Errors
/// As [`ModelWriter`].
pub fn write_model(folder: &Path, bias: u8, params: &ParamMap) -> Result<()> {
    let manifest = Manifest { params: params.clone(), ..Manifest::new(Counter::SPEC.name, "") };
    let mut writer = ModelWriter::new(folder, manifest)?;
    writer.add(BIAS, &[bias])?;
    writer.finish().map(drop)
}
