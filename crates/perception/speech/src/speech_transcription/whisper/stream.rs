//! Speech that comes in pieces.

use opendr_engine::Result;
use opendr_engine::learner::Streaming;
use opendr_engine::target::WhisperTranscription;
use opendr_sound::Sound;
use opendr_sound::resampler::Resampler;

use super::Whisper;
use super::phrases::{Phrases, Step};
use super::spectrogram::{HOP, RATE, WINDOW};
use super::transcribe::Transcript;

/// What a stream remembers: at most 30 s of the phrase that goes on, and nothing of silence.
#[derive(Debug, Default)]
pub struct WhisperStream {
    resampler: Option<Resampler>,
    phrases: Phrases,
    /// `None` before the first phrase.
    transcript: Option<Transcript>,
    /// Steps since the phrase was last told.
    untold: usize,
}

/// Steps of [`Phrases`] in a second.
const STEPS: f32 = 50.0;

impl WhisperStream {
    /// Takes sound at another rate in.
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
    fn hear(
        &self,
        stream: &mut WhisperStream,
        samples: &[f32],
        emit: &mut dyn FnMut(WhisperTranscription),
    ) -> Result<()> {
        let WhisperStream { phrases, transcript, untold, .. } = stream;
        let interval = self.params.partial_interval.map(|seconds| (seconds * STEPS) as usize);
        phrases.push(samples, self.params.silence_level, |phrases, step| {
            *untold += usize::from(step == Step::Speech);
            match step {
                Step::Silence => Ok(()),
                Step::End => {
                    *untold = 0;
                    self.tell(transcript, phrases, emit)
                }
                Step::Speech if phrases.sound.len() >= WINDOW * HOP => {
                    *untold = 0;
                    self.tell_window(transcript, phrases, emit)
                }
                Step::Speech if interval.is_some_and(|interval| *untold >= interval) => {
                    *untold = 0;
                    self.tell_so_far(transcript, phrases, emit)
                }
                Step::Speech => Ok(()),
            }
        })
    }

    fn begun<'t>(&self, transcript: &'t mut Option<Transcript>, begin: u64) -> Result<&'t mut Transcript> {
        let begun = match transcript.take() {
            Some(begun) => begun,
            None => Transcript::new(self)?,
        };
        let begun = transcript.insert(begun);
        begun.begin = begin;
        Ok(begun)
    }

    /// The phrase is over.
    fn tell(
        &self,
        transcript: &mut Option<Transcript>,
        phrases: &mut Phrases,
        emit: &mut dyn FnMut(WhisperTranscription),
    ) -> Result<()> {
        let mut said = WhisperTranscription::default();
        self.begun(transcript, phrases.begin)?.write(self, &phrases.sound, &mut said)?;
        phrases.end();
        if !said.segments.is_empty() {
            emit(said);
        }
        Ok(())
    }

    /// The phrase fills a window.
    fn tell_window(
        &self,
        transcript: &mut Option<Transcript>,
        phrases: &mut Phrases,
        emit: &mut dyn FnMut(WhisperTranscription),
    ) -> Result<()> {
        let mut said = WhisperTranscription::default();
        let begun = self.begun(transcript, phrases.begin)?;
        let understood = begun.write_window(self, &phrases.sound, &self.params.temperature, &mut said)?;
        phrases.forget(understood.max(HOP));
        if !said.segments.is_empty() {
            emit(said);
        }
        Ok(())
    }

    /// What was understood of a phrase that goes on: words without segments, quickly decoded.
    fn tell_so_far(
        &self,
        transcript: &mut Option<Transcript>,
        phrases: &Phrases,
        emit: &mut dyn FnMut(WhisperTranscription),
    ) -> Result<()> {
        let mut so_far = self.begun(transcript, phrases.begin)?.clone();
        let mut said = WhisperTranscription::default();
        let coldest = self.params.temperature.get(..1).unwrap_or_default();
        so_far.write_window(self, &phrases.sound, coldest, &mut said)?;
        if !said.text.is_empty() {
            said.segments.clear();
            emit(said);
        }
        Ok(())
    }
}

/// A transcription of every phrase: when 0.8 s of silence follow it, or it fills 30 s. Its times are those of the stream.
/// While a phrase goes on, what was understood so far is told every `partial_interval`: words that may still change, and
/// no segments.
impl Streaming for Whisper {
    fn push(
        &self,
        stream: &mut WhisperStream,
        piece: Sound<'_>,
        emit: &mut dyn FnMut(WhisperTranscription),
    ) -> Result<()> {
        let rate = piece.rate(RATE);
        let samples = piece.samples(rate)?;
        let samples = stream.resampled(&samples, rate)?;
        self.hear(stream, &samples, emit)
    }

    fn flush(&self, stream: &mut WhisperStream, emit: &mut dyn FnMut(WhisperTranscription)) -> Result<()> {
        let mut rest = Vec::new();
        if let Some(mut resampler) = stream.resampler.take() {
            resampler.finish(&mut rest);
        }
        self.hear(stream, &rest, emit)?;
        let told = match stream.phrases.finish() {
            Some(_) => self.tell(&mut stream.transcript, &mut stream.phrases, emit),
            None => Ok(()),
        };
        *stream = WhisperStream::default();
        told
    }
}
