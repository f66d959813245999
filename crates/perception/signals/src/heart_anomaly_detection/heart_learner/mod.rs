//! Shared implementation of the learners of heart signals: a series to a score per class.
//!
//! The learners differ in their network ([`HeartKind`]) and share input, streams of beats, training and container.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod objective;
#[cfg(feature = "training")]
mod trainable;

use opendr_engine::data::Timeseries;
use opendr_engine::learner::{Learner, Spec, Streaming};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;

use crate::heart_anomaly_detection::beat_stream::{BeatStream, Beats};
use crate::model_checks::{check_finite, check_size};

#[cfg(feature = "training")]
pub use trainable::{HeartSizes, TrainableHeart};

/// Parameters common to all learners of heart signals.
#[derive(Debug, Clone, Params)]
pub struct HeartParams {
    /// Number of features of a series (leads of a recording). None: that of the data set.
    #[param(range = 1..=1024)]
    pub in_channels: Option<usize>,
    /// Number of time steps of a series. None: that of the data set.
    #[param(range = 1..=1_000_000)]
    pub series_length: Option<usize>,
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=10_000)]
    pub n_class: Option<usize>,
    /// Dropout probability.
    #[param(default = 0.2, range = 0.0..=0.99)]
    pub dropout: f64,
    /// Sample rate of a stream, in which beats are detected. None: each piece of a stream is a whole series.
    #[param(range = 50.0..=10_000.0, unit = "Hz")]
    pub sample_rate: Option<f64>,
}

/// Network kind of a learner of heart signals.
pub trait HeartKind: Send + Sync + 'static {
    /// Name, task and class.
    const SPEC: Spec;
    /// Parameters of the learner.
    type Params: Params;

    /// Returns the parameters common to all learners of heart signals.
    fn heart(params: &Self::Params) -> &HeartParams;
}

/// A loaded network that classifies heart signals.
///
/// A stream with a sample rate yields a prediction for every heart beat ([`BeatStream`]); without one, for each of its pieces.
pub struct HeartLearner<K: HeartKind> {
    params: K::Params,
    classes: Classes,
    beats: Option<Beats>,
    session: Session,
    time: usize,
    features: usize,
}

/// File of the network in every container: `series` `[1, time, features]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

/// Arguments of OpenDR's learners without effect.
pub(super) const TEST_MODE: &[(&str, &str)] = &[("test_mode", "OpenDR used it to shorten its own tests")];

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
            return Err(Error::format(format!("{FILE} does not have exactly one input and one output")));
        };
        let (&[_, Some(time), Some(features)], &[_, Some(classes)]) = (&input.dims[..], &output.dims[..])
        else {
            return Err(Error::format(format!(
                "{FILE} maps {input} to {output}; expected a series of fixed length as input and scores as output"
            )));
        };
        let heart = K::heart(&params);
        check_size("in_channels", heart.in_channels, features)?;
        check_size("series_length", heart.series_length, time)?;
        check_size("n_class", heart.n_class, classes)?;
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

/// Yields a prediction for every beat that is detected in the first feature, or for every piece.
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
                "a piece has {time} time steps with {features} features; the network takes {}",
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

/// Checks that a series has the shape `[time, features]` and no missing measurements.
fn check_series(series: &Timeseries, shape: [usize; 2]) -> Result<()> {
    if series.shape() != shape {
        let ([time, features], [wanted_time, wanted_features]) = (series.shape(), shape);
        return Err(Error::invalid_input(format!(
            "the series has {time} time steps with {features} features, but the network takes {wanted_time} with \
             {wanted_features}; cut, resample or transpose it"
        )));
    }
    check_finite(series)
}

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
