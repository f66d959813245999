//! What the learners of words have in common that are trained here: cepstra of a sound in, the score of each word out.
//!
//! They differ in their network ([`WordKind`]); front end, streams, training and container are one.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod objective;

use opendr_engine::learner::{Learner, Spec, Streaming};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;
use opendr_sound::Sound;

use crate::speech_recognition::cepstra::{FRAMES, FrontEnd};
use crate::speech_recognition::word_stream::{Listening, WordStream, WordStreamParams};

#[cfg(feature = "training")]
pub use fit::{TrainableWords, WordFitParams};

/// What a user may set of every learner of words.
#[derive(Debug, Clone, Params)]
pub struct WordParams {
    /// Classes. None: as many as the data name (in OpenDR 20, whatever the data).
    #[param(range = 2..=10_000)]
    pub output_classes_n: Option<usize>,
    /// Whether cepstra are made of the input; unset, it is a Timeseries of cepstra already, as many a frame as the network
    /// takes.
    #[param(default = true)]
    pub preprocess_to_mfcc: bool,
    /// Samples a second of the sound.
    #[param(default = 16000, range = 4000..=384_000, unit = "Hz")]
    pub sample_rate: u32,
    /// How a stream is listened to.
    #[param(flatten)]
    pub stream: WordStreamParams,
}

/// One of the networks that tell words apart.
pub trait WordKind: Send + Sync + 'static {
    /// Name, task, class.
    const SPEC: Spec;
    /// Coefficients of a frame of its cepstra.
    const COEFFICIENTS: usize;
    /// What a user may set.
    type Params: Params;

    /// Those parameters that all have.
    fn words(params: &Self::Params) -> &WordParams;
}

/// A loaded network that tells which of its words was spoken.
///
/// A stream is answered for every second of sound, each half a second after the one before.
pub struct WordLearner<K: WordKind> {
    params: K::Params,
    classes: Classes,
    front_end: FrontEnd,
    listening: Listening,
    session: Session,
    inputs: Pool<Vec<f32>>,
}

/// The network in every container: `cepstra` `[1, COEFFICIENTS, FRAMES]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

impl<K: WordKind> WordLearner<K> {
    fn category(&self, sound: Sound<'_>, category: &mut Category) -> Result<()> {
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
    type Input<'a> = Sound<'a>;
    type Target = Category;
    type State = WordStream;

    fn load(model: &Model, params: K::Params, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} has not one input and one output")));
        };
        let fits = matches!(input.dims[..], [_, Some(coefficients), Some(FRAMES)] if coefficients == K::COEFFICIENTS);
        let &[_, Some(classes)] = &output.dims[..] else {
            return Err(Error::format(format!("{FILE} gives {output}, which are no scores")));
        };
        if !fits {
            return Err(Error::format(format!("{FILE} takes {input}, which are no cepstra of this learner")));
        }
        let words = K::words(&params);
        if let Some(wanted) = words.output_classes_n.filter(|wanted| *wanted != classes) {
            return Err(Error::invalid_param(format!(
                "output_classes_n = {wanted}, but the model's is {classes}; leave it out, or load a model that fits"
            )));
        }
        Ok(Self {
            front_end: FrontEnd::new(words.preprocess_to_mfcc, words.sample_rate, K::COEFFICIENTS)?,
            listening: Listening::new(&words.stream, words.sample_rate, device)?,
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

    fn infer_into(&self, _: &mut WordStream, sound: Sound<'_>, category: &mut Category) -> Result<()> {
        self.category(sound, category)
    }
}

/// An answer for every second of sound, each half a second after the one before.
impl<K: WordKind> Streaming for WordLearner<K> {
    fn push(&self, state: &mut WordStream, piece: Sound<'_>, emit: &mut dyn FnMut(Category)) -> Result<()> {
        let samples = piece.samples(K::words(&self.params).sample_rate)?;
        self.listening.push(state, &samples, |second| {
            let mut category = Category::default();
            self.category(Sound::Audio(second), &mut category)?;
            emit(category);
            Ok(())
        })
    }

    fn flush(&self, state: &mut WordStream, emit: &mut dyn FnMut(Category)) -> Result<()> {
        if let Some(rest) = self.listening.flush(state)? {
            let mut category = Category::default();
            self.category(Sound::Audio(&rest), &mut category)?;
            emit(category);
        }
        Ok(())
    }
}

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
