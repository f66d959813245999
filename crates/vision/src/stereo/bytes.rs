//! SIMD registers of bytes; the path kernels are generic over [`Bytes`].

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

/// A register of unsigned bytes.
///
/// # Safety
/// Every function needs the instruction set of its type, enabled in the function that it is inlined into; memory that
/// is loaded, stored or added to must have [`Bytes::COUNT`] elements.
pub(super) trait Bytes: Copy {
    /// Number of bytes.
    const COUNT: usize;

    unsafe fn splat(value: u8) -> Self;
    unsafe fn load(from: *const u8) -> Self;
    unsafe fn store(self, to: *mut u8);
    unsafe fn min(self, other: Self) -> Self;
    unsafe fn add(self, other: Self) -> Self;
    unsafe fn sub(self, other: Self) -> Self;
    /// Returns the sum, at most 255.
    unsafe fn saturating_add(self, other: Self) -> Self;
    /// Returns the minimum of the bytes.
    unsafe fn lowest(self) -> u8;
    /// Widens the bytes to 16 bits and writes them, or adds them to the words in memory.
    unsafe fn widen<const IS_FIRST: bool>(self, to: *mut u16);
}

/// Implements [`Bytes`] by one expression for each function.
macro_rules! implement_bytes {
    ($type:ty, $count:literal, splat($value:ident) = $splat:expr; load($from:ident) = $load:expr;
     store($stored:ident, $to:ident) = $store:expr; lowest($all:ident) = $lowest:expr;
     widen($wide:ident, $words:ident, $is_first:ident) = $widen:expr; $($name:ident($a:ident, $b:ident) = $body:expr;)*) => {
        impl Bytes for $type {
            const COUNT: usize = $count;

            #[inline(always)]
            unsafe fn splat($value: u8) -> Self {
                // SAFETY: the trait's contract.
                unsafe { $splat }
            }

            #[inline(always)]
            unsafe fn load($from: *const u8) -> Self {
                // SAFETY: the trait's contract.
                unsafe { $load }
            }

            #[inline(always)]
            unsafe fn store(self, $to: *mut u8) {
                let $stored = self;
                // SAFETY: the trait's contract.
                unsafe { $store }
            }

            $(#[inline(always)]
            unsafe fn $name(self, $b: Self) -> Self {
                let $a = self;
                // SAFETY: the trait's contract.
                unsafe { $body }
            })*

            #[inline(always)]
            unsafe fn lowest(self) -> u8 {
                let $all = self;
                // SAFETY: the trait's contract.
                unsafe { $lowest }
            }

            #[inline(always)]
            unsafe fn widen<const IS_FIRST: bool>(self, $words: *mut u16) {
                let ($wide, $is_first) = (self, IS_FIRST);
                // SAFETY: the trait's contract.
                unsafe { $widen }
            }
        }
    };
}

/// Sixteen bytes on any machine.
#[cfg(any(test, not(target_arch = "x86_64")))]
#[derive(Clone, Copy)]
pub(super) struct Portable([u8; 16]);

#[cfg(any(test, not(target_arch = "x86_64")))]
impl Portable {
    #[inline(always)]
    fn with(self, other: Self, of: impl Fn(u8, u8) -> u8) -> Self {
        Self(std::array::from_fn(|at| of(self.0[at], other.0[at])))
    }
}

#[cfg(any(test, not(target_arch = "x86_64")))]
#[allow(unused_unsafe)]
mod portable {
    use super::{Bytes, Portable};

    implement_bytes! {
        Portable, 16,
        splat(value) = Self([value; 16]);
        load(from) = Self(from.cast::<[u8; 16]>().read());
        store(value, to) = to.cast::<[u8; 16]>().write(value.0);
        lowest(all) = all.0.into_iter().fold(u8::MAX, u8::min);
        widen(value, to, is_first) = for (at, byte) in value.0.into_iter().enumerate() {
            let to = to.add(at);
            *to = u16::from(byte) + if is_first { 0 } else { *to };
        };
        min(a, b) = a.with(b, u8::min);
        add(a, b) = a.with(b, u8::wrapping_add);
        sub(a, b) = a.with(b, u8::wrapping_sub);
        saturating_add(a, b) = a.with(b, u8::saturating_add);
    }
}

/// Sixteen bytes in an SSE2 register, which every x86-64 CPU has.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(super) struct Sse2(__m128i);

#[cfg(target_arch = "x86_64")]
implement_bytes! {
    Sse2, 16,
    splat(value) = Self(_mm_set1_epi8(value.cast_signed()));
    load(from) = Self(_mm_loadu_si128(from.cast()));
    store(value, to) = _mm_storeu_si128(to.cast(), value.0);
    lowest(all) = {
        let half = _mm_min_epu8(all.0, _mm_srli_si128::<8>(all.0));
        let quarter = _mm_min_epu8(half, _mm_srli_si128::<4>(half));
        let eighth = _mm_min_epu8(quarter, _mm_srli_si128::<2>(quarter));
        _mm_cvtsi128_si32(_mm_min_epu8(eighth, _mm_srli_si128::<1>(eighth))) as u8
    };
    widen(value, to, is_first) = {
        let zero = _mm_setzero_si128();
        let halves = [_mm_unpacklo_epi8(value.0, zero), _mm_unpackhi_epi8(value.0, zero)];
        for (at, words) in halves.into_iter().enumerate() {
            let to = to.add(8 * at).cast();
            _mm_storeu_si128(to, if is_first { words } else { _mm_add_epi16(words, _mm_loadu_si128(to)) });
        }
    };
    min(a, b) = Self(_mm_min_epu8(a.0, b.0));
    add(a, b) = Self(_mm_add_epi8(a.0, b.0));
    sub(a, b) = Self(_mm_sub_epi8(a.0, b.0));
    saturating_add(a, b) = Self(_mm_adds_epu8(a.0, b.0));
}

/// Thirty-two bytes in an AVX2 register.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(super) struct Avx2(__m256i);

#[cfg(target_arch = "x86_64")]
implement_bytes! {
    Avx2, 32,
    splat(value) = Self(_mm256_set1_epi8(value.cast_signed()));
    load(from) = Self(_mm256_loadu_si256(from.cast()));
    store(value, to) = _mm256_storeu_si256(to.cast(), value.0);
    lowest(all) = {
        let high = _mm256_extracti128_si256::<1>(all.0);
        Sse2(_mm_min_epu8(_mm256_castsi256_si128(all.0), high)).lowest()
    };
    widen(value, to, is_first) = {
        let halves = [_mm256_castsi256_si128(value.0), _mm256_extracti128_si256::<1>(value.0)];
        for (at, half) in halves.into_iter().enumerate() {
            let (to, words) = (to.add(16 * at).cast(), _mm256_cvtepu8_epi16(half));
            _mm256_storeu_si256(to, if is_first { words } else { _mm256_add_epi16(words, _mm256_loadu_si256(to)) });
        }
    };
    min(a, b) = Self(_mm256_min_epu8(a.0, b.0));
    add(a, b) = Self(_mm256_add_epi8(a.0, b.0));
    sub(a, b) = Self(_mm256_sub_epi8(a.0, b.0));
    saturating_add(a, b) = Self(_mm256_adds_epu8(a.0, b.0));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test values for two registers and for the sums, for any width.
    fn numbers(count: usize) -> [Vec<u8>; 2] {
        [7_u32, 13].map(|step| (0..count as u32).map(|at| (at * at * step + 91 * at + step) as u8).collect())
    }

    fn check<B: Bytes>() {
        let [a, b] = numbers(B::COUNT);
        let (mut out, mut sums) = (vec![0; B::COUNT], vec![7_u16; B::COUNT]);
        let each = |of: fn(u8, u8) -> u8| a.iter().zip(&b).map(|(a, b)| of(*a, *b)).collect::<Vec<u8>>();
        // SAFETY: the caller has checked the CPU features; all slices have `COUNT` elements.
        unsafe {
            let (x, y) = (B::load(a.as_ptr()), B::load(b.as_ptr()));
            let results = [
                (x.min(y), each(u8::min)),
                (x.add(y), each(u8::wrapping_add)),
                (x.sub(y), each(u8::wrapping_sub)),
                (x.saturating_add(y), each(u8::saturating_add)),
                (B::splat(200), vec![200; B::COUNT]),
            ];
            for (got, wanted) in results {
                got.store(out.as_mut_ptr());
                assert_eq!(out, wanted);
                assert_eq!(got.lowest(), wanted.into_iter().fold(u8::MAX, u8::min));
            }
            x.widen::<false>(sums.as_mut_ptr());
            assert!(sums.iter().zip(&a).all(|(sum, a)| *sum == u16::from(*a) + 7));
            y.widen::<true>(sums.as_mut_ptr());
            assert!(sums.iter().zip(&b).all(|(sum, b)| *sum == u16::from(*b)));
        }
    }

    #[test]
    fn all_register_types_agree() {
        check::<Portable>();
        #[cfg(target_arch = "x86_64")]
        {
            check::<Sse2>();
            if is_x86_feature_detected!("avx2") {
                check::<Avx2>();
            }
        }
    }
}
