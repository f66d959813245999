use crate::elementary::{sigmoid, tanh};
use crate::isa::{Isa, for_every_isa};
use crate::lanes::Lanes;

/// Activation function of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Activation {
    /// The identity.
    #[default]
    Identity,
    /// `max(0, x)`; NaN stays NaN.
    Relu,
    /// The hyperbolic tangent.
    Tanh,
    /// 1 / (1 + exp(-x)).
    Sigmoid,
}

impl Activation {
    /// Applies the function to every value in place.
    pub fn apply(self, isa: Isa, values: &mut [f32]) {
        // SAFETY: the pointer and the length are those of a slice.
        unsafe { dispatch_apply(isa, self, values.as_mut_ptr(), values.len()) }
    }

    /// Computes the gradient before the activation from the gradient `dy` after it, in place; `y` is the output.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn backward_in_place(self, isa: Isa, y: &[f32], dy: &mut [f32]) {
        assert_eq!(y.len(), dy.len(), "`y` and `dy` must have equal lengths");
        // SAFETY: both slices have this length.
        unsafe { dispatch_backward(isa, self, y.as_ptr(), dy.as_mut_ptr(), y.len()) }
    }

    #[inline(always)]
    pub(crate) unsafe fn of<V: Lanes>(self, x: V) -> V {
        // SAFETY: the contract of `Lanes`, passed on.
        unsafe {
            match self {
                Self::Identity => x,
                Self::Relu => V::splat(0.0).max(x),
                Self::Tanh => tanh(x),
                Self::Sigmoid => sigmoid(x),
            }
        }
    }

    /// Returns the gradient before the activation, from the output and the gradient after it.
    #[inline(always)]
    pub(crate) unsafe fn gradient<V: Lanes>(self, y: V, dy: V) -> V {
        // SAFETY: the contract of `Lanes`, passed on.
        unsafe {
            match self {
                Self::Identity => dy,
                Self::Relu => dy.where_positive(y),
                Self::Tanh => dy.mul(V::splat(1.0).sub(y.mul(y))),
                Self::Sigmoid => dy.mul(y.mul(V::splat(1.0).sub(y))),
            }
        }
    }
}

for_every_isa!(fn dispatch_apply = apply_all(activation: Activation, values: *mut f32, length: usize));
for_every_isa!(
    fn dispatch_backward = backward_all(activation: Activation, y: *const f32, dy: *mut f32, length: usize)
);

/// # Safety
/// `length` numbers at `values`.
#[inline(always)]
pub(crate) unsafe fn apply_all<V: Lanes>(activation: Activation, values: *mut f32, length: usize) {
    if activation == Activation::Identity {
        return;
    }
    // SAFETY: whole registers lie within `length`; the rest is counted.
    unsafe {
        let whole = length / V::WIDTH * V::WIDTH;
        for i in (0..whole).step_by(V::WIDTH) {
            activation.of(V::load(values.add(i))).store(values.add(i));
        }
        let rest = length - whole;
        if rest > 0 {
            activation.of(V::load_some(values.add(whole), rest)).store_some(values.add(whole), rest);
        }
    }
}

/// # Safety
/// `length` numbers at `y` and at `dy`.
#[inline(always)]
unsafe fn backward_all<V: Lanes>(activation: Activation, y: *const f32, dy: *mut f32, length: usize) {
    if activation == Activation::Identity {
        return;
    }
    // SAFETY: whole registers lie within `length`; the rest is counted.
    unsafe {
        let whole = length / V::WIDTH * V::WIDTH;
        for i in (0..whole).step_by(V::WIDTH) {
            activation.gradient(V::load(y.add(i)), V::load(dy.add(i))).store(dy.add(i));
        }
        let rest = length - whole;
        if rest > 0 {
            let (y, dy) = (y.add(whole), dy.add(whole));
            activation.gradient(V::load_some(y, rest), V::load_some(dy, rest)).store_some(dy, rest);
        }
    }
}
