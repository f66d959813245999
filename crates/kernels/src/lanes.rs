//! SIMD registers of any width; the kernels are generic over [`Lanes`].

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
mod portable;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::Avx512;
#[cfg(target_arch = "aarch64")]
pub(crate) use neon::Neon;
pub(crate) use portable::Portable;

/// Width of the widest register, in numbers.
pub(crate) const MAX_WIDTH: usize = 16;

/// A register of single-precision numbers.
///
/// # Safety
/// Every function needs the instruction set of its type, enabled in the function that it is inlined into; `load` and
/// `store` need [`Lanes::WIDTH`] readable or writable numbers, of any alignment.
pub(crate) trait Lanes: Copy {
    /// Numbers in a register.
    const WIDTH: usize;
    /// Rows of a tile of the product; a tile uses most of the available registers.
    const ROWS: usize;
    /// Registers of the instruction set.
    const REGISTERS: usize;

    unsafe fn splat(value: f32) -> Self;
    unsafe fn load(from: *const f32) -> Self;
    unsafe fn store(self, to: *mut f32);
    unsafe fn add(self, other: Self) -> Self;
    unsafe fn sub(self, other: Self) -> Self;
    unsafe fn mul(self, other: Self) -> Self;
    unsafe fn div(self, other: Self) -> Self;
    /// Returns `self * factor + term`, rounded once where the machine supports it.
    unsafe fn mul_add(self, factor: Self, term: Self) -> Self;
    /// Returns the larger one; `other` where one of them is NaN.
    unsafe fn max(self, other: Self) -> Self;
    /// Returns the smaller one; `other` where one of them is NaN.
    unsafe fn min(self, other: Self) -> Self;
    unsafe fn sqrt(self) -> Self;
    unsafe fn abs(self) -> Self;
    /// Returns `self`, which is not negative, with the sign of `sign`.
    unsafe fn with_sign(self, sign: Self) -> Self;
    /// Rounds to the nearest integer, for magnitudes below 2^22.
    unsafe fn round(self) -> Self;
    /// Returns 2 to the power of `self`, an integer from -126 to 127.
    unsafe fn power_of_two(self) -> Self;
    /// Returns `self` where `gate` is positive, else zero.
    unsafe fn where_positive(self, gate: Self) -> Self;

    /// Loads the first `count` numbers, at most a register, and fills up with zeros.
    #[inline(always)]
    unsafe fn load_some(from: *const f32, count: usize) -> Self {
        let mut numbers = [0.0; MAX_WIDTH];
        // SAFETY: the trait's contract, for `count` numbers only.
        unsafe {
            numbers.as_mut_ptr().copy_from_nonoverlapping(from, count);
            Self::load(numbers.as_ptr())
        }
    }

    /// Stores the first `count` numbers, at most a register.
    #[inline(always)]
    unsafe fn store_some(self, to: *mut f32, count: usize) {
        let mut numbers = [0.0; MAX_WIDTH];
        // SAFETY: the trait's contract, for `count` numbers only.
        unsafe {
            self.store(numbers.as_mut_ptr());
            to.copy_from_nonoverlapping(numbers.as_ptr(), count);
        }
    }
}

/// Implements [`Lanes`] from one expression per function.
macro_rules! implement_lanes {
    ($type:ty, width: $width:literal, rows: $rows:literal, registers: $registers:literal,
     $(@some($from:ident, $value:ident, $to:ident, $count:ident): $load_some:expr, $store_some:expr,)?
     $($name:ident($($argument:ident),*) = $body:expr;)*) => {
        impl $crate::lanes::Lanes for $type {
            const WIDTH: usize = $width;
            const ROWS: usize = $rows;
            const REGISTERS: usize = $registers;
            $($crate::lanes::implement_lanes!(@function $name($($argument),*) = $body);)*
            $(
                #[inline(always)]
                #[allow(unused_unsafe)]
                unsafe fn load_some($from: *const f32, $count: usize) -> Self {
                    // SAFETY: the trait's contract.
                    unsafe { $load_some }
                }

                #[inline(always)]
                #[allow(unused_unsafe)]
                unsafe fn store_some(self, $to: *mut f32, $count: usize) {
                    let $value = self;
                    // SAFETY: the trait's contract.
                    unsafe { $store_some }
                }
            )?
        }
    };
    (@function splat($value:ident) = $body:expr) => {
        $crate::lanes::implement_lanes!(@method splat($value: f32) -> Self = $body);
    };
    (@function load($from:ident) = $body:expr) => {
        $crate::lanes::implement_lanes!(@method load($from: *const f32) -> Self = $body);
    };
    (@function store($value:ident, $to:ident) = $body:expr) => {
        #[inline(always)]
        #[allow(unused_unsafe)]
        unsafe fn store(self, $to: *mut f32) {
            let $value = self;
            // SAFETY: the trait's contract.
            unsafe { $body }
        }
    };
    (@function $name:ident($value:ident $(, $other:ident)*) = $body:expr) => {
        #[inline(always)]
        #[allow(unused_unsafe)]
        unsafe fn $name(self $(, $other: Self)*) -> Self {
            let $value = self;
            // SAFETY: the trait's contract.
            unsafe { $body }
        }
    };
    (@method $name:ident($argument:ident: $kind:ty) -> Self = $body:expr) => {
        #[inline(always)]
        #[allow(unused_unsafe)]
        unsafe fn $name($argument: $kind) -> Self {
            // SAFETY: the trait's contract.
            unsafe { $body }
        }
    };
}
pub(crate) use implement_lanes;
