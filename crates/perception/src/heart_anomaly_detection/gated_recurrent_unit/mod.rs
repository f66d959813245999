//! Convolutions that shorten a heart signal, a gated recurrent unit over what they leave, a classifier of its last state.
//!
//! After Cho et al., Learning Phrase Representations using RNN Encoder-Decoder for Statistical Machine Translation, 2014,
//! and OpenDR's learner of this name, whose fifteen residual blocks before the unit are here as many plain convolutions as
//! it takes to leave at most 64 steps: a thirtieth of the arithmetic for a heart beat, and the unit
//! learns in minutes on a processor. Take it for single beats or short recordings of any number of leads.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;

#[cfg(feature = "training")]
pub use fit::GatedRecurrentUnitFitParams;

use opendr_engine::data::Timeseries;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result, Task};
use opendr_inference::{Session, TensorView};

use crate::category_scores::category_from_logits;

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own, and one that is
/// given and differs is refused.
#[derive(Debug, Clone, Params)]
pub struct GatedRecurrentUnitParams {
    /// Features of a series (leads of a recording). None: as the data have.
    #[param(range = 1..=1024)]
    pub in_channels: Option<usize>,
    /// Instants of a series. None: as the data have.
    #[param(range = 1..=1_000_000)]
    pub series_length: Option<usize>,
    /// Classes. None: as many as the data name.
    #[param(range = 2..=10_000)]
    pub n_class: Option<usize>,
    /// Features of the recurrent unit's state.
    #[param(default = 512, range = 1..=4096)]
    pub recurrent_unit: usize,
    /// Share of the state's features that are left out at random in each training step.
    #[param(default = 0.2, range = 0.0..=0.99)]
    pub dropout: f64,
}

/// A loaded network.
pub struct GatedRecurrentUnit {
    params: GatedRecurrentUnitParams,
    classes: Classes,
    session: Session,
    time: usize,
    features: usize,
}

/// The network in every container: `series` `[1, time, features]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

impl Learner for GatedRecurrentUnit {
    const SPEC: Spec = Spec::new("gated_recurrent_unit", Task::HeartAnomalyDetection)
        .class("GatedRecurrentUnitLearner")
        .about("A gated recurrent unit tells abnormal heart beats from normal ones.")
        .without_effect(&[("test_mode", "it made OpenDR's own tests short")]);
    type Params = GatedRecurrentUnitParams;
    type Input<'a> = &'a Timeseries;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: GatedRecurrentUnitParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} has not one input and one output")));
        };
        let (&[_, Some(time), Some(features)], &[_, Some(classes)]) = (&input.dims[..], &output.dims[..])
        else {
            return Err(Error::format(format!(
                "{FILE} turns {input} into {output}, which are no series of fixed length and its scores"
            )));
        };
        must_be("in_channels", params.in_channels, features)?;
        must_be("series_length", params.series_length, time)?;
        must_be("n_class", params.n_class, classes)?;
        Ok(Self { classes: model.manifest().classes.clone(), params, session, time, features })
    }

    fn params(&self) -> &GatedRecurrentUnitParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut GatedRecurrentUnitParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), series: &Timeseries, category: &mut Category) -> Result<()> {
        check_series(series, [self.time, self.features])?;
        let input = TensorView::new(&[1, self.time, self.features], series.as_slice())?;
        self.session.run(&[input], |outputs| {
            let logits = outputs.first().map_or(Ok(&[][..]), TensorView::values)?;
            category_from_logits(category, logits, &self.classes)
        })
    }
}

/// Refuses a size that the user gave and the model does not have.
fn must_be(name: &str, wanted: Option<usize>, there: usize) -> Result<()> {
    match wanted {
        Some(wanted) if wanted != there => Err(Error::invalid_param(format!(
            "{name} = {wanted}, but the model's is {there}; leave it out, or load a model that fits"
        ))),
        _ => Ok(()),
    }
}

/// Refuses a series of another shape than `[time, features]`, or with missing measurements.
fn check_series(series: &Timeseries, shape: [usize; 2]) -> Result<()> {
    if series.shape() != shape {
        let ([time, features], [wanted_time, wanted_features]) = (series.shape(), shape);
        return Err(Error::invalid_input(format!(
            "a series of {time} instants with {features} features; the network takes {wanted_time} with \
             {wanted_features}: cut, resample or transpose it"
        )));
    }
    match series.as_slice().iter().position(|number| !number.is_finite()) {
        Some(at) => Err(Error::invalid_input(format!(
            "measurement {} of the series is {}; fill in what is missing",
            at,
            series.as_slice()[at]
        ))),
        None => Ok(()),
    }
}

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
