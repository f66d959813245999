//! DS-CNN: depthwise separable convolutions over ten cepstra per frame; 12 words in 52 kB.
//!
//! Zhang, Suda, Lai and Chandra, Hello Edge: Keyword Spotting on Microcontrollers, 2017; the INT8 network of MLPerf Tiny. Audio
//! is normalised by its peak; longer than a second it is cut, shorter it is padded with silence. A stream yields a prediction
//! twice per second, each for the last second.

use opendr_audio::AudioInput;
use opendr_audio::mfcc::{Mfcc, MfccOptions, peak_factor};
use opendr_engine::learner::{Learner, Spec, Streaming};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{ElementType, Session, TensorView};
use opendr_perception_common::category_scores::category_from_probabilities;

use crate::speech_recognition::word_stream::{SpeechWindows, WordStream, WordStreamParams};

/// Parameters of [`DsCnn`].
#[derive(Debug, Clone, Params)]
pub struct DsCnnParams {
    /// Options of streams.
    #[param(flatten)]
    pub stream: WordStreamParams,
}

/// A loaded DS-CNN.
pub struct DsCnn {
    params: DsCnnParams,
    classes: Classes,
    mfcc: Mfcc,
    windows: SpeechWindows,
    session: Session,
    work: Pool<Work>,
}

#[derive(Default)]
struct Work {
    /// Audio of less than a second, padded to a second.
    second: Vec<f32>,
    cepstra: Vec<f32>,
}

/// File of the network in every container: cepstra `[1, 1, 49, 10]` to class probabilities, in INT8 internally.
const FILE: &str = "model.onnx";
/// Sample rate of the network, and length of its input in samples.
const SAMPLE_RATE: u32 = 16_000;
/// Frames per second of audio, and coefficients per frame.
const FRAMES: usize = 49;
const COEFFICIENTS: usize = 10;

impl DsCnn {
    fn category(&self, samples: &[f32], category: &mut Category) -> Result<()> {
        let Work { second, cepstra } = &mut *self.work.take();
        let samples = match samples.get(..SAMPLE_RATE as usize) {
            Some(whole) => whole,
            None => {
                second.clear();
                second.extend(samples);
                second.resize(SAMPLE_RATE as usize, 0.0);
                &second[..]
            }
        };
        self.mfcc.run_scaled_into(samples, peak_factor(samples), cepstra);
        let input = TensorView::new(&[1, 1, FRAMES, COEFFICIENTS], &cepstra[..])?;
        self.session.run(&[input], |outputs| {
            let probabilities = outputs.first().map_or(Ok(&[][..]), TensorView::values::<f32>)?;
            category_from_probabilities(category, probabilities.iter().copied(), &self.classes)
        })
    }
}

impl Learner for DsCnn {
    const SPEC: Spec = Spec::new("ds_cnn", Task::SpeechRecognition)
        .class("DsCnnLearner")
        .about("DS-CNN classifies twelve spoken words, in 52 kB and INT8.");
    type Params = DsCnnParams;
    type Input<'a> = AudioInput<'a>;
    type Target = Category;
    type State = WordStream;

    fn load(model: &Model, params: DsCnnParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} does not have exactly one input and one output")));
        };
        let floats = [input, output].iter().all(|tensor| tensor.element_type == ElementType::F32);
        if !floats || !matches!(input.dims[..], [_, Some(1), Some(FRAMES), Some(COEFFICIENTS)]) {
            return Err(Error::format(format!(
                "{FILE} maps {input} to {output}; expected 49 frames of 10 cepstra as input and class probabilities as output"
            )));
        }
        Ok(Self {
            mfcc: Mfcc::new(MfccOptions::keywords())?,
            windows: SpeechWindows::new(&params.stream, SAMPLE_RATE, device)?,
            classes: model.manifest().classes.clone(),
            work: Pool::default(),
            params,
            session,
        })
    }

    fn params(&self) -> &DsCnnParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut DsCnnParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut WordStream, sound: AudioInput<'_>, category: &mut Category) -> Result<()> {
        self.category(&sound.samples(SAMPLE_RATE)?, category)
    }
}

/// Yields a prediction for every second of audio, each half a second after the one before.
impl Streaming for DsCnn {
    fn push(
        &self,
        state: &mut WordStream,
        piece: AudioInput<'_>,
        emit: &mut dyn FnMut(Category),
    ) -> Result<()> {
        self.windows.push(state, &piece.samples(SAMPLE_RATE)?, |second| {
            let mut category = Category::default();
            self.category(second.as_slice(), &mut category)?;
            emit(category);
            Ok(())
        })
    }

    fn flush(&self, state: &mut WordStream, emit: &mut dyn FnMut(Category)) -> Result<()> {
        if let Some(rest) = self.windows.flush(state)? {
            let mut category = Category::default();
            self.category(rest.as_slice(), &mut category)?;
            emit(category);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
