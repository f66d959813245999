//! A sound of any length, window by window (openai/whisper's `transcribe`).

use opendr_engine::target::{WhisperSegment, WhisperTranscription};
use opendr_engine::{Error, Result};

use super::decode::{DecodeOptions, Decoded, Decoding};
use super::network::{CONTEXT, Heard, Memory};
use super::rules::Rules;
use super::segments::cut;
use super::spectrogram::{HOP, RATE, WINDOW};
use super::{Whisper, Work};

/// The most tokens that stand before a window.
const PROMPT: usize = CONTEXT / 2 - 1;

/// The most tokens of a prefix: with a prompt and what a transcript begins with, others still fit.
const PREFIX: usize = CONTEXT / 2 - 8;

/// What is carried from window to window.
#[derive(Debug, Default, Clone)]
pub struct Transcript {
    /// Tokens that the next window begins behind.
    prompt: Vec<u32>,
    language: Option<u32>,
    /// Whether the language is known.
    settled: bool,
    /// Samples before the sound that is written next.
    pub begin: u64,
    segments: i64,
}

impl Transcript {
    /// The begin of a transcript.
    ///
    /// # Errors
    /// `InvalidParam` for a language that the model does not know or a prompt that is too long.
    pub fn new(whisper: &Whisper) -> Result<Self> {
        let (vocabulary, params) = (&whisper.vocabulary, &whisper.params);
        let language = params.language.as_deref().map(|name| vocabulary.language(name)).transpose()?;
        let prompt = params
            .initial_prompt
            .as_deref()
            .map_or(Ok(Vec::new()), |prompt| vocabulary.tokenizer.tokens(&format!(" {}", prompt.trim())))?;
        Ok(Self {
            prompt,
            settled: language.is_some() || !vocabulary.is_multilingual(),
            language: language.flatten(),
            ..Self::default()
        })
    }

    /// Writes down sound at [`RATE`] to its end, behind what `said` holds.
    ///
    /// # Errors
    /// `InvalidParam` for parameters that do not fit the model, else what the runtime meets.
    pub fn write(
        &mut self,
        whisper: &Whisper,
        samples: &[f32],
        said: &mut WhisperTranscription,
    ) -> Result<()> {
        let work = &mut *whisper.work.take();
        whisper.maker.run_into(samples, &mut work.spectrogram);
        let mut frame = 0;
        while frame < work.spectrogram.frames {
            frame += self.window(whisper, work, frame, &whisper.params.temperature, said)?.max(1);
        }
        self.begin += samples.len() as u64;
        Ok(())
    }

    /// Writes down the first window of sound at [`RATE`], and tells how many samples of it were understood.
    ///
    /// # Errors
    /// As [`Transcript::write`].
    pub fn write_window(
        &mut self,
        whisper: &Whisper,
        samples: &[f32],
        temperatures: &[f32],
        said: &mut WhisperTranscription,
    ) -> Result<usize> {
        let work = &mut *whisper.work.take();
        whisper.maker.run_into(samples, &mut work.spectrogram);
        let frames = self.window(whisper, work, 0, temperatures, said)?;
        let understood = (frames * HOP).min(samples.len());
        self.begin += understood as u64;
        Ok(understood)
    }

    /// One window; how many frames of it were understood.
    fn window(
        &mut self,
        whisper: &Whisper,
        work: &mut Work,
        first: usize,
        temperatures: &[f32],
        said: &mut WhisperTranscription,
    ) -> Result<usize> {
        let Whisper { network, vocabulary, params, .. } = whisper;
        let frames = work.spectrogram.frames.saturating_sub(first).min(WINDOW);
        whisper.maker.window_into(&work.spectrogram, first, &mut work.window);
        network.listen(&work.window, &mut work.heard)?;
        if !self.settled {
            self.language = Some(detected(whisper, &work.heard)?);
            self.settled = true;
        }
        let suppressed = suppressed(whisper)?;
        let options = self.options(whisper, &suppressed)?;
        let decoding = Decoding { network, vocabulary, heard: &work.heard, options: &options };
        let begin = self.begin + (first * HOP) as u64;
        let decoded = decoding.run(temperatures, begin)?;
        if is_silence(whisper, &decoded) {
            return Ok(frames);
        }
        let (parts, understood) = cut(&decoded, vocabulary, frames);
        let begin_s = begin as f64 / f64::from(RATE);
        for part in parts {
            let text = vocabulary.text(&part.tokens);
            if part.start == part.end || text.trim().is_empty() {
                continue;
            }
            self.prompt.extend(&part.tokens);
            said.text.push_str(&text);
            said.segments.push(WhisperSegment {
                id: self.segments,
                seek: (begin / HOP as u64) as i64,
                start: (begin_s + f64::from(part.start)) as f32,
                end: (begin_s + f64::from(part.end)) as f32,
                text,
                tokens: part.tokens.iter().map(|token| i64::from(*token)).collect(),
                temperature: decoded.temperature,
                avg_logprob: decoded.avg_logprob,
                compression_ratio: decoded.compression_ratio,
                no_speech_prob: decoded.no_speech_prob,
            });
            self.segments += 1;
        }
        // A text that only came warm is no good company.
        if !params.condition_on_previous_text || decoded.temperature > 0.5 {
            self.prompt.clear();
        }
        let passed = self.prompt.len().saturating_sub(PROMPT);
        self.prompt.drain(..passed);
        Ok(understood)
    }

    fn options<'a>(&self, whisper: &'a Whisper, suppressed: &'a [u32]) -> Result<DecodeOptions<'a>> {
        let Whisper { params, vocabulary, .. } = whisper;
        let times = !params.without_timestamps;
        let mut beginning = Vec::new();
        if !self.prompt.is_empty() {
            beginning.push(vocabulary.previous);
            beginning.extend(&self.prompt[self.prompt.len().saturating_sub(PROMPT)..]);
        }
        beginning.extend(vocabulary.beginning(self.language, times));
        let sample_len = params.sample_len.unwrap_or(CONTEXT / 2);
        if let Some(prefix) = &params.prefix {
            let prefix = vocabulary.tokenizer.tokens(&format!(" {}", prefix.trim()))?;
            let most = (CONTEXT / 2).saturating_sub(params.sample_len.unwrap_or_default()).min(PREFIX);
            beginning.extend(&prefix[prefix.len().saturating_sub(most)..]);
        }
        let latest = params.max_initial_timestamp.filter(|_| times);
        Ok(DecodeOptions {
            rules: Rules {
                vocabulary,
                suppress_blank: params.suppress_blank,
                suppressed,
                times,
                latest_begin: latest.map(|seconds| (seconds / 0.02).round() as u32),
            },
            beginning,
            sample_len,
            best_of: params.best_of.unwrap_or(1),
            beam_size: params.beam_size,
            patience: params.patience.unwrap_or(1.0),
            length_penalty: params.length_penalty,
            compression_ratio_threshold: params.compression_ratio_threshold,
            logprob_threshold: params.logprob_threshold,
            no_speech_threshold: params.no_speech_threshold,
        })
    }
}

fn is_silence(whisper: &Whisper, decoded: &Decoded) -> bool {
    let params = &whisper.params;
    let likely = params.logprob_threshold.is_some_and(|least| decoded.avg_logprob > least);
    !likely && params.no_speech_threshold.is_some_and(|most| decoded.no_speech_prob > most)
}

/// The language of what was heard.
fn detected(whisper: &Whisper, heard: &Heard) -> Result<u32> {
    let (mut memory, mut logits) = (Memory::default(), Vec::new());
    whisper.network.forget(&mut memory);
    whisper.network.read(heard, &mut memory, &[whisper.vocabulary.start], &mut logits)?;
    let score = |token: &u32| logits.get(*token as usize).copied().unwrap_or(f32::NEG_INFINITY);
    let likeliest = whisper.vocabulary.languages().max_by(|a, b| score(a).total_cmp(&score(b)));
    likeliest.ok_or_else(|| Error::internal("a multilingual Whisper without languages"))
}

/// The tokens of the parameter `suppress_tokens`.
fn suppressed(whisper: &Whisper) -> Result<Vec<u32>> {
    let Some(list) = &whisper.params.suppress_tokens else { return Ok(Vec::new()) };
    let mut tokens = Vec::new();
    for word in list.split(',').map(str::trim).filter(|word| !word.is_empty()) {
        match word.parse::<i64>() {
            Ok(-1) => tokens.extend(&whisper.vocabulary.unspoken),
            Ok(token) if usize::try_from(token).is_ok_and(|token| token < whisper.network.tokens) => {
                tokens.push(token as u32);
            }
            _ => {
                return Err(Error::invalid_param(format!(
                    "suppress_tokens = {list:.80?}: give numbers of tokens below {}, separated by commas, or -1",
                    whisper.network.tokens
                )));
            }
        }
    }
    Ok(tokens)
}
