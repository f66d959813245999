//! Segmentation of a stream of audio into phrases.

use super::spectrogram::RATE;

/// Samples of a step: 20 ms.
const STEP: usize = RATE as usize / 50;
/// Steps of silence that are kept before a phrase.
const LEAD: usize = 15;
/// Steps of silence that end a phrase.
const PAUSE: usize = 40;

/// Audio of the current phrase, without silence. The result depends on the samples alone, not on the pieces in which they
/// arrive.
#[derive(Debug, Default)]
pub struct Phrases {
    /// Samples of the unfinished phrase; in silence, at most `LEAD` steps.
    pub sound: Vec<f32>,
    /// Number of samples of the stream before `sound`.
    pub begin: u64,
    /// Samples of an incomplete step.
    pending: Vec<f32>,
    speaking: bool,
    quiet: usize,
}

/// Result of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Silence, which is dropped.
    Silence,
    /// The phrase continues.
    Speech,
    /// The phrase has ended; [`Phrases::sound`] contains it.
    End,
}

impl Phrases {
    /// Adds a piece of audio; `each` is called after each completed step of 20 ms.
    ///
    /// # Errors
    /// The errors of `each`; the rest of the piece is then lost.
    pub fn push<E>(
        &mut self,
        piece: &[f32],
        silence_level: f32,
        mut each: impl FnMut(&mut Self, Step) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut rest = piece;
        while self.pending.len() + rest.len() >= STEP {
            let (now, later) = rest.split_at((STEP - self.pending.len()).min(rest.len()));
            rest = later;
            self.pending.extend_from_slice(now);
            let step = self.step(silence_level);
            each(self, step)?;
        }
        self.pending.extend_from_slice(rest);
        Ok(())
    }

    fn step(&mut self, silence_level: f32) -> Step {
        let power = self.pending.iter().map(|sample| sample * sample).sum::<f32>() / STEP as f32;
        let quiet = power < silence_level * silence_level;
        self.sound.append(&mut self.pending);
        self.quiet = if quiet { self.quiet + 1 } else { 0 };
        self.speaking |= !quiet;
        match self.speaking {
            true if self.quiet >= PAUSE => Step::End,
            true => Step::Speech,
            false => {
                self.drop_first(self.sound.len().saturating_sub(LEAD * STEP));
                Step::Silence
            }
        }
    }

    /// Drops samples at the start.
    pub fn drop_first(&mut self, count: usize) {
        self.sound.drain(..count.min(self.sound.len()));
        self.begin += count as u64;
    }

    /// Drops the phrase.
    pub fn end(&mut self) {
        self.drop_first(self.sound.len());
        self.speaking = false;
    }

    /// Ends the stream and returns the phrase with the pending samples; `None` in silence.
    pub fn finish(&mut self) -> Option<&[f32]> {
        self.sound.append(&mut self.pending);
        self.speaking.then_some(&self.sound)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream() -> Vec<f32> {
        let loud = |at: usize| if at.is_multiple_of(2) { 0.5 } else { -0.5 };
        let part = |speaks: bool, count: usize| (0..count).map(move |at| if speaks { loud(at) } else { 0.0 });
        part(false, 50_000)
            .chain(part(true, 20_000))
            .chain(part(false, 30_000))
            .chain(part(true, 1000))
            .collect()
    }

    #[test]
    fn phrases_do_not_depend_on_the_pieces() {
        let stream = stream();
        let phrases = |size: usize| {
            let (mut phrases, mut found) = (Phrases::default(), Vec::new());
            for piece in stream.chunks(size) {
                let pushed = phrases.push(piece, 0.01, |phrases, step| {
                    if step == Step::End {
                        found.push((phrases.begin, phrases.sound.len()));
                        phrases.end();
                    }
                    assert!(phrases.sound.len() < 40_000);
                    Ok::<(), ()>(())
                });
                pushed.unwrap();
            }
            let begin = phrases.begin;
            found.extend(phrases.finish().map(|rest| (begin, rest.len())));
            found
        };
        let whole = phrases(stream.len());
        assert_eq!(whole.len(), 2, "{whole:?}");
        let (begin, length) = whole[0];
        assert!((45_000..50_000).contains(&begin) && begin as usize + length > 70_000 + 30 * STEP);
        assert_eq!(whole[1].0 as usize + whole[1].1, stream.len());
        assert!([1, 319, 320, 5000].into_iter().all(|size| phrases(size) == whole));
    }

    #[test]
    fn silence_is_dropped() {
        let mut phrases = Phrases::default();
        for _ in 0..3600 {
            phrases
                .push(&[1e-4; RATE as usize], 0.002, |_, step| match step {
                    Step::Silence => Ok(()),
                    other => Err(other),
                })
                .unwrap();
            assert!(phrases.sound.capacity() < 2 * RATE as usize);
        }
        assert_eq!(phrases.finish(), None);
    }
}
