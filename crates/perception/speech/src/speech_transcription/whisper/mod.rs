//! Whisper: an encoder and a decoder that write down what was said.
//!
//! Radford et al., Robust Speech Recognition via Large-Scale Weak Supervision, 2022; the rules of decoding are those of
//! openai/whisper. Windows of 30 s follow each other by the times that the decoder gives. A stream is written
//! down phrase by phrase.

mod beam;
mod decode;
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

pub use stream::WhisperStream;

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::WhisperTranscription;
use opendr_engine::{Device, Pool, Result, Task};
use opendr_sound::Sound;
use opendr_sound::resampler::resampled;

use network::{Heard, Network};
use spectrogram::{RATE, Spectrogram, SpectrogramMaker};
use tokenizer::Tokenizer;
use transcribe::Transcript;
use vocabulary::Vocabulary;

/// What a user may set; names and defaults are OpenDR's.
#[derive(Debug, Clone, Params)]
pub struct WhisperParams {
    /// How random tokens are drawn; the next is tried where the answer to the one before stammers or is unlikely. 0 takes the
    /// likeliest.
    #[param(default = vec![0.0, 0.2, 0.4, 0.6, 0.8, 1.0], range = 0.0..=10.0, live)]
    pub temperature: Vec<f32>,
    /// Text that packs better than this stammers. None: no text does.
    #[param(default = Some(2.4), range = 0.0..=1000.0, live)]
    pub compression_ratio_threshold: Option<f32>,
    /// Tokens whose logarithms of probabilities have a smaller mean are unlikely. None: none are.
    #[param(default = Some(-0.8), range = -1000.0..=0.0, live)]
    pub logprob_threshold: Option<f32>,
    /// A window that is silent with a higher probability, and whose text is unlikely, has none. None: all have.
    #[param(default = Some(0.6), range = 0.0..=1.0, live)]
    pub no_speech_threshold: Option<f32>,
    /// Whether the text of a window is what the next begins with: connected, but errors go on too.
    #[param(live)]
    pub condition_on_previous_text: bool,
    /// What is spoken, e.g. `en`. None: multilingual models find out in the first 30 s.
    #[param(default = Some("en".to_owned()), live)]
    pub language: Option<String>,
    /// The most tokens of a window. None: 224.
    #[param(range = 1..=448, live)]
    pub sample_len: Option<usize>,
    /// Texts that are drawn at each temperature above 0, of which the likeliest is taken. None: one.
    #[param(range = 1..=64, live)]
    pub best_of: Option<usize>,
    /// Texts that are followed at temperature 0. None: one, always the likeliest token.
    #[param(range = 1..=64, live)]
    pub beam_size: Option<usize>,
    /// So many times as many texts are finished before such a search ends. None: 1.
    #[param(range = 0.0..=64.0, live)]
    pub patience: Option<f32>,
    /// How longer texts are preferred (Google's GNMT), 0 to 1. None: by the mean of their tokens.
    #[param(range = 0.0..=1.0, live)]
    pub length_penalty: Option<f32>,
    /// Text that the first window begins behind: names and spellings to be expected.
    #[param(alias = "prompt", live)]
    pub initial_prompt: Option<String>,
    /// Text that every window begins with.
    #[param(live)]
    pub prefix: Option<String>,
    /// Numbers of tokens that are never written, separated by commas; -1 stands for signs that nobody speaks. None: all
    /// may be.
    #[param(default = Some("-1".to_owned()), live)]
    pub suppress_tokens: Option<String>,
    /// Whether no window begins with a space or its end.
    #[param(default = true, live)]
    pub suppress_blank: bool,
    /// Whether segments have no times; then there is one for each window.
    #[param(live)]
    pub without_timestamps: bool,
    /// The latest begin of a window's first segment. None: anywhere.
    #[param(default = Some(1.0), range = 0.0..=30.0, unit = "s", live)]
    pub max_initial_timestamp: Option<f32>,
    /// How often a stream tells what it understood of a phrase that goes on. None: only phrases that are over.
    #[param(default = Some(3.0), range = 0.5..=30.0, unit = "s", live)]
    pub partial_interval: Option<f32>,
    /// Sound in a stream whose root mean square is lower is silence.
    #[param(default = 0.002, range = 0.0..=1.0, live)]
    pub silence_level: f32,
}

/// A loaded Whisper.
pub struct Whisper {
    params: WhisperParams,
    network: Network,
    vocabulary: Vocabulary,
    maker: SpectrogramMaker,
    work: Pool<Work>,
}

/// Memory of one call.
#[derive(Default)]
struct Work {
    spectrogram: Spectrogram,
    window: Vec<f32>,
    heard: Heard,
}

const TOKENIZER: &str = "tokenizer.json";

impl Learner for Whisper {
    const SPEC: Spec = Spec::new("whisper", Task::SpeechTranscription)
        .class("WhisperLearner")
        .about("Whisper writes down what was said, with times.")
        .without_effect(&[
            ("verbose", "answers are shown by who asks for them"),
            ("word_timestamps", "times are those of segments"),
            ("prepend_punctuations", "it belongs to word_timestamps"),
            ("append_punctuations", "it belongs to word_timestamps"),
            ("fp16", "the runtime computes in 32 bits; weights are stored as the model's file has them"),
        ]);
    type Params = WhisperParams;
    type Input<'a> = Sound<'a>;
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

    /// Writes down a whole sound of any rate from 1,000 to 768,000 Hz; less than 10 ms have no text. The stream's state
    /// plays no part.
    fn infer_into(
        &self,
        _: &mut WhisperStream,
        sound: Sound<'_>,
        said: &mut WhisperTranscription,
    ) -> Result<()> {
        said.text.clear();
        said.segments.clear();
        let rate = sound.rate(RATE);
        let mut samples = sound.samples(rate)?;
        if rate != RATE {
            samples = resampled(&samples, rate, RATE)?.into();
        }
        let mut transcript = Transcript::new(self)?;
        transcript.write(self, &samples, said)
    }
}
