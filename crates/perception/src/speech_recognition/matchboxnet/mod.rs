//! MatchboxNet: convolutions that are separable in time and channel, over cepstra; small and quick.
//!
//! Majumdar and Ginsburg, MatchboxNet: 1D Time-Channel Separable Convolutional Neural Network Architecture for Speech
//! Commands Recognition, Interspeech 2020. Take it for a few dozen words, spoken one at a time. A stream
//! of sound is answered twice a second, each time for the second before.

mod front_end;
mod stream;

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;

#[cfg(feature = "training")]
pub use fit::MatchboxNetFitParams;
pub use stream::MatchboxNetStream;

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};

use crate::category_scores::category_from_logits;
use crate::speech_recognition::Sound;
use front_end::{COEFFICIENTS, FRAMES, FrontEnd};

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct MatchboxNetParams {
    /// Blocks with a way past them (B in the paper).
    #[param(default = 3, range = 1..=64)]
    pub number_of_blocks: usize,
    /// Convolutions in a block (R in the paper).
    #[param(default = 1, range = 1..=64)]
    pub number_of_subblocks: usize,
    /// Channels of the blocks (C in the paper).
    #[param(default = 64, range = 1..=4096)]
    pub number_of_channels: usize,
    /// Classes. None: as many as the data name (in OpenDR 20, whatever the data).
    #[param(range = 2..=10_000)]
    pub output_classes_n: Option<usize>,
    /// Whether cepstra are made of the input; unset, it is a Timeseries of cepstra already, 64 a frame.
    #[param(default = true)]
    pub preprocess_to_mfcc: bool,
    /// Samples a second of the sound.
    #[param(default = 16000, range = 4000..=384_000, unit = "Hz")]
    pub sample_rate: u32,
}

/// A loaded MatchboxNet.
pub struct MatchboxNet {
    params: MatchboxNetParams,
    classes: Classes,
    front_end: FrontEnd,
    session: Session,
    inputs: Pool<Vec<f32>>,
}

/// The network in every container: `cepstra` `[1, COEFFICIENTS, FRAMES]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

impl Learner for MatchboxNet {
    const SPEC: Spec = Spec::new("matchboxnet", Task::SpeechRecognition)
        .class("MatchboxNetLearner")
        .about("MatchboxNet tells which of a few words was spoken; small and quick.");
    type Params = MatchboxNetParams;
    type Input<'a> = Sound<'a>;
    type Target = Category;
    type State = MatchboxNetStream;

    fn load(model: &Model, params: MatchboxNetParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} has not one input and one output")));
        };
        let fits = matches!(input.dims[..], [_, Some(COEFFICIENTS), Some(FRAMES)]);
        let &[_, Some(classes)] = &output.dims[..] else {
            return Err(Error::format(format!("{FILE} gives {output}, which are no scores")));
        };
        if !fits {
            return Err(Error::format(format!("{FILE} takes {input}, which are no cepstra of this learner")));
        }
        if let Some(wanted) = params.output_classes_n.filter(|wanted| *wanted != classes) {
            return Err(Error::invalid_param(format!(
                "output_classes_n = {wanted}, but the model's is {classes}; leave it out, or load a model that fits"
            )));
        }
        Ok(Self {
            front_end: FrontEnd::new(params.preprocess_to_mfcc, params.sample_rate)?,
            classes: model.manifest().classes.clone(),
            inputs: Pool::default(),
            params,
            session,
        })
    }

    fn params(&self) -> &MatchboxNetParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut MatchboxNetParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut MatchboxNetStream, sound: Sound<'_>, category: &mut Category) -> Result<()> {
        let input = &mut *self.inputs.take();
        self.front_end.input_into(sound, input)?;
        let input = TensorView::new(&[1, COEFFICIENTS, FRAMES], &input[..])?;
        self.session.run(&[input], |outputs| {
            let logits = outputs.first().map_or(Ok(&[][..]), TensorView::values)?;
            category_from_logits(category, logits, &self.classes)
        })
    }
}

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
