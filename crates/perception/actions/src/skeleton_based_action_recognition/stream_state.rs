//! The state of a stream during the forward pass of one frame.

use burn::tensor::Tensor;

/// Values that the frames before left in a state `[1, numbers]`, and those for the next frame.
pub(super) struct StreamState {
    state: Tensor<2>,
    /// Number of values already taken from `state`.
    taken: usize,
    next: Vec<Tensor<2>>,
}

impl StreamState {
    /// Creates the state before a frame.
    pub fn new(state: Tensor<2>) -> Self {
        Self { state, taken: 0, next: Vec::new() }
    }

    /// Returns the last `before` frames and `frame`, `[1, channels, before + 1, joints]`; they are kept for the next frame but
    /// for the oldest.
    pub fn window(&mut self, frame: Tensor<4>, before: usize) -> Tensor<4> {
        if before == 0 {
            return frame;
        }
        let [_, channels, _, joints] = frame.dims();
        let past = self.take(channels * before * joints).reshape([1, channels, before, joints]);
        let window = Tensor::cat(vec![past, frame], 2);
        let next = window.clone().slice([0..1, 0..channels, 1..before + 1, 0..joints]);
        self.next.push(next.reshape([1, channels * before * joints]));
        window
    }

    /// Returns the number of values that are not yet taken.
    pub fn rest(&self) -> usize {
        self.state.dims()[1] - self.taken
    }

    /// Returns the state for the next frame.
    pub fn next(self) -> Tensor<2> {
        Tensor::cat(self.next, 1)
    }

    fn take(&mut self, count: usize) -> Tensor<2> {
        let start = self.taken;
        self.taken += count;
        self.state.clone().slice([0..1, start..self.taken])
    }
}
