//! Silero VAD: whether somebody speaks, 32 ms at a time.
//!
//! Silero Team, Silero VAD, 2024; version 6.2, for 16 kHz. The answer is a [`Category`], `silence` or `speech`, with the
//! network's probability of both. A whole sound is speech when speech begins anywhere in it, with the highest probability of
//! its chunks. A stream is answered for every 512 samples, which give its clock: answer `n` is for the samples
//! from `512 n` on; its class has the hysteresis of [`VoiceRule`]. Pieces of another sample rate are refused and
//! leave the stream as it was. Where speech begins and ends, in samples,
//! [`voice_activity`](crate::voice_activity) tells.

use opendr_engine::learner::{Learner, Spec, Streaming};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Result, Task};
use opendr_perception_common::category_scores::category_of_two;
use opendr_sound::Sound;

use crate::voice_activity::{SAMPLE_RATE, Speech, VoiceNetwork, VoiceRule, VoiceStream};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct SileroVadParams {
    /// The least probability that speech begins with; it is quiet again 0.15 below.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// How long it must be quiet until speech is over.
    #[param(default = 100, range = 0..=60_000, unit = "ms", live)]
    pub min_silence_duration_ms: u32,
}

/// A loaded network.
pub struct SileroVad {
    params: SileroVadParams,
    classes: Classes,
    network: VoiceNetwork,
}

/// What a stream remembers.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct SileroVadStream {
    sound: VoiceStream,
    speech: Speech,
}

/// The network in every container.
const FILE: &str = "model.onnx";

impl SileroVad {
    fn rule(&self) -> VoiceRule {
        VoiceRule::from_milliseconds(self.params.threshold, self.params.min_silence_duration_ms, 0)
    }

    fn answer(&self, speech: &mut Speech, probability: f32) -> Category {
        self.rule().next(speech, probability);
        let mut category = Category::default();
        category_of_two(&mut category, speech.is_active(), probability, &self.classes);
        category
    }
}

impl Learner for SileroVad {
    const SPEC: Spec = Spec::new("silero_vad", Task::VoiceActivityDetection)
        .class("SileroVadLearner")
        .about("Silero VAD tells whether somebody speaks, 32 ms at a time.");
    type Params = SileroVadParams;
    type Input<'a> = Sound<'a>;
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

    fn infer_into(&self, _: &mut SileroVadStream, sound: Sound<'_>, category: &mut Category) -> Result<()> {
        let samples = sound.samples(SAMPLE_RATE)?;
        let (mut stream, mut highest) = (VoiceStream::default(), 0f32);
        self.network.push(&mut stream, &samples, |probability| {
            highest = highest.max(probability);
            Ok(())
        })?;
        highest = highest.max(self.network.flush(&mut stream)?.unwrap_or(0.0));
        category_of_two(category, highest >= self.params.threshold, highest, &self.classes);
        Ok(())
    }
}

/// An answer for every 512 samples.
impl Streaming for SileroVad {
    fn push(
        &self,
        state: &mut SileroVadStream,
        piece: Sound<'_>,
        emit: &mut dyn FnMut(Category),
    ) -> Result<()> {
        let samples = piece.samples(SAMPLE_RATE)?;
        let SileroVadStream { sound, speech } = state;
        self.network.push(sound, &samples, |probability| {
            emit(self.answer(speech, probability));
            Ok(())
        })
    }

    fn flush(&self, state: &mut SileroVadStream, emit: &mut dyn FnMut(Category)) -> Result<()> {
        if let Some(probability) = self.network.flush(&mut state.sound)? {
            emit(self.answer(&mut state.speech, probability));
        }
        *state = SileroVadStream::default();
        Ok(())
    }
}
