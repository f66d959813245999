//! Vectorised exp, tanh and logistic function.
//!
//! All three use the series of `exp(r) - 1` for |r| <= ln(2) / 2, so that they are consistent and need no table.

use crate::isa::{Isa, for_every_isa};
use crate::lanes::Lanes;

/// ln 2 in two parts; products of the first with integers below 2^15 are exact.
const LN_2: [f32; 2] = [355.0 / 512.0, -2.121_944_4e-4];

/// Splits `x` into n ln 2 + r and returns n and exp(r) - 1.
#[inline(always)]
unsafe fn reduced_expm1<V: Lanes>(x: V) -> (V, V) {
    // SAFETY: the contract of `Lanes`, passed on.
    unsafe {
        let n = x.mul(V::splat(std::f32::consts::LOG2_E)).round();
        let r = n.mul_add(V::splat(-LN_2[0]), x);
        let r = n.mul_add(V::splat(-LN_2[1]), r);
        let mut series = V::splat(1.0 / 5040.0);
        for coefficient in [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5] {
            series = series.mul_add(r, V::splat(coefficient));
        }
        (n, series.mul(r).mul_add(r, r))
    }
}

/// exp(x): within 2 ulp, denormal results and infinity included; NaN stays NaN.
#[inline(always)]
pub(crate) unsafe fn exp<V: Lanes>(x: V) -> V {
    // SAFETY: the contract of `Lanes`, passed on.
    unsafe {
        let x = V::splat(89.0).min(V::splat(-104.0).max(x));
        let (n, expm1) = reduced_expm1(x);
        // Two steps, because 2^n alone may be too large or too small for a normal number.
        let half = n.mul(V::splat(0.5)).round();
        let scaled = expm1.add(V::splat(1.0)).mul(half.power_of_two());
        scaled.mul(n.sub(half).power_of_two())
    }
}

/// tanh(x): within 4 ulp, odd, never beyond 1; NaN stays NaN.
#[inline(always)]
pub(crate) unsafe fn tanh<V: Lanes>(x: V) -> V {
    // SAFETY: the contract of `Lanes`, passed on.
    unsafe {
        let double = V::splat(20.0).min(x.abs().add(x.abs()));
        let (n, expm1) = reduced_expm1(double);
        let scale = n.power_of_two();
        let t = expm1.mul_add(scale, scale.sub(V::splat(1.0)));
        t.div(t.add(V::splat(2.0))).with_sign(x)
    }
}

/// 1 / (1 + exp(-x)): within 4 ulp above -87, zero below -89; NaN stays NaN.
#[inline(always)]
pub(crate) unsafe fn sigmoid<V: Lanes>(x: V) -> V {
    // SAFETY: the contract of `Lanes`, passed on.
    unsafe {
        let one = V::splat(1.0);
        one.div(one.add(exp(V::splat(0.0).sub(x))))
    }
}

macro_rules! in_place {
    ($(#[$doc:meta])* $name:ident, $dispatch:ident, $body:ident, $function:ident) => {
        $(#[$doc])*
        pub fn $name(isa: Isa, values: &mut [f32]) {
            // SAFETY: the pointer and the length are those of a slice.
            unsafe { $dispatch(isa, values.as_mut_ptr(), values.len()) }
        }

        for_every_isa!(fn $dispatch = $body(values: *mut f32, length: usize));

        #[inline(always)]
        unsafe fn $body<V: Lanes>(values: *mut f32, length: usize) {
            // SAFETY: whole registers lie within `length`; the rest is counted.
            unsafe {
                let whole = length / V::WIDTH * V::WIDTH;
                for i in (0..whole).step_by(V::WIDTH) {
                    $function(V::load(values.add(i))).store(values.add(i));
                }
                let rest = length - whole;
                if rest > 0 {
                    $function(V::load_some(values.add(whole), rest)).store_some(values.add(whole), rest);
                }
            }
        }
    };
}

in_place! {
    /// Computes exp of every value: within 2 units in the last place, denormal results and infinity included; NaN
    /// stays NaN.
    exp_in_place, dispatch_exp, exp_all, exp
}
in_place! {
    /// Computes tanh of every value: within 4 units in the last place, odd, absolute value at most 1; NaN stays NaN.
    tanh_in_place, dispatch_tanh, tanh_all, tanh
}
in_place! {
    /// Computes the logistic function 1 / (1 + exp(-x)) of every value: within 4 units in the last place above -87,
    /// zero below -89; NaN stays NaN.
    sigmoid_in_place, dispatch_sigmoid, sigmoid_all, sigmoid
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the distance from the exact value in units in the last place.
    fn ulp(value: f32, exact: f64) -> f64 {
        let rounded = exact as f32;
        if value == rounded {
            return 0.0;
        }
        let exponent = exact.abs().log2().floor().max(-126.0) as i32;
        (f64::from(value) - exact).abs() / 2f64.powi(exponent - 23)
    }

    /// Returns values of every sign and exponent: each 4093rd bit pattern.
    fn sweep() -> Vec<f32> {
        (0..=u32::MAX).step_by(4093).map(f32::from_bits).filter(|x| x.is_finite()).collect()
    }

    fn worst(function: fn(Isa, &mut [f32]), exact: fn(f64) -> f64, keep: fn(f32) -> bool) -> (f64, f32) {
        let inputs: Vec<f32> = sweep().into_iter().filter(|&x| keep(x)).collect();
        let mut worst = (0.0, 0.0);
        for isa in Isa::available() {
            let mut values = inputs.clone();
            function(isa, &mut values);
            for (&x, &y) in inputs.iter().zip(&values) {
                let error = ulp(y, exact(f64::from(x)));
                if error.is_nan() || error > worst.0 {
                    worst = (error, x);
                }
            }
        }
        worst
    }

    #[test]
    fn exp_is_within_two_ulp() {
        let (error, x) = worst(exp_in_place, f64::exp, |_| true);
        assert!(error <= 2.0, "{error} at {x:e}");
    }

    #[test]
    fn tanh_is_within_four_ulp() {
        let (error, x) = worst(tanh_in_place, f64::tanh, |_| true);
        assert!(error <= 4.0, "{error} at {x:e}");
    }

    #[test]
    fn sigmoid_is_within_four_ulp() {
        let (error, x) = worst(sigmoid_in_place, |x| 1.0 / (1.0 + (-x).exp()), |x| x > -87.0);
        assert!(error <= 4.0, "{error} at {x:e}");
    }

    #[test]
    fn ends_of_the_range() {
        for isa in Isa::available() {
            let all = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 0.0, -0.0];
            let (mut e, mut t, mut s) = (all, all, all);
            exp_in_place(isa, &mut e);
            tanh_in_place(isa, &mut t);
            sigmoid_in_place(isa, &mut s);
            assert_eq!((e[0], e[1], e[3], e[4]), (f32::INFINITY, 0.0, 1.0, 1.0), "{isa}");
            assert_eq!((t[0], t[1]), (1.0, -1.0), "{isa}");
            assert_eq!((t[3].to_bits(), t[4].to_bits()), (0, (-0.0f32).to_bits()), "{isa}");
            assert_eq!((s[0], s[1], s[3], s[4]), (1.0, 0.0, 0.5, 0.5), "{isa}");
            assert!(e[2].is_nan() && t[2].is_nan() && s[2].is_nan(), "{isa}");
        }
    }
}
