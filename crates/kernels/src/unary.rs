//! Functions of one number: what a graph applies to a tensor, and what a convolution applies to its sums.

use crate::compute::Compute;
use crate::elementary::{exp, sigmoid, tanh};
use crate::isa::for_every_isa;
use crate::lanes::Lanes;

/// A function that is applied to every number of a tensor. NaN stays NaN.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Unary {
    /// The identity.
    #[default]
    Identity,
    /// `max(0, x)`.
    Relu,
    /// The nearest number from `low` to `high`.
    Clip {
        /// Least result.
        low: f32,
        /// Largest result.
        high: f32,
    },
    /// `x` where it is positive, else `slope * x`.
    LeakyRelu {
        /// Slope of negative numbers.
        slope: f32,
    },
    /// `x * min(max(x + 3, 0), 6) / 6`.
    HardSwish,
    /// `min(max(alpha * x + beta, 0), 1)`.
    HardSigmoid {
        /// Slope.
        alpha: f32,
        /// Offset.
        beta: f32,
    },
    /// 1 / (1 + exp(-x)).
    Sigmoid,
    /// `x / (1 + exp(-x))`.
    Swish,
    /// The hyperbolic tangent.
    Tanh,
    /// The error function, to 2e-7.
    Erf,
    /// `x * (1 + erf(x / sqrt 2)) / 2`.
    Gelu,
    /// The exponential function.
    Exp,
    /// The square root.
    Sqrt,
    /// The absolute value.
    Abs,
    /// `-x`.
    Neg,
    /// `1 / x`.
    Reciprocal,
}

impl Unary {
    /// Applies the function to every number of `x`.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn apply(self, compute: &Compute, x: &[f32], y: &mut [f32]) {
        const PIECE: usize = 1 << 14;
        assert_eq!(x.len(), y.len(), "input and output must have equal lengths");
        let isa = compute.isa();
        compute.pool().run_on_pieces(y, PIECE, |index, y| {
            let x = &x[index * PIECE..][..y.len()];
            // SAFETY: both pointers have this length.
            unsafe { dispatch_unary(isa, self, x.as_ptr(), y.as_mut_ptr(), y.len()) }
        });
    }

    /// Returns one of the short functions of a register; the identity for the others.
    ///
    /// # Safety
    /// The contract of [`Lanes`].
    #[inline(always)]
    pub(crate) unsafe fn of_short<V: Lanes>(self, x: V) -> V {
        // SAFETY: passed on.
        unsafe {
            let zero = V::splat(0.0);
            match self {
                Self::Relu => zero.max(x),
                Self::Clip { low, high } => V::splat(high).min(V::splat(low).max(x)),
                // Of one term at least the other is zero.
                Self::LeakyRelu { slope } => V::splat(slope).mul_add(zero.min(x), zero.max(x)),
                Self::HardSwish => {
                    let gate = V::splat(6.0).min(zero.max(x.add(V::splat(3.0))));
                    x.mul(gate).mul(V::splat(1.0 / 6.0))
                }
                Self::HardSigmoid { alpha, beta } => {
                    V::splat(1.0).min(zero.max(x.mul_add(V::splat(alpha), V::splat(beta))))
                }
                _ => x,
            }
        }
    }

    /// Returns the function of a register.
    ///
    /// # Safety
    /// The contract of [`Lanes`].
    #[inline(always)]
    pub(crate) unsafe fn of<V: Lanes>(self, x: V) -> V {
        // SAFETY: the contract of `Lanes`, passed on.
        unsafe {
            match self {
                Self::Sigmoid => sigmoid(x),
                Self::Swish => x.mul(sigmoid(x)),
                Self::Tanh => tanh(x),
                Self::Erf => erf(x),
                Self::Gelu => {
                    let half = x.mul(V::splat(0.5));
                    half.mul_add(erf(x.mul(V::splat(std::f32::consts::FRAC_1_SQRT_2))), half)
                }
                Self::Exp => exp(x),
                Self::Sqrt => x.sqrt(),
                Self::Abs => x.abs(),
                Self::Neg => V::splat(0.0).sub(x),
                Self::Reciprocal => V::splat(1.0).div(x),
                _ => self.of_short(x),
            }
        }
    }
}

/// erf(x), to 2e-7 (Abramowitz and Stegun, 7.1.26).
#[inline(always)]
pub(crate) unsafe fn erf<V: Lanes>(x: V) -> V {
    // SAFETY: the contract of `Lanes`, passed on.
    unsafe {
        let one = V::splat(1.0);
        let t = one.div(x.abs().mul_add(V::splat(0.327_591_1), one));
        let mut series = V::splat(1.061_405_4);
        for coefficient in [-1.453_152, 1.421_413_8, -0.284_496_74, 0.254_829_6] {
            series = series.mul_add(t, V::splat(coefficient));
        }
        let tail = series.mul(t).mul(exp(V::splat(0.0).sub(x.mul(x))));
        one.sub(tail).with_sign(x)
    }
}

for_every_isa!(
    /// Applies a function to `length` numbers.
    pub(crate) fn dispatch_unary = unary_all(unary: Unary, x: *const f32, y: *mut f32, length: usize)
);

/// # Safety
/// `length` numbers at `x` and at `y`, which are the same or do not overlap.
#[inline(always)]
pub(crate) unsafe fn unary_all<V: Lanes>(unary: Unary, x: *const f32, y: *mut f32, length: usize) {
    // SAFETY: whole registers lie within `length`; the rest is counted.
    unsafe {
        let whole = length / V::WIDTH * V::WIDTH;
        for i in (0..whole).step_by(V::WIDTH) {
            unary.of(V::load(x.add(i))).store(y.add(i));
        }
        let rest = length - whole;
        if rest > 0 {
            unary.of(V::load_some(x.add(whole), rest)).store_some(y.add(whole), rest);
        }
    }
}
