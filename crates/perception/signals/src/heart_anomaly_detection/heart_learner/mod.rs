//! What the learners of heart signals have in common: a series in, the score of each class out.
//!
//! They differ in their network ([`HeartKind`]); input, streams of beats, training and container are one.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod objective;

use opendr_engine::data::Timeseries;
use opendr_engine::learner::{Learner, Spec, Streaming};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;

use crate::heart_anomaly_detection::beat_stream::{BeatStream, Beats};

#[cfg(feature = "training")]
pub use fit::{HeartSizes, TrainableHeart};

/// What a user may set of every learner of heart signals.
#[derive(Debug, Clone, Params)]
pub struct HeartParams {
    /// Features of a series (leads of a recording). None: as the data have.
    #[param(range = 1..=1024)]
    pub in_channels: Option<usize>,
    /// Instants of a series. None: as the data have.
    #[param(range = 1..=1_000_000)]
    pub series_length: Option<usize>,
    /// Classes. None: as many as the data name.
    #[param(range = 2..=10_000)]
    pub n_class: Option<usize>,
    /// Share of features that are left out at random in each training step.
    #[param(default = 0.2, range = 0.0..=0.99)]
    pub dropout: f64,
    /// Instants a second of a stream, in which beats are found. None: each piece of a stream is a whole series.
    #[param(range = 50.0..=10_000.0, unit = "Hz")]
    pub sample_rate: Option<f64>,
}

/// One of the networks that tell heart signals apart.
pub trait HeartKind: Send + Sync + 'static {
    /// Name, task, class.
    const SPEC: Spec;
    /// What a user may set.
    type Params: Params;

    /// Those parameters that all have.
    fn heart(params: &Self::Params) -> &HeartParams;
}

/// A loaded network that tells the class of a heart signal.
///
/// A stream with a sample rate is answered for every heart beat in it ([`BeatStream`]); without one, each of its pieces is.
pub struct HeartLearner<K: HeartKind> {
    params: K::Params,
    classes: Classes,
    beats: Option<Beats>,
    session: Session,
    time: usize,
    features: usize,
}

/// The network in every container: `series` `[1, time, features]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

/// An argument of OpenDR's learners.
pub(super) const TEST_MODE: &[(&str, &str)] = &[("test_mode", "it made OpenDR's own tests short")];

impl<K: HeartKind> HeartLearner<K> {
    fn category(&self, series: &[f32], category: &mut Category) -> Result<()> {
        let input = TensorView::new(&[1, self.time, self.features], series)?;
        self.session.run(&[input], |outputs| {
            let logits = outputs.first().map_or(Ok(&[][..]), TensorView::values)?;
            category_from_logits(category, logits, &self.classes)
        })
    }
}

impl<K: HeartKind> Learner for HeartLearner<K> {
    const SPEC: Spec = K::SPEC;
    type Params = K::Params;
    type Input<'a> = &'a Timeseries;
    type Target = Category;
    type State = BeatStream;

    fn load(model: &Model, params: K::Params, device: Device) -> Result<Self> {
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
        let heart = K::heart(&params);
        must_be("in_channels", heart.in_channels, features)?;
        must_be("series_length", heart.series_length, time)?;
        must_be("n_class", heart.n_class, classes)?;
        let beats = heart.sample_rate.map(|rate| Beats::new(rate, [time, features])).transpose()?;
        Ok(Self { classes: model.manifest().classes.clone(), params, beats, session, time, features })
    }

    fn params(&self) -> &K::Params {
        &self.params
    }

    fn params_mut(&mut self) -> &mut K::Params {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut BeatStream, series: &Timeseries, category: &mut Category) -> Result<()> {
        check_series(series, [self.time, self.features])?;
        self.category(series.as_slice(), category)
    }
}

/// An answer for every beat that is found in the first feature, or for every piece.
impl<K: HeartKind> Streaming for HeartLearner<K> {
    fn push(&self, state: &mut BeatStream, piece: &Timeseries, emit: &mut dyn FnMut(Category)) -> Result<()> {
        let Some(beats) = &self.beats else {
            let mut category = Category::default();
            self.infer_into(state, piece, &mut category)?;
            emit(category);
            return Ok(());
        };
        let [time, features] = piece.shape();
        if features != self.features {
            return Err(Error::invalid_input(format!(
                "a piece of {time} instants with {features} features; the network takes {}",
                self.features
            )));
        }
        beats.push(state, piece.as_slice(), |beat| {
            let mut category = Category::default();
            self.category(beat, &mut category)?;
            emit(category);
            Ok(())
        })
    }

    fn flush(&self, state: &mut BeatStream, emit: &mut dyn FnMut(Category)) -> Result<()> {
        let Some(beats) = &self.beats else { return Ok(()) };
        beats.flush(state, |beat| {
            let mut category = Category::default();
            self.category(beat, &mut category)?;
            emit(category);
            Ok(())
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
