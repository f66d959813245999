//! The loaded networks.

use opendr_engine::Pool;
use opendr_engine::params::Params;

use super::network::{EncoderOutput, Network};
use super::spectrogram::{Spectrogram, SpectrogramMaker};
use super::vocabulary::Vocabulary;

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
    pub(super) params: WhisperParams,
    pub(super) network: Network,
    pub(super) vocabulary: Vocabulary,
    pub(super) maker: SpectrogramMaker,
    pub(super) work: Pool<Work>,
}

/// Buffers of one call.
#[derive(Default)]
pub(super) struct Work {
    pub(super) spectrogram: Spectrogram,
    pub(super) window: Vec<f32>,
    pub(super) encoded: EncoderOutput,
}
