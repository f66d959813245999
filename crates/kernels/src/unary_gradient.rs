//! Gradients of activation functions, and the activation of a sum.

use crate::aligned::{Output, written};
use crate::compute::Compute;
use crate::elementary::{sigmoid, tanh};
use crate::isa::for_every_isa;
use crate::lanes::Lanes;
use crate::unary::Unary;

/// Numbers that a thread computes at a time.
const PIECE: usize = 1 << 14;

impl Unary {
    /// Returns whether [`Unary::backward`] knows the gradient.
    pub fn is_differentiable(self) -> bool {
        matches!(
            self,
            Self::Identity
                | Self::Relu
                | Self::Clip { .. }
                | Self::LeakyRelu { .. }
                | Self::HardSwish
                | Self::Sigmoid
                | Self::Swish
                | Self::Tanh
        )
    }

    /// Replaces the gradient of the output by that of the input `x`. At a kink it is that of the side where it is zero.
    ///
    /// # Panics
    /// When the lengths differ, or the function is not differentiable here.
    pub fn backward(self, compute: &Compute, x: &[f32], dy: &mut [f32]) {
        assert_eq!(x.len(), dy.len(), "both must have equal lengths");
        assert!(self.is_differentiable(), "{self:?} has no gradient");
        let isa = compute.isa();
        compute.pool().run_on_pieces(dy, PIECE, |index, dy| {
            let x = &x[index * PIECE..][..dy.len()];
            // SAFETY: the slices have equal lengths.
            unsafe { dispatch_backward(isa, self, x, dy) }
        });
    }

    /// Returns the gradient of `x` from that of the output, for the functions that are differentiable.
    ///
    /// # Safety
    /// The contract of [`Lanes`].
    #[inline(always)]
    pub(crate) unsafe fn backward_of<V: Lanes>(self, x: V, dy: V) -> V {
        // SAFETY: passed on.
        unsafe {
            let one = V::splat(1.0);
            match self {
                Self::Relu => dy.where_positive(x),
                Self::Clip { low, high } => {
                    dy.where_positive(x.sub(V::splat(low))).where_positive(V::splat(high).sub(x))
                }
                Self::LeakyRelu { slope } => {
                    let part = dy.mul(V::splat(slope));
                    part.add(dy.sub(part).where_positive(x))
                }
                Self::HardSwish => {
                    let three = V::splat(3.0);
                    let slope = x.mul_add(V::splat(1.0 / 3.0), V::splat(0.5));
                    let slope = slope.add(one.sub(slope).where_positive(x.sub(three)));
                    dy.mul(slope.where_positive(x.add(three)))
                }
                Self::Sigmoid => {
                    let y = sigmoid(x);
                    dy.mul(y.mul(one.sub(y)))
                }
                Self::Swish => {
                    let y = sigmoid(x);
                    dy.mul(y.mul(x.mul_add(one.sub(y), one)))
                }
                Self::Tanh => {
                    let y = tanh(x);
                    dy.mul(one.sub(y.mul(y)))
                }
                _ => dy,
            }
        }
    }
}

/// Returns the activation of the sum of two tensors.
///
/// # Panics
/// When the lengths differ.
pub fn add_activated(compute: &Compute, left: &[f32], right: &[f32], activation: Unary) -> Vec<f32> {
    assert_eq!(left.len(), right.len(), "both must have equal lengths");
    let length = left.len();
    // SAFETY: the pieces write every number.
    unsafe {
        written(length, |to| {
            let to = Output(to);
            compute.pool().run(length.div_ceil(PIECE), |index| {
                let range = index * PIECE..length.min((index + 1) * PIECE);
                let to = to.at(range.start);
                dispatch_sum(compute.isa(), activation, &left[range.clone()], &right[range], to);
            });
        })
        .0
    }
}

for_every_isa!(fn dispatch_sum = sum_all(unary: Unary, left: &[f32], right: &[f32], to: *mut f32));

/// # Safety
/// The slices have equal lengths, which can be written.
#[inline(always)]
unsafe fn sum_all<V: Lanes>(unary: Unary, left: &[f32], right: &[f32], to: *mut f32) {
    for at in (0..left.len()).step_by(V::WIDTH) {
        let count = (left.len() - at).min(V::WIDTH);
        // SAFETY: `count` numbers lie behind `at`.
        unsafe {
            let (left, right, to) = (left.as_ptr().add(at), right.as_ptr().add(at), to.add(at));
            if count == V::WIDTH {
                unary.of(V::load(left).add(V::load(right))).store(to);
            } else {
                let sum = V::load_some(left, count).add(V::load_some(right, count));
                unary.of(sum).store_some(to, count);
            }
        }
    }
}

for_every_isa!(fn dispatch_backward = backward_all(unary: Unary, x: &[f32], dy: &mut [f32]));

/// # Safety
/// The slices have equal lengths.
#[inline(always)]
unsafe fn backward_all<V: Lanes>(unary: Unary, x: &[f32], dy: &mut [f32]) {
    let length = dy.len();
    for at in (0..length).step_by(V::WIDTH) {
        let count = (length - at).min(V::WIDTH);
        // SAFETY: `count` numbers lie behind `at`.
        unsafe {
            let (x, dy) = (x.as_ptr().add(at), dy.as_mut_ptr().add(at));
            if count == V::WIDTH {
                unary.backward_of(V::load(x), V::load(dy)).store(dy);
            } else {
                let value = unary.backward_of(V::load_some(x, count), V::load_some(dy, count));
                value.store_some(dy, count);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::isa::Isa;
    use crate::pool::WorkerPool;

    #[test]
    fn sums_are_activated() {
        let (left, right): (Vec<f32>, Vec<f32>) =
            (0..40_003).map(|i| ((i % 17) as f32 - 8.0, (i % 5) as f32 - 2.5)).unzip();
        for isa in Isa::available() {
            let compute = Compute::new(isa, Arc::new(WorkerPool::new(2)));
            let sums = add_activated(&compute, &left, &right, Unary::Relu);
            let wanted: Vec<f32> = left.iter().zip(&right).map(|(a, b)| (a + b).max(0.0)).collect();
            assert_eq!(sums, wanted);
        }
    }

    #[test]
    fn gradients_are_the_slopes_of_the_functions() {
        let functions = [
            Unary::Identity,
            Unary::Relu,
            Unary::Clip { low: -0.5, high: 2.0 },
            Unary::LeakyRelu { slope: 0.1 },
            Unary::HardSwish,
            Unary::Sigmoid,
            Unary::Swish,
            Unary::Tanh,
        ];
        // No number is a kink.
        let x: Vec<f32> = (0..1003).map(|i| (i as f32 - 500.3) / 97.0).collect();
        let dy: Vec<f32> = (0..1003).map(|i| (i % 7) as f32 - 3.0).collect();
        for function in functions {
            let slope = |x: f32| {
                let step = 1e-3;
                let (mut from, mut to) = (vec![x - step, x + step], vec![0.0; 2]);
                function.apply(&Compute::single(), &from, &mut to);
                from.swap(0, 1);
                (to[1] - to[0]) / (from[0] - from[1])
            };
            for isa in Isa::available() {
                let compute = Compute::new(isa, Arc::new(WorkerPool::new(2)));
                let mut dx = dy.clone();
                function.backward(&compute, &x, &mut dx);
                for ((x, dy), dx) in x.iter().zip(&dy).zip(dx) {
                    let wanted = slope(*x) * dy;
                    assert!((dx - wanted).abs() < 6e-3, "{function:?} of {x}, {isa}: {dx}, not {wanted}");
                }
            }
        }
    }
}
