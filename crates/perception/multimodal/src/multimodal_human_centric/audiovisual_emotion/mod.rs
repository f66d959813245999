//! Emotions by voice and face.
//!
//! Chumachenko, Iosifidis and Gabbouj, Self-attention Fusion for Audiovisual Emotion Recognition with Incomplete Data, ICPR 2022:
//! a branch of convolutions through time for the cepstra of a voice, one for the frames of a face, and attention between
//! both. Different from the paper, frames are looked at by a small network that is trained along, not by EfficientFace.
//! It takes the sound and the faces cut out of a video of the same time; where there is no video, or silence, the other sense
//! decides.

#[cfg(feature = "training")]
mod cross_attention;
#[cfg(feature = "training")]
mod fit;
mod front_end;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

#[cfg(feature = "training")]
pub use fit::AudiovisualEmotionFitParams;
use opendr_engine::data::{Audio, Video};
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;

use self::front_end::{FrontEnd, Sizes};

opendr_engine::choices! {
    /// How the two branches learn of each other.
    pub enum AudiovisualFusion {
        /// Between their halves: attention says which instants of the other count.
        IntermediateAttention = "ia",
        /// Between their halves: what is attended of the other is added.
        IntermediateTransformer = "it",
        /// At their ends: each goes on with what it attends of the other.
        LateTransformer = "lt",
    }
}

opendr_engine::choices! {
    /// What training does so that one sense alone is enough.
    pub enum ModalityDrop {
        /// Each batch is also learnt without its sound, and without its faces.
        Zero = "zerodrop",
        /// Nothing.
        None = "nodrop",
    }
}

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct AudiovisualEmotionParams {
    /// Classes. None: as many as the data name.
    #[param(range = 2..=10_000)]
    pub num_class: Option<usize>,
    /// Frames of the faces, evenly spaced over the video.
    #[param(default = 15, range = 2..=256)]
    pub seq_length: usize,
    /// How the branches learn of each other.
    pub fusion: AudiovisualFusion,
    /// Samples of the sound a second.
    #[param(default = 22_050, range = 8000..=48_000, unit = "Hz")]
    pub sample_rate: u32,
    /// Sound that is looked at, from its begin; what is shorter is filled up.
    #[param(default = 3.6, range = 0.2..=60.0, unit = "s")]
    pub seconds: f64,
}

/// What somebody says and what the face does meanwhile.
#[derive(Inputs)]
pub struct AudiovisualInputs<'a> {
    /// The voice, at the learner's sample rate.
    pub audio: &'a Audio,
    /// The face, cut out, `[3, frames, height, width]`.
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

/// The network in every container: `audio` `[1, coefficients, instants]` and `video` `[frames, 3, side, side]` to `logits`
/// `[1, classes]`.
const FILE: &str = "model.onnx";

impl Learner for AudiovisualEmotion {
    const SPEC: Spec = Spec::new("audiovisual_emotion", Task::MultimodalHumanCentric)
        .class("AudiovisualEmotionLearner")
        .about("Tells an emotion by the voice and the face; it trains.")
        .without_effect(&[
            ("pretr_ef", "frames are looked at by a network that is trained along"),
            ("dampening", Spec::OF_TRAINING),
            ("n_workers", Spec::OF_TRAINING),
        ]);
    type Params = AudiovisualEmotionParams;
    type Input<'a> = AudiovisualInputs<'a>;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: AudiovisualEmotionParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([audio, video], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} has not two inputs and one output")));
        };
        let wrong =
            || Error::format(format!("{FILE} takes {audio} and {video}, which are no sound and faces"));
        let [_, _, _, Some(side)] = video.dims[..] else { return Err(wrong()) };
        let sizes = Sizes::new(&params, side);
        if audio.dims != [1, Sizes::COEFFICIENTS, sizes.instants].map(Some)
            || video.dims != [sizes.frames, 3, side, side].map(Some)
        {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {audio} and {video}; seq_length, sample_rate and seconds make {} instants and {} frames: \
                 leave them out",
                sizes.instants, sizes.frames
            )));
        }
        if let (Some(wanted), Some(there)) = (params.num_class, output.dims.last().copied().flatten())
            && wanted != there
        {
            return Err(Error::invalid_param(format!(
                "num_class = {wanted}, but the model's is {there}; leave it out, or load a model that fits"
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
