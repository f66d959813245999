//! Time context of a frame: the frames of its clip, or the state of a stream.

use burn::tensor::Tensor;

/// Layout of time in a forward pass.
pub(super) enum Time {
    /// Clips of this number of frames, in sequence.
    Clips(usize),
    /// One frame of a stream.
    Stream(Box<Kept>),
    /// Counts the length of the state of a stream with clips of `frames` frames.
    Count { frames: usize, numbers: usize },
}

/// State of a stream during a forward pass.
pub(super) struct Kept {
    /// Number of frames over which features are averaged.
    pub frames: usize,
    /// State after the previous frame, `[1, numbers]`.
    pub state: Tensor<2>,
    /// One for the first frame of a stream, else zero: `[1, 1]`.
    pub is_first: Tensor<2>,
    /// Number of values already taken from `state`.
    pub at: usize,
    /// Parts of the next state.
    pub next: Vec<Tensor<2>>,
}

impl Kept {
    /// Takes the next `size` values of the state; for the first frame of a stream, `now` itself.
    fn take(&mut self, now: &Tensor<2>, size: usize) -> Tensor<2> {
        let start = self.at;
        self.at += size;
        let past = self.state.clone().slice([0..1, start..self.at]);
        past.clone() + (now.clone() - past) * self.is_first.clone()
    }
}

impl Time {
    /// Returns the sum of `now` and `earlier`, all `[frames, channels, height, width]`; the first of `earlier` is delayed by
    /// one frame, the second by two, and so on. The first frame of a clip is repeated for the time before it.
    pub fn sum(&mut self, now: Tensor<4>, earlier: Vec<Tensor<4>>) -> Tensor<4> {
        let shape = now.dims();
        let size = shape[1..].iter().product::<usize>();
        let mut sum = now;
        for (age, tap) in (1..).zip(earlier) {
            match self {
                Self::Clips(frames) => {
                    let tap: Tensor<3> = tap.reshape([shape[0] / *frames, *frames, size]);
                    let clips = shape[0] / *frames;
                    let late = age.min(*frames);
                    let first = tap.clone().slice([0..clips, 0..1, 0..size]);
                    let mut parts = vec![first; late];
                    if *frames > late {
                        parts.push(tap.slice([0..clips, 0..*frames - late, 0..size]));
                    }
                    sum = sum + Tensor::cat(parts, 1).reshape(shape);
                }
                Self::Stream(kept) => {
                    let tap: Tensor<2> = tap.reshape([1, size]);
                    let oldest = kept.take(&tap, size);
                    for _ in 1..age {
                        let past = kept.take(&tap, size);
                        kept.next.push(past);
                    }
                    kept.next.push(tap);
                    sum = sum + oldest.reshape(shape);
                }
                Self::Count { numbers, .. } => *numbers += age * size,
            }
        }
        sum
    }

    /// Returns the mean over each clip of frames `[frames, channels]`.
    pub fn mean(&mut self, now: Tensor<2>) -> Tensor<2> {
        let [count, channels] = now.dims();
        match self {
            Self::Clips(frames) => {
                let clips: Tensor<3> = now.reshape([count / *frames, *frames, channels]);
                clips.mean_dim(1).reshape([count / *frames, channels])
            }
            Self::Stream(kept) => {
                let mut sum = now.clone();
                for index in 1..kept.frames {
                    let past = kept.take(&now, channels);
                    sum = sum + past.clone();
                    if index > 1 {
                        kept.next.push(past);
                    }
                }
                let mean = sum / kept.frames as f32;
                if kept.frames > 1 {
                    kept.next.push(now);
                }
                mean
            }
            Self::Count { frames, numbers } => {
                *numbers += (*frames - 1) * channels;
                now
            }
        }
    }
}
