use crate::elementary::exp;
use crate::isa::{Isa, for_every_isa};
use crate::lanes::Lanes;
use crate::unary::erf;
use crate::{Compute, Unary};

/// The Gaussian error linear unit (Hendrycks and Gimpel, 2016): `y = x P(x)`, where P is the distribution function of the normal
/// distribution. It has no parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Gelu;

impl Gelu {
    /// Computes `y` from `x`.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn forward(self, compute: &Compute, x: &[f32], y: &mut [f32]) {
        Unary::Gelu.apply(compute, x, y);
    }

    /// Replaces `dy`, the gradient of the output, by that of `x`.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn backward(self, isa: Isa, x: &[f32], dy: &mut [f32]) {
        assert_eq!(x.len(), dy.len(), "`x` and `dy` must have equal lengths");
        // SAFETY: both slices have this length.
        unsafe { dispatch(isa, x.as_ptr(), dy.as_mut_ptr(), x.len()) }
    }
}

for_every_isa!(fn dispatch = backward_all(x: *const f32, dy: *mut f32, length: usize));

/// # Safety
/// `length` numbers at `x` and at `dy`.
#[inline(always)]
unsafe fn backward_all<V: Lanes>(x: *const f32, dy: *mut f32, length: usize) {
    // SAFETY: whole registers lie within `length`; the rest is counted.
    unsafe {
        let whole = length / V::WIDTH * V::WIDTH;
        for i in (0..whole).step_by(V::WIDTH) {
            slope(V::load(x.add(i))).mul(V::load(dy.add(i))).store(dy.add(i));
        }
        let rest = length - whole;
        if rest > 0 {
            let (x, dy) = (x.add(whole), dy.add(whole));
            slope(V::load_some(x, rest)).mul(V::load_some(dy, rest)).store_some(dy, rest);
        }
    }
}

/// Returns `P(x) + x p(x)`, with the density p.
#[inline(always)]
unsafe fn slope<V: Lanes>(x: V) -> V {
    // SAFETY: the contract of `Lanes`, passed on.
    unsafe {
        const DENSITY_AT_0: f32 = 0.398_942_3;
        let half = V::splat(0.5);
        let distribution = half.mul_add(erf(x.mul(V::splat(std::f32::consts::FRAC_1_SQRT_2))), half);
        let density = exp(x.mul(x).mul(V::splat(-0.5))).mul(V::splat(DENSITY_AT_0));
        x.mul_add(density, distribution)
    }
}
