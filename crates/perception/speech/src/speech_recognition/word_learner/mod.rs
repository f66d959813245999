//! Shared implementation of the keyword spotting learners that train: cepstra of audio to a score per word.
//!
//! The learners differ in their network ([`WordKind`]) and share front end, streams, training and container.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod objective;
#[cfg(feature = "training")]
mod trainable;

use opendr_audio::AudioInput;
use opendr_engine::learner::{Learner, Spec, Streaming};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;

use crate::speech_recognition::cepstra::{FRAMES, FrontEnd};
use crate::speech_recognition::word_stream::{SpeechWindows, WordStream, WordStreamParams};

#[cfg(feature = "training")]
pub use trainable::{TrainableWords, WordFitParams};

/// Parameters common to all keyword spotting learners.
#[derive(Debug, Clone, Params)]
pub struct WordParams {
    /// Number of classes. None: the number of classes in the data set (OpenDR's default is 20).
    #[param(range = 2..=10_000)]
    pub output_classes_n: Option<usize>,
    /// Whether cepstra are computed from the input. Unset, the input is a Timeseries of cepstra with the network's number of
    /// coefficients.
    #[param(default = true)]
    pub preprocess_to_mfcc: bool,
    /// Sample rate of the audio.
    #[param(default = 16000, range = 4000..=384_000, unit = "Hz")]
    pub sample_rate: u32,
    /// Options of streams.
    #[param(flatten)]
    pub stream: WordStreamParams,
}

/// Network kind of a keyword spotting learner.
pub trait WordKind: Send + Sync + 'static {
    /// Name, task and class.
    const SPEC: Spec;
    /// Number of cepstral coefficients per frame.
    const COEFFICIENTS: usize;
    /// Parameters of the learner.
    type Params: Params;

    /// Returns the parameters common to all keyword spotting learners.
    fn words(params: &Self::Params) -> &WordParams;
}

/// A loaded keyword spotting network.
///
/// A stream yields a prediction for every second of audio, each half a second after the one before.
pub struct WordLearner<K: WordKind> {
    params: K::Params,
    classes: Classes,
    front_end: FrontEnd,
    windows: SpeechWindows,
    session: Session,
    inputs: Pool<Vec<f32>>,
}

/// File of the network in every container: `cepstra` `[1, COEFFICIENTS, FRAMES]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

impl<K: WordKind> WordLearner<K> {
    fn category(&self, sound: AudioInput<'_>, category: &mut Category) -> Result<()> {
        let input = &mut *self.inputs.take();
        self.front_end.input_into(sound, input)?;
        let input = TensorView::new(&[1, K::COEFFICIENTS, FRAMES], &input[..])?;
        self.session.run(&[input], |outputs| {
            let logits = outputs.first().map_or(Ok(&[][..]), TensorView::values)?;
            category_from_logits(category, logits, &self.classes)
        })
    }
}

impl<K: WordKind> Learner for WordLearner<K> {
    const SPEC: Spec = K::SPEC;
    type Params = K::Params;
    type Input<'a> = AudioInput<'a>;
    type Target = Category;
    type State = WordStream;

    fn load(model: &Model, params: K::Params, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} does not have exactly one input and one output")));
        };
        let fits = matches!(input.dims[..], [_, Some(coefficients), Some(FRAMES)] if coefficients == K::COEFFICIENTS);
        let &[_, Some(classes)] = &output.dims[..] else {
            return Err(Error::format(format!("{FILE} returns {output}; expected scores [1, classes]")));
        };
        if !fits {
            return Err(Error::format(format!("{FILE} takes {input}; expected the cepstra of this learner")));
        }
        let words = K::words(&params);
        if let Some(requested) = words.output_classes_n.filter(|requested| *requested != classes) {
            return Err(Error::invalid_param(format!(
                "output_classes_n = {requested}, but the model has {classes} classes; omit output_classes_n or load another model"
            )));
        }
        Ok(Self {
            front_end: FrontEnd::new(words.preprocess_to_mfcc, words.sample_rate, K::COEFFICIENTS)?,
            windows: SpeechWindows::new(&words.stream, words.sample_rate, device)?,
            classes: model.manifest().classes.clone(),
            inputs: Pool::default(),
            params,
            session,
        })
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

    fn infer_into(&self, _: &mut WordStream, sound: AudioInput<'_>, category: &mut Category) -> Result<()> {
        self.category(sound, category)
    }
}

/// Yields a prediction for every second of audio, each half a second after the one before.
impl<K: WordKind> Streaming for WordLearner<K> {
    fn push(
        &self,
        state: &mut WordStream,
        piece: AudioInput<'_>,
        emit: &mut dyn FnMut(Category),
    ) -> Result<()> {
        let samples = piece.samples(K::words(&self.params).sample_rate)?;
        self.windows.push(state, &samples, |second| {
            let mut category = Category::default();
            self.category(AudioInput::Audio(second), &mut category)?;
            emit(category);
            Ok(())
        })
    }

    fn flush(&self, state: &mut WordStream, emit: &mut dyn FnMut(Category)) -> Result<()> {
        if let Some(rest) = self.windows.flush(state)? {
            let mut category = Category::default();
            self.category(AudioInput::Audio(&rest), &mut category)?;
            emit(category);
        }
        Ok(())
    }
}

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
