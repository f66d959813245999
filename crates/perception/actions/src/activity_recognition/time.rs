//! What lies before a frame: the frames of its clip, or what a stream keeps.

use burn::tensor::Tensor;

/// How a network sees time.
pub(super) enum Time {
    /// Clips of as many frames, one after the other.
    Clips(usize),
    /// One frame after the other.
    Stream(Box<Kept>),
    /// Counts the numbers that a stream of clips of so many frames keeps.
    Count { frames: usize, numbers: usize },
}

/// What a stream keeps.
pub(super) struct Kept {
    /// Frames that are averaged.
    pub frames: usize,
    /// What the frame before left, `[1, numbers]`.
    pub state: Tensor<2>,
    /// One, where there was no frame before, else zero: `[1, 1]`.
    pub is_first: Tensor<2>,
    /// Numbers that were taken from `state`.
    pub at: usize,
    /// What the next frame is left.
    pub next: Vec<Tensor<2>>,
}

impl Kept {
    /// What is left over from before, each `size` numbers; before the first frame, the frame itself.
    fn take(&mut self, now: &Tensor<2>, size: usize) -> Tensor<2> {
        let start = self.at;
        self.at += size;
        let past = self.state.clone().slice([0..1, start..self.at]);
        past.clone() + (now.clone() - past) * self.is_first.clone()
    }
}

impl Time {
    /// The sum of `now` and of `earlier`, all `[frames, channels, height, width]`: the first of them one frame late, the
    /// second two, and so on. Before its first frame, a clip stands still.
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

    /// The mean over a clip, of frames `[frames, channels]`.
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
