//! Words in a stream of sound.

use opendr_engine::Result;
use opendr_engine::data::Audio;
use opendr_engine::learner::{Learner, Streaming};
use opendr_engine::target::Category;

use super::MatchboxNet;
use crate::speech_recognition::Sound;

/// What a stream remembers: the sound that is yet to be heard whole.
#[derive(Debug, Default)]
pub struct MatchboxNetStream {
    pending: Vec<f32>,
    /// Samples at its begin that an answer was given for.
    heard: usize,
}

impl MatchboxNetStream {
    /// Takes sound in, and hands on each second of it, half a second after the one before.
    fn push(
        &mut self,
        samples: &[f32],
        second: usize,
        mut each: impl FnMut(&[f32]) -> Result<()>,
    ) -> Result<()> {
        self.pending.extend_from_slice(samples);
        let mut begin = 0;
        while let Some(window) = self.pending.get(begin..begin + second) {
            each(window)?;
            self.heard = second - second / 2;
            begin += second / 2;
        }
        self.pending.drain(..begin);
        Ok(())
    }

    /// What is left when the stream ends, where no answer was given for it.
    fn finish(&mut self) -> Option<Vec<f32>> {
        let rest = std::mem::take(self);
        (rest.pending.len() > rest.heard).then_some(rest.pending)
    }
}

impl MatchboxNet {
    fn category(&self, samples: &[f32]) -> Result<Category> {
        let audio = Audio::new(samples.to_vec(), 1, self.params.sample_rate)?;
        let mut category = Category::default();
        self.infer_into(&mut MatchboxNetStream::default(), Sound::Audio(&audio), &mut category)?;
        Ok(category)
    }
}

/// An answer for every second of sound, each half a second after the one before.
impl Streaming for MatchboxNet {
    fn push(
        &self,
        state: &mut MatchboxNetStream,
        piece: Sound<'_>,
        emit: &mut dyn FnMut(Category),
    ) -> Result<()> {
        let rate = self.params.sample_rate;
        let samples = piece.samples(rate)?;
        state.push(&samples, rate as usize, |window| {
            emit(self.category(window)?);
            Ok(())
        })
    }

    fn flush(&self, state: &mut MatchboxNetStream, emit: &mut dyn FnMut(Category)) -> Result<()> {
        if let Some(rest) = state.finish() {
            emit(self.category(&rest)?);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_give_the_windows_of_the_whole() {
        let sound: Vec<f32> = (0..37).map(|at| at as f32).collect();
        let windows = |size: usize| {
            let (mut stream, mut windows) = (MatchboxNetStream::default(), Vec::new());
            for piece in sound.chunks(size) {
                let taken = stream.push(piece, 10, |window| {
                    windows.push(window.to_vec());
                    Ok(())
                });
                taken.unwrap();
            }
            windows.extend(stream.finish());
            assert!(stream.finish().is_none());
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
        let mut stream = MatchboxNetStream::default();
        stream.push(&[0.0; 15], 10, |_| Ok(())).unwrap();
        assert!(stream.finish().is_none());
    }
}
