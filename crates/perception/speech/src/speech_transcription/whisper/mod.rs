//! Whisper: speech transcription with an encoder and a decoder.
//!
//! Radford et al., Robust Speech Recognition via Large-Scale Weak Supervision, 2022; the decoding rules are those of
//! openai/whisper. Windows of 30 s follow each other by the timestamps that the decoder predicts. A stream is transcribed
//! phrase by phrase.

mod beam;
mod decode;
mod decoding;
mod model;
mod network;
mod phrases;
mod rules;
mod segments;
mod spectrogram;
mod stream;
mod tokenizer;
mod transcribe;
mod vocabulary;
mod words;

#[cfg(test)]
mod tests;

pub use model::{Whisper, WhisperParams};
pub use stream::WhisperStream;

use opendr_audio::AudioInput;
use opendr_audio::resampler::resampled;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::WhisperTranscription;
use opendr_engine::{Device, Pool, Result, Task};

use network::Network;
use spectrogram::{RATE, SpectrogramMaker};
use tokenizer::Tokenizer;
use transcribe::Transcript;
use vocabulary::Vocabulary;

const TOKENIZER: &str = "tokenizer.json";

impl Learner for Whisper {
    const SPEC: Spec = Spec::new("whisper", Task::SpeechTranscription)
        .class("WhisperLearner")
        .about("Whisper transcribes speech, with timestamps.")
        .without_effect(&[
            ("verbose", "the caller prints the transcription"),
            ("word_timestamps", "only segments have timestamps"),
            ("prepend_punctuations", "it belongs to word_timestamps"),
            ("append_punctuations", "it belongs to word_timestamps"),
            ("fp16", "the runtime computes in FP32; weights are stored as in the model's file"),
        ]);
    type Params = WhisperParams;
    type Input<'a> = AudioInput<'a>;
    type Target = WhisperTranscription;
    type State = WhisperStream;

    fn load(model: &Model, params: WhisperParams, device: Device) -> Result<Self> {
        let network = Network::load(model, device)?;
        let tokenizer = Tokenizer::from_json(&model.file(TOKENIZER)?)?;
        let vocabulary = Vocabulary::new(tokenizer, network.tokens)?;
        let maker = SpectrogramMaker::new(network.bands)?;
        Ok(Self { params, network, vocabulary, maker, work: Pool::default() })
    }

    fn params(&self) -> &WhisperParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut WhisperParams {
        &mut self.params
    }

    /// Transcribes a whole recording at any sample rate from 1,000 to 768,000 Hz; less than 10 ms yield no text. The stream's
    /// state is not used.
    fn infer_into(
        &self,
        _: &mut WhisperStream,
        sound: AudioInput<'_>,
        transcription: &mut WhisperTranscription,
    ) -> Result<()> {
        transcription.text.clear();
        transcription.segments.clear();
        let rate = sound.rate(RATE);
        let mut samples = sound.samples(rate)?;
        if rate != RATE {
            samples = resampled(&samples, rate, RATE)?.into();
        }
        let mut transcript = Transcript::new(self)?;
        transcript.write(self, &samples, transcription)
    }
}
