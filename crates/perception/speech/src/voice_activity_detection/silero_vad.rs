//! Silero VAD: voice activity detection in chunks of 32 ms.
//!
//! Silero Team, Silero VAD, 2024; version 6.2, for 16 kHz. The prediction is a [`Category`], `silence` or `speech`, with the
//! network's probability of both. A whole recording is speech when speech starts anywhere in it, with the highest probability
//! of its chunks. A stream yields a prediction for every 512 samples, which are its clock: prediction `n` covers the samples
//! from `512 n` on; its class has the hysteresis of [`VoiceRule`]. Pieces of another sample rate are refused and leave the
//! stream unchanged. [`voice_activity`](crate::voice_activity) computes start and end of speech in samples.

use opendr_audio::AudioInput;
use opendr_engine::learner::{Learner, Spec, Streaming};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Result, Task};
use opendr_perception_common::category_scores::binary_category;

use crate::voice_activity::{SAMPLE_RATE, Speech, VoiceNetwork, VoiceRule, VoiceStream};

/// Parameters of [`SileroVad`].
#[derive(Debug, Clone, Params)]
pub struct SileroVadParams {
    /// Minimum probability at which speech starts; it ends 0.15 below.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Duration of silence that ends speech.
    #[param(default = 100, range = 0..=60_000, unit = "ms", live)]
    pub min_silence_duration_ms: u32,
}

/// A loaded network.
pub struct SileroVad {
    params: SileroVadParams,
    classes: Classes,
    network: VoiceNetwork,
}

/// State of a stream.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct SileroVadStream {
    sound: VoiceStream,
    speech: Speech,
}

/// File of the network in every container.
const FILE: &str = "model.onnx";

impl SileroVad {
    fn rule(&self) -> VoiceRule {
        VoiceRule::from_milliseconds(self.params.threshold, self.params.min_silence_duration_ms, 0)
    }

    fn category_of(&self, speech: &mut Speech, probability: f32) -> Category {
        self.rule().next(speech, probability);
        let mut category = Category::default();
        binary_category(&mut category, speech.is_active(), probability, &self.classes);
        category
    }
}

impl Learner for SileroVad {
    const SPEC: Spec = Spec::new("silero_vad", Task::VoiceActivityDetection)
        .class("SileroVadLearner")
        .about("Silero VAD detects speech in chunks of 32 ms.");
    type Params = SileroVadParams;
    type Input<'a> = AudioInput<'a>;
    type Target = Category;
    type State = SileroVadStream;

    fn load(model: &Model, params: SileroVadParams, device: Device) -> Result<Self> {
        let network = VoiceNetwork::open(&model.file(FILE)?, device)?;
        Ok(Self { params, network, classes: ["silence", "speech"].into_iter().collect() })
    }

    fn params(&self) -> &SileroVadParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut SileroVadParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(
        &self,
        _: &mut SileroVadStream,
        sound: AudioInput<'_>,
        category: &mut Category,
    ) -> Result<()> {
        let samples = sound.samples(SAMPLE_RATE)?;
        let (mut stream, mut highest) = (VoiceStream::default(), 0f32);
        self.network.push(&mut stream, &samples, |probability| {
            highest = highest.max(probability);
            Ok(())
        })?;
        highest = highest.max(self.network.flush(&mut stream)?.unwrap_or(0.0));
        binary_category(category, highest >= self.params.threshold, highest, &self.classes);
        Ok(())
    }
}

/// Yields a prediction for every 512 samples.
impl Streaming for SileroVad {
    fn push(
        &self,
        state: &mut SileroVadStream,
        piece: AudioInput<'_>,
        emit: &mut dyn FnMut(Category),
    ) -> Result<()> {
        let samples = piece.samples(SAMPLE_RATE)?;
        let SileroVadStream { sound, speech } = state;
        self.network.push(sound, &samples, |probability| {
            emit(self.category_of(speech, probability));
            Ok(())
        })
    }

    fn flush(&self, state: &mut SileroVadStream, emit: &mut dyn FnMut(Category)) -> Result<()> {
        if let Some(probability) = self.network.flush(&mut state.sound)? {
            emit(self.category_of(&mut state.speech, probability));
        }
        *state = SileroVadStream::default();
        Ok(())
    }
}
