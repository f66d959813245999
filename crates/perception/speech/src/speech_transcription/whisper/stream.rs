//! Transcription of a stream of audio.

use opendr_audio::AudioInput;
use opendr_audio::resampler::Resampler;
use opendr_engine::Result;
use opendr_engine::learner::Streaming;
use opendr_engine::target::WhisperTranscription;

use super::model::Whisper;
use super::phrases::{Phrases, Step};
use super::spectrogram::{HOP, RATE, WINDOW};
use super::transcribe::Transcript;

/// State of a stream: at most 30 s of the current phrase, and no silence.
#[derive(Debug, Default)]
pub struct WhisperStream {
    resampler: Option<Resampler>,
    phrases: Phrases,
    /// `None` before the first phrase.
    transcript: Option<Transcript>,
    /// Steps of speech since the last transcription.
    since_emitted: usize,
}

/// Steps of [`Phrases`] per second.
const STEPS: f32 = 50.0;

impl WhisperStream {
    /// Resamples audio to Whisper's rate.
    fn resampled(&mut self, samples: &[f32], rate: u32) -> Result<Vec<f32>> {
        let mut resampled = Vec::new();
        if self.resampler.as_ref().is_none_or(|resampler| resampler.from_rate() != rate) {
            let resampler = Resampler::new(rate, RATE)?;
            if let Some(mut last) = self.resampler.replace(resampler) {
                last.finish(&mut resampled);
            }
        }
        if let Some(resampler) = &mut self.resampler {
            resampler.push(samples, &mut resampled);
        }
        Ok(resampled)
    }
}

impl Whisper {
    fn process(
        &self,
        stream: &mut WhisperStream,
        samples: &[f32],
        emit: &mut dyn FnMut(WhisperTranscription),
    ) -> Result<()> {
        let WhisperStream { phrases, transcript, since_emitted, .. } = stream;
        let interval = self.params.partial_interval.map(|seconds| (seconds * STEPS) as usize);
        phrases.push(samples, self.params.silence_level, |phrases, step| {
            *since_emitted += usize::from(step == Step::Speech);
            match step {
                Step::Silence => Ok(()),
                Step::End => {
                    *since_emitted = 0;
                    self.emit_phrase(transcript, phrases, emit)
                }
                Step::Speech if phrases.sound.len() >= WINDOW * HOP => {
                    *since_emitted = 0;
                    self.emit_window(transcript, phrases, emit)
                }
                Step::Speech if interval.is_some_and(|interval| *since_emitted >= interval) => {
                    *since_emitted = 0;
                    self.emit_partial(transcript, phrases, emit)
                }
                Step::Speech => Ok(()),
            }
        })
    }

    fn transcript_at<'t>(
        &self,
        transcript: &'t mut Option<Transcript>,
        begin: u64,
    ) -> Result<&'t mut Transcript> {
        let current = match transcript.take() {
            Some(current) => current,
            None => Transcript::new(self)?,
        };
        let current = transcript.insert(current);
        current.begin = begin;
        Ok(current)
    }

    /// Transcribes a finished phrase.
    fn emit_phrase(
        &self,
        transcript: &mut Option<Transcript>,
        phrases: &mut Phrases,
        emit: &mut dyn FnMut(WhisperTranscription),
    ) -> Result<()> {
        let mut transcription = WhisperTranscription::default();
        self.transcript_at(transcript, phrases.begin)?.write(self, &phrases.sound, &mut transcription)?;
        phrases.end();
        if !transcription.segments.is_empty() {
            emit(transcription);
        }
        Ok(())
    }

    /// Transcribes a phrase that fills a window.
    fn emit_window(
        &self,
        transcript: &mut Option<Transcript>,
        phrases: &mut Phrases,
        emit: &mut dyn FnMut(WhisperTranscription),
    ) -> Result<()> {
        let mut transcription = WhisperTranscription::default();
        let current = self.transcript_at(transcript, phrases.begin)?;
        let consumed =
            current.write_window(self, &phrases.sound, &self.params.temperature, &mut transcription)?;
        phrases.drop_first(consumed.max(HOP));
        if !transcription.segments.is_empty() {
            emit(transcription);
        }
        Ok(())
    }

    /// Transcribes an unfinished phrase at the first temperature; the result has text and no segments.
    fn emit_partial(
        &self,
        transcript: &mut Option<Transcript>,
        phrases: &Phrases,
        emit: &mut dyn FnMut(WhisperTranscription),
    ) -> Result<()> {
        let mut partial = self.transcript_at(transcript, phrases.begin)?.clone();
        let mut transcription = WhisperTranscription::default();
        let first_temperature = self.params.temperature.get(..1).unwrap_or_default();
        partial.write_window(self, &phrases.sound, first_temperature, &mut transcription)?;
        if !transcription.text.is_empty() {
            transcription.segments.clear();
            emit(transcription);
        }
        Ok(())
    }
}

/// Yields a transcription of every phrase when 0.8 s of silence follow it or it fills 30 s. Times are those of the stream.
/// During a phrase, partial transcriptions are yielded every `partial_interval`: text that may still change, without segments.
impl Streaming for Whisper {
    fn push(
        &self,
        stream: &mut WhisperStream,
        piece: AudioInput<'_>,
        emit: &mut dyn FnMut(WhisperTranscription),
    ) -> Result<()> {
        let rate = piece.rate(RATE);
        let samples = piece.samples(rate)?;
        let samples = stream.resampled(&samples, rate)?;
        self.process(stream, &samples, emit)
    }

    fn flush(&self, stream: &mut WhisperStream, emit: &mut dyn FnMut(WhisperTranscription)) -> Result<()> {
        let mut rest = Vec::new();
        if let Some(mut resampler) = stream.resampler.take() {
            resampler.finish(&mut rest);
        }
        self.process(stream, &rest, emit)?;
        let emitted = match stream.phrases.finish() {
            Some(_) => self.emit_phrase(&mut stream.transcript, &mut stream.phrases, emit),
            None => Ok(()),
        };
        *stream = WhisperStream::default();
        emitted
    }
}
