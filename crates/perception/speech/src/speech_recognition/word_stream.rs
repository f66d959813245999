//! Words in a stream of sound.

use std::collections::VecDeque;

use opendr_engine::data::Audio;
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Device, Error, Result};

use crate::voice_activity::{CHUNK, SAMPLE_RATE, Speech, VoiceNetwork, VoiceRule, VoiceStream};

/// How a stream of sound is listened to.
#[derive(Debug, Clone, Params)]
pub struct WordStreamParams {
    /// A container of `silero_vad`: seconds of a stream in which nobody speaks are then not answered, which is
    /// the wake-word mode. None: every second is answered.
    pub voice_activity: Option<String>,
}

/// What a stream remembers: at most a second of sound, and whether somebody spoke in it.
///
/// Time is counted in samples. Pieces may have any length, and pieces that come late or with other stamps change nothing:
/// whoever loses sound gives silence instead, or resets the stream. A piece of another sample rate is refused
/// and leaves the stream as it was.
#[derive(Debug, Default)]
pub struct WordStream {
    pending: Vec<f32>,
    /// Samples at its begin that an answer was given for.
    heard: usize,
    voice: VoiceStream,
    speech: Speech,
    /// Whether somebody spoke in each chunk of the last second.
    spoken: VecDeque<bool>,
}

/// What decides which seconds of a stream are answered.
pub(super) struct Listening {
    rate: usize,
    voice: Option<(VoiceNetwork, VoiceRule)>,
}

/// A file of the container of `silero_vad`.
const FILE: &str = "model.onnx";
/// Chunks with speech (128 ms) that a second must have to be answered.
const LEAST_CHUNKS: usize = 4;

impl Listening {
    /// For sound at `rate`.
    ///
    /// # Errors
    /// `InvalidParam` where voice activity is wanted at another rate than its network knows, else what kept that
    /// from being loaded.
    pub fn new(params: &WordStreamParams, rate: u32, device: Device) -> Result<Self> {
        let voice = match &params.voice_activity {
            Some(_) if rate != SAMPLE_RATE => {
                return Err(Error::invalid_param(format!(
                    "voice_activity hears sound at {SAMPLE_RATE} Hz, not at {rate}; leave it out, or change sample_rate"
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

    /// Takes sound in, and hands on each second of it, half a second after the one before, that is to be answered.
    ///
    /// # Errors
    /// Whatever the network or `each` fails with.
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
            self.listen(stream, now)?;
            if stream.pending.len() < second {
                return Ok(());
            }
            if self.is_answered(stream) {
                each(&self.audio(&stream.pending)?)?;
            }
            stream.heard = second - second / 2;
            stream.pending.drain(..second / 2);
        }
    }

    /// What is left when the stream ends, where it is to be answered and no answer was given for it; the stream is a fresh one
    /// after.
    ///
    /// # Errors
    /// Whatever the network fails with.
    pub fn flush(&self, stream: &mut WordStream) -> Result<Option<Audio>> {
        let rest = std::mem::take(stream);
        let wanted = rest.pending.len() > rest.heard && self.is_answered(&rest);
        if wanted { self.audio(&rest.pending).map(Some) } else { Ok(None) }
    }

    fn audio(&self, samples: &[f32]) -> Result<Audio> {
        Audio::new(samples.to_vec(), 1, self.rate as u32)
    }

    fn listen(&self, stream: &mut WordStream, samples: &[f32]) -> Result<()> {
        let Some((network, rule)) = &self.voice else { return Ok(()) };
        let WordStream { voice, speech, spoken, .. } = stream;
        network.push(voice, samples, |probability| {
            rule.next(speech, probability);
            spoken.push_front(speech.is_active());
            spoken.truncate(self.rate / CHUNK);
            Ok(())
        })
    }

    fn is_answered(&self, stream: &WordStream) -> bool {
        let chunks = stream.spoken.iter().take(stream.pending.len() / CHUNK);
        self.voice.is_none() || chunks.filter(|spoken| **spoken).count() >= LEAST_CHUNKS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn listening(rate: usize) -> Listening {
        Listening { rate, voice: None }
    }

    #[test]
    fn pieces_give_the_windows_of_the_whole() {
        let sound: Vec<f32> = (0..37).map(|at| at as f32).collect();
        let windows = |size: usize| {
            let (mut stream, mut windows) = (WordStream::default(), Vec::new());
            for piece in sound.chunks(size) {
                let taken = listening(10).push(&mut stream, piece, |window| {
                    windows.push(window.as_slice().to_vec());
                    Ok(())
                });
                taken.unwrap();
                assert!(stream.pending.len() < 10);
            }
            let rest = listening(10).flush(&mut stream).unwrap();
            windows.extend(rest.map(|rest| rest.as_slice().to_vec()));
            assert!(listening(10).flush(&mut stream).unwrap().is_none());
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
    fn what_was_answered_is_not_left() {
        let mut stream = WordStream::default();
        listening(10).push(&mut stream, &[0.0; 15], |_| Ok(())).unwrap();
        assert!(listening(10).flush(&mut stream).unwrap().is_none());
    }

    #[test]
    fn an_hour_of_silence_takes_the_memory_of_a_second() {
        let (mut stream, mut windows) = (WordStream::default(), 0);
        let listening = listening(16_000);
        for _ in 0..3600 * 16 {
            let taken = listening.push(&mut stream, &[0.0; 1000], |_| {
                windows += 1;
                Ok(())
            });
            taken.unwrap();
        }
        assert_eq!(windows, 2 * 3600 - 1);
        assert!(stream.pending.capacity() <= 32_000);
    }
}
