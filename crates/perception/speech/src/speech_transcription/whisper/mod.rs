//! Whisper: speech transcription with an encoder and a decoder.
//!
//! Radford et al., Robust Speech Recognition via Large-Scale Weak Supervision, 2022; the decoding rules are those of
//! openai/whisper. Windows of 30 s follow each other by the timestamps that the decoder predicts. A stream is transcribed
//! phrase by phrase.

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
use opendr_sound::AudioInput;
use opendr_sound::resampler::resampled;

use network::{EncoderOutput, Network};
use spectrogram::{RATE, Spectrogram, SpectrogramMaker};
use tokenizer::Tokenizer;
use transcribe::Transcript;
use vocabulary::Vocabulary;

/// Parameters of [`Whisper`]; names and defaults are OpenDR's.
#[derive(Debug, Clone, Params)]
pub struct WhisperParams {
    /// Sampling temperatures; the next one is used where the text at the previous one is repetitive or unlikely. 0 selects the
    /// likeliest token.
    #[param(default = vec![0.0, 0.2, 0.4, 0.6, 0.8, 1.0], range = 0.0..=10.0, live)]
    pub temperature: Vec<f32>,
    /// Compression ratio above which a text counts as repetitive. None: no limit.
    #[param(default = Some(2.4), range = 0.0..=1000.0, live)]
    pub compression_ratio_threshold: Option<f32>,
    /// Mean log-probability of the tokens below which a text counts as unlikely. None: no limit.
    #[param(default = Some(-0.8), range = -1000.0..=0.0, live)]
    pub logprob_threshold: Option<f32>,
    /// Probability of no speech above which a window with an unlikely text counts as silent. None: no window does.
    #[param(default = Some(0.6), range = 0.0..=1.0, live)]
    pub no_speech_threshold: Option<f32>,
    /// Whether the text of a window is the prompt of the next: more coherent, but errors can propagate.
    #[param(live)]
    pub condition_on_previous_text: bool,
    /// Language of the speech, e.g. `en`. None: multilingual models detect it in the first 30 s.
    #[param(default = Some("en".to_owned()), live)]
    pub language: Option<String>,
    /// Maximum number of tokens per window. None: 224.
    #[param(range = 1..=448, live)]
    pub sample_len: Option<usize>,
    /// Number of samples at each temperature above 0, of which the likeliest is selected. None: one.
    #[param(range = 1..=64, live)]
    pub best_of: Option<usize>,
    /// Beam size at temperature 0. None: greedy decoding.
    #[param(range = 1..=64, live)]
    pub beam_size: Option<usize>,
    /// Factor on the number of finished texts that ends a beam search. None: 1.
    #[param(range = 0.0..=64.0, live)]
    pub patience: Option<f32>,
    /// Exponent of the length penalty (Google's GNMT), 0 to 1. None: candidates are ranked by the mean of their tokens.
    #[param(range = 0.0..=1.0, live)]
    pub length_penalty: Option<f32>,
    /// Prompt of the first window: names and spellings to expect.
    #[param(alias = "prompt", live)]
    pub initial_prompt: Option<String>,
    /// Text at the start of every window.
    #[param(live)]
    pub prefix: Option<String>,
    /// Token ids that are never decoded, separated by commas; -1 stands for symbols that are not spoken. None: no token is
    /// suppressed.
    #[param(default = Some("-1".to_owned()), live)]
    pub suppress_tokens: Option<String>,
    /// Whether a window must not begin with a space or with its end.
    #[param(default = true, live)]
    pub suppress_blank: bool,
    /// Whether to omit timestamps; each window is then one segment.
    #[param(live)]
    pub without_timestamps: bool,
    /// Latest start of a window's first segment. None: no limit.
    #[param(default = Some(1.0), range = 0.0..=30.0, unit = "s", live)]
    pub max_initial_timestamp: Option<f32>,
    /// Interval of partial transcriptions of an unfinished phrase in a stream. None: finished phrases only.
    #[param(default = Some(3.0), range = 0.5..=30.0, unit = "s", live)]
    pub partial_interval: Option<f32>,
    /// Root mean square below which audio in a stream is silence.
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

/// Buffers of one call.
#[derive(Default)]
struct Work {
    spectrogram: Spectrogram,
    window: Vec<f32>,
    encoded: EncoderOutput,
}

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
