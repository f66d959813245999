//! Emotion recognition from voice and face.
//!
//! Chumachenko, Iosifidis and Gabbouj, Self-attention Fusion for Audiovisual Emotion Recognition with Incomplete Data, ICPR
//! 2022: a branch of temporal convolutions for the cepstra of a voice, one for the frames of a face, and attention between
//! both. Different from the paper, the features of frames come from a small network that is trained jointly, not from
//! EfficientFace. The inputs are the audio and the cropped faces of a video of the same time; without a video, or in silence,
//! the other modality decides.

#[cfg(feature = "training")]
mod cross_attention;
#[cfg(feature = "training")]
mod fit;
mod front_end;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
mod params;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

#[cfg(feature = "training")]
pub use fit::AudiovisualEmotionFitParams;
use opendr_engine::data::{Audio, Video};
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;

use self::front_end::{FrontEnd, Sizes};
pub use self::params::{AudiovisualEmotionParams, AudiovisualFusion};

opendr_engine::choices! {
    /// Dropout of modalities in training.
    pub enum ModalityDrop {
        /// Each batch is also trained without its audio, and without its video.
        Zero = "zerodrop",
        /// No dropout.
        None = "nodrop",
    }
}

/// Audio and video of a speaking person.
#[derive(Inputs)]
pub struct AudiovisualInputs<'a> {
    /// The voice, at the learner's sample rate.
    pub audio: &'a Audio,
    /// The cropped face, `[3, frames, height, width]`.
    pub video: Option<&'a Video>,
}

/// A loaded network.
pub struct AudiovisualEmotion {
    params: AudiovisualEmotionParams,
    classes: Classes,
    session: Session,
    front_end: FrontEnd,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    audio: Vec<f32>,
    video: Vec<f32>,
}

/// File of the network in every container: `audio` `[1, coefficients, time steps]` and `video` `[frames, 3, side, side]` to
/// `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

impl Learner for AudiovisualEmotion {
    const SPEC: Spec = Spec::new("audiovisual_emotion", Task::MultimodalHumanCentric)
        .class("AudiovisualEmotionLearner")
        .about("Recognises the emotion of a person from voice and face; trainable.")
        .without_effect(&[
            ("pretr_ef", "the network for frames is trained jointly"),
            ("dampening", Spec::TRAINING_ONLY),
            ("n_workers", Spec::TRAINING_ONLY),
        ]);
    type Params = AudiovisualEmotionParams;
    type Input<'a> = AudiovisualInputs<'a>;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: AudiovisualEmotionParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([audio, video], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} does not have two inputs and one output")));
        };
        let wrong = || Error::format(format!("{FILE} takes {audio} and {video}; expected audio and faces"));
        let [_, _, _, Some(side)] = video.dims[..] else { return Err(wrong()) };
        let sizes = Sizes::new(&params, side);
        if audio.dims != [1, Sizes::COEFFICIENTS, sizes.instants].map(Some)
            || video.dims != [sizes.frames, 3, side, side].map(Some)
        {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {audio} and {video}, but seq_length, sample_rate and seconds specify {} time steps and {} frames; \
                 omit these parameters",
                sizes.instants, sizes.frames
            )));
        }
        if let (Some(wanted), Some(there)) = (params.num_class, output.dims.last().copied().flatten())
            && wanted != there
        {
            return Err(Error::invalid_param(format!(
                "num_class = {wanted}, but the model has {there} classes; omit num_class or load another model"
            )));
        }
        let (classes, front_end) = (model.classes().clone(), FrontEnd::new(&sizes)?);
        Ok(Self { params, classes, session, front_end, scratch: Pool::default() })
    }

    fn params(&self) -> &AudiovisualEmotionParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut AudiovisualEmotionParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), inputs: AudiovisualInputs<'_>, category: &mut Category) -> Result<()> {
        let Scratch { audio, video } = &mut *self.scratch.take();
        self.front_end.audio_into(inputs.audio, audio)?;
        self.front_end.video_into(inputs.video, video)?;
        let Sizes { frames, side, instants, .. } = self.front_end.sizes;
        let tensors = [
            TensorView::new(&[1, Sizes::COEFFICIENTS, instants], &audio[..])?,
            TensorView::new(&[frames, 3, side, side], &video[..])?,
        ];
        self.session.run(&tensors, |outputs| {
            let logits = outputs.first().map_or(Ok(&[][..]), TensorView::values)?;
            category_from_logits(category, logits, &self.classes)
        })
    }
}
