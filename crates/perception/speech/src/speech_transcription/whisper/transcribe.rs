//! Transcription of audio of any length, window by window (openai/whisper's `transcribe`).

use opendr_engine::target::{WhisperSegment, WhisperTranscription};
use opendr_engine::{Error, Result};

use super::decoding::{DecodeOptions, Decoded, Decoding};
use super::model::{Whisper, Work};
use super::network::{CONTEXT, EncoderOutput, KeyValueCache};
use super::rules::Rules;
use super::segments::cut;
use super::spectrogram::{HOP, RATE, WINDOW};

/// Maximum number of prompt tokens before a window.
const PROMPT: usize = CONTEXT / 2 - 1;

/// Maximum number of prefix tokens: with a prompt and the initial tokens, the context has room for the text.
const PREFIX: usize = CONTEXT / 2 - 8;

/// State from window to window.
#[derive(Debug, Default, Clone)]
pub struct Transcript {
    /// Prompt tokens of the next window.
    prompt: Vec<u32>,
    language: Option<u32>,
    /// Whether the language is known.
    is_language_known: bool,
    /// Number of samples before the audio that is transcribed next.
    pub begin: u64,
    segments: i64,
}

impl Transcript {
    /// Starts a transcript.
    ///
    /// # Errors
    /// `InvalidParam` for an unknown language or a prompt that is too long.
    pub fn new(whisper: &Whisper) -> Result<Self> {
        let (vocabulary, params) = (&whisper.vocabulary, &whisper.params);
        let language = params.language.as_deref().map(|name| vocabulary.language(name)).transpose()?;
        let prompt = params
            .initial_prompt
            .as_deref()
            .map_or(Ok(Vec::new()), |prompt| vocabulary.tokenizer.tokens(&format!(" {}", prompt.trim())))?;
        Ok(Self {
            prompt,
            is_language_known: language.is_some() || !vocabulary.is_multilingual(),
            language: language.flatten(),
            ..Self::default()
        })
    }

    /// Transcribes audio at [`RATE`] to its end and appends to `transcription`.
    ///
    /// # Errors
    /// `InvalidParam` for parameters that do not fit the model; the errors of the runtime.
    pub fn write(
        &mut self,
        whisper: &Whisper,
        samples: &[f32],
        transcription: &mut WhisperTranscription,
    ) -> Result<()> {
        let work = &mut *whisper.work.take();
        whisper.maker.run_into(samples, &mut work.spectrogram);
        let mut frame = 0;
        while frame < work.spectrogram.frames {
            frame += self.window(whisper, work, frame, &whisper.params.temperature, transcription)?.max(1);
        }
        self.begin += samples.len() as u64;
        Ok(())
    }

    /// Transcribes the first window of audio at [`RATE`] and returns the number of samples that it covers.
    ///
    /// # Errors
    /// As [`Transcript::write`].
    pub fn write_window(
        &mut self,
        whisper: &Whisper,
        samples: &[f32],
        temperatures: &[f32],
        transcription: &mut WhisperTranscription,
    ) -> Result<usize> {
        let work = &mut *whisper.work.take();
        whisper.maker.run_into(samples, &mut work.spectrogram);
        let frames = self.window(whisper, work, 0, temperatures, transcription)?;
        let consumed = (frames * HOP).min(samples.len());
        self.begin += consumed as u64;
        Ok(consumed)
    }

    /// Transcribes one window and returns the number of frames that it covers.
    fn window(
        &mut self,
        whisper: &Whisper,
        work: &mut Work,
        first: usize,
        temperatures: &[f32],
        transcription: &mut WhisperTranscription,
    ) -> Result<usize> {
        let Whisper { network, vocabulary, params, .. } = whisper;
        let frames = work.spectrogram.frames.saturating_sub(first).min(WINDOW);
        whisper.maker.window_into(&work.spectrogram, first, &mut work.window);
        network.encode(&work.window, &mut work.encoded)?;
        if !self.is_language_known {
            self.language = Some(detected(whisper, &work.encoded)?);
            self.is_language_known = true;
        }
        let suppressed = suppressed(whisper)?;
        let options = self.options(whisper, &suppressed)?;
        let decoding = Decoding { network, vocabulary, encoded: &work.encoded, options: &options };
        let begin = self.begin + (first * HOP) as u64;
        let decoded = decoding.run(temperatures, begin)?;
        if is_silence(whisper, &decoded) {
            return Ok(frames);
        }
        let (parts, consumed) = cut(&decoded, vocabulary, frames);
        let begin_s = begin as f64 / f64::from(RATE);
        for part in parts {
            let text = vocabulary.text(&part.tokens);
            if part.start == part.end || text.trim().is_empty() {
                continue;
            }
            self.prompt.extend(&part.tokens);
            transcription.text.push_str(&text);
            transcription.segments.push(WhisperSegment {
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
        // A text from a high temperature is not used as the prompt.
        if !params.condition_on_previous_text || decoded.temperature > 0.5 {
            self.prompt.clear();
        }
        let passed = self.prompt.len().saturating_sub(PROMPT);
        self.prompt.drain(..passed);
        Ok(consumed)
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

/// Returns the likeliest language of an encoded window.
fn detected(whisper: &Whisper, encoded: &EncoderOutput) -> Result<u32> {
    let (mut cache, mut logits) = (KeyValueCache::default(), Vec::new());
    whisper.network.clear_cache(&mut cache);
    whisper.network.decode(encoded, &mut cache, &[whisper.vocabulary.start], &mut logits)?;
    let score = |token: &u32| logits.get(*token as usize).copied().unwrap_or(f32::NEG_INFINITY);
    let likeliest = whisper.vocabulary.languages().max_by(|a, b| score(a).total_cmp(&score(b)));
    likeliest.ok_or_else(|| Error::internal("a multilingual Whisper has no languages"))
}

/// Returns the tokens of the parameter `suppress_tokens`.
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
                    "suppress_tokens = {list:.80?} is invalid; use token ids below {}, separated by commas, or -1",
                    whisper.network.tokens
                )));
            }
        }
    }
    Ok(tokens)
}
