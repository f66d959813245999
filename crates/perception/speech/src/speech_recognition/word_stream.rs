//! Words in a stream of audio.

use std::collections::VecDeque;

use opendr_engine::data::Audio;
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Device, Error, Result};

use crate::voice_activity::{CHUNK, SAMPLE_RATE, Speech, VoiceNetwork, VoiceRule, VoiceStream};

/// Options of streams of audio.
#[derive(Debug, Clone, Params)]
pub struct WordStreamParams {
    /// Path of a container of `silero_vad`; seconds of a stream without speech then yield no prediction (wake-word mode). None:
    /// every second yields a prediction.
    pub voice_activity: Option<String>,
}

/// State of a stream: at most a second of audio, and whether it contains speech.
///
/// Time is counted in samples. Pieces may have any length, and late pieces or other stamps change nothing: the caller passes
/// silence for lost audio, or resets the stream. A piece of another sample rate is refused and leaves the stream unchanged.
#[derive(Debug, Default)]
pub struct WordStream {
    pending: Vec<f32>,
    /// Number of samples at the start of `pending` that a prediction already covered.
    processed: usize,
    voice: VoiceStream,
    speech: Speech,
    /// Whether each chunk of the last second contains speech, newest first.
    spoken: VecDeque<bool>,
}

/// Cuts a stream into windows of a second and selects those with speech.
pub(super) struct SpeechWindows {
    rate: usize,
    voice: Option<(VoiceNetwork, VoiceRule)>,
}

/// File of the network in a container of `silero_vad`.
const FILE: &str = "model.onnx";
/// Minimum number of chunks with speech in a window that yields a prediction: 4 chunks are 128 ms.
const LEAST_CHUNKS: usize = 4;

impl SpeechWindows {
    /// Creates windows for audio at `rate` in Hz.
    ///
    /// # Errors
    /// `InvalidParam` where voice activity detection is requested at another rate than that of its network; the errors of
    /// loading its container.
    pub fn new(params: &WordStreamParams, rate: u32, device: Device) -> Result<Self> {
        let voice = match &params.voice_activity {
            Some(_) if rate != SAMPLE_RATE => {
                return Err(Error::invalid_param(format!(
                    "voice_activity requires sample_rate = {SAMPLE_RATE}, not {rate}; omit voice_activity or change sample_rate"
                )));
            }
            Some(path) => {
                let network = VoiceNetwork::open(&Model::open(path)?.file(FILE)?, device)?;
                Some((network, VoiceRule::default()))
            }
            None => None,
        };
        Ok(Self { rate: rate as usize, voice })
    }

    /// Adds samples and passes every window with speech to `each`; windows of a second start half a second apart.
    ///
    /// # Errors
    /// The errors of the network and of `each`.
    pub fn push(
        &self,
        stream: &mut WordStream,
        mut samples: &[f32],
        mut each: impl FnMut(&Audio) -> Result<()>,
    ) -> Result<()> {
        let second = self.rate;
        loop {
            let (now, later) = samples.split_at((second - stream.pending.len()).min(samples.len()));
            stream.pending.extend_from_slice(now);
            samples = later;
            self.detect_voice(stream, now)?;
            if stream.pending.len() < second {
                return Ok(());
            }
            if self.has_speech(stream) {
                each(&self.audio(&stream.pending)?)?;
            }
            stream.processed = second - second / 2;
            stream.pending.drain(..second / 2);
        }
    }

    /// Ends the stream and resets it. Returns the remaining samples, where they contain speech and no window covered them.
    ///
    /// The errors of the network.
    /// Whatever the network fails with.
    pub fn flush(&self, stream: &mut WordStream) -> Result<Option<Audio>> {
        let rest = std::mem::take(stream);
        let is_pending = rest.pending.len() > rest.processed && self.has_speech(&rest);
        if is_pending { self.audio(&rest.pending).map(Some) } else { Ok(None) }
    }

    fn audio(&self, samples: &[f32]) -> Result<Audio> {
        Audio::new(samples.to_vec(), 1, self.rate as u32)
    }

    fn detect_voice(&self, stream: &mut WordStream, samples: &[f32]) -> Result<()> {
        let Some((network, rule)) = &self.voice else { return Ok(()) };
        let WordStream { voice, speech, spoken, .. } = stream;
        network.push(voice, samples, |probability| {
            rule.next(speech, probability);
            spoken.push_front(speech.is_active());
            spoken.truncate(self.rate / CHUNK);
            Ok(())
        })
    }

    fn has_speech(&self, stream: &WordStream) -> bool {
        let chunks = stream.spoken.iter().take(stream.pending.len() / CHUNK);
        self.voice.is_none() || chunks.filter(|spoken| **spoken).count() >= LEAST_CHUNKS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn windows_at(rate: usize) -> SpeechWindows {
        SpeechWindows { rate, voice: None }
    }

    #[test]
    fn pieces_yield_the_windows_of_the_whole() {
        let sound: Vec<f32> = (0..37).map(|at| at as f32).collect();
        let windows = |size: usize| {
            let (mut stream, mut windows) = (WordStream::default(), Vec::new());
            for piece in sound.chunks(size) {
                let taken = windows_at(10).push(&mut stream, piece, |window| {
                    windows.push(window.as_slice().to_vec());
                    Ok(())
                });
                taken.unwrap();
                assert!(stream.pending.len() < 10);
            }
            let rest = windows_at(10).flush(&mut stream).unwrap();
            windows.extend(rest.map(|rest| rest.as_slice().to_vec()));
            assert!(windows_at(10).flush(&mut stream).unwrap().is_none());
            windows
        };
        let whole = windows(37);
        assert_eq!(
            whole.iter().map(|window| window[0]).collect::<Vec<_>>(),
            [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0]
        );
        assert_eq!((whole[5].len(), whole[6].len()), (10, 7));
        assert!([1, 3, 10, 16].into_iter().all(|size| windows(size) == whole));
    }

    #[test]
    fn flush_omits_covered_samples() {
        let mut stream = WordStream::default();
        windows_at(10).push(&mut stream, &[0.0; 15], |_| Ok(())).unwrap();
        assert!(windows_at(10).flush(&mut stream).unwrap().is_none());
    }

    #[test]
    fn memory_is_bounded_over_an_hour_of_silence() {
        let (mut stream, mut windows) = (WordStream::default(), 0);
        let windows_at = windows_at(16_000);
        for _ in 0..3600 * 16 {
            let taken = windows_at.push(&mut stream, &[0.0; 1000], |_| {
                windows += 1;
                Ok(())
            });
            taken.unwrap();
        }
        assert_eq!(windows, 2 * 3600 - 1);
        assert!(stream.pending.capacity() <= 32_000);
    }
}
