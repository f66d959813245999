//! Registers of 32-bit sums, and the products of bytes that are added to them.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod portable;
#[cfg(target_arch = "x86_64")]
mod vnni;

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::Avx2;
pub(super) use portable::Portable;
#[cfg(target_arch = "x86_64")]
pub(super) use vnni::Vnni;

use super::output::Bounds;
use crate::isa::{Isa, Set};

/// Width of the widest register, in sums.
pub(super) const MAX_WIDTH: usize = 16;

/// A register of 32-bit integers.
///
/// Factors are words of 32 bits. With [`Dots::TAPS`] of four a word has four unsigned bytes of the input or four signed
/// bytes of the weights; with two it has two 16-bit integers, from which zero points have been subtracted. The sums are
/// exact (modulo 2^32), and the same in both.
///
/// # Safety
/// Every function needs the instruction set of its type, enabled in the function that it is inlined into; pointers need
/// [`Dots::WIDTH`] words, or as many bytes as stated, of any alignment.
pub(super) trait Dots: Copy {
    /// Sums in a register.
    const WIDTH: usize;
    /// Products per sum and step.
    const TAPS: usize;
    /// Registers across a tile, at most.
    const VECTORS: usize;
    /// Neighbouring output pixels of a depthwise convolution that are computed together.
    const PIXELS: usize;

    unsafe fn splat(value: i32) -> Self;
    unsafe fn load(from: *const i32) -> Self;
    /// Adds the products of the parts of each word.
    unsafe fn dot(self, x: Self, weights: Self) -> Self;
    /// Returns `self + other`.
    unsafe fn add(self, other: Self) -> Self;
    /// Returns `self + factor * other`.
    unsafe fn add_multiple(self, factor: i32, other: Self) -> Self;
    unsafe fn store(self, to: *mut i32);
    /// Stores the first `count` sums as bytes: `round(sum * scale) + zero` within the bounds.
    unsafe fn store_bytes(self, scales: *const f32, bounds: &Bounds, to: *mut u8, count: usize);
    /// Returns the sum of `count` unsigned bytes.
    #[inline(always)]
    unsafe fn sum_of_bytes(from: *const u8, count: usize) -> i32 {
        // SAFETY: the trait's contract.
        unsafe { std::slice::from_raw_parts(from, count) }.iter().map(|&byte| i32::from(byte)).sum()
    }
    /// Reads `count` bytes of each row, at most four registers, as words with one part per row; channels are in the
    /// order of [`Dots::channel`]. Bytes are read as `byte ^ flip`, and `zero` is subtracted where parts have 16 bits.
    unsafe fn column(rows: &[*const u8; 4], count: usize, flip: u8, zero: i32) -> [Self; 4];
    /// Stores four registers in the order of [`Dots::column`] as `count` bytes.
    unsafe fn store_column(sums: &[Self; 4], scales: *const f32, bounds: &Bounds, to: *mut u8, count: usize);
    /// Returns the channel of a lane of one of the four registers of a column.
    fn channel(register: usize, lane: usize) -> usize;
}

/// Instructions of the products of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Instructions {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Vnni,
}

impl Instructions {
    /// Returns the best ones of this machine within an instruction set.
    pub(super) fn of(isa: Isa) -> Self {
        match isa.set() {
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 if has_vnni() => Self::Vnni,
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 | Set::Avx2 if is_x86_feature_detected!("avx2") => Self::Avx2,
            _ => Self::Portable,
        }
    }

    pub(super) fn width(self) -> usize {
        match self {
            Self::Portable => Portable::WIDTH,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => Avx2::WIDTH,
            #[cfg(target_arch = "x86_64")]
            Self::Vnni => Vnni::WIDTH,
        }
    }

    pub(super) fn taps(self) -> usize {
        match self {
            Self::Portable => Portable::TAPS,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => Avx2::TAPS,
            #[cfg(target_arch = "x86_64")]
            Self::Vnni => Vnni::TAPS,
        }
    }

    pub(super) fn vectors(self) -> usize {
        match self {
            Self::Portable => Portable::VECTORS,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => Avx2::VECTORS,
            #[cfg(target_arch = "x86_64")]
            Self::Vnni => Vnni::VECTORS,
        }
    }

    pub(super) fn channel(self, register: usize, lane: usize) -> usize {
        match self {
            Self::Portable => Portable::channel(register, lane),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => Avx2::channel(register, lane),
            #[cfg(target_arch = "x86_64")]
            Self::Vnni => Vnni::channel(register, lane),
        }
    }

    /// Returns whether a word has four bytes, and zero points are subtracted from the sums.
    pub(super) fn is_bytes(self) -> bool {
        self.taps() == 4
    }
}

#[cfg(target_arch = "x86_64")]
fn has_vnni() -> bool {
    is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512vnni")
}

/// Defines `unsafe fn name(instructions, arguments)` from `#[inline(always)] unsafe fn body<V: Dots>(arguments)`.
macro_rules! for_all_instructions {
    ($visibility:vis fn $name:ident = $body:ident($($argument:ident: $type:ty),* $(,)?)) => {
        /// # Safety
        /// Those of the body; the machine has the instructions.
        $visibility unsafe fn $name(instructions: $crate::quantized::dots::Instructions, $($argument: $type),*) {
            use $crate::quantized::dots::Instructions;
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2,fma")]
            unsafe fn avx2($($argument: $type),*) {
                // SAFETY: the caller's promise; the instructions are enabled here.
                unsafe { $body::<$crate::quantized::dots::Avx2>($($argument),*) }
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f,avx512bw,avx512vl,avx512vnni")]
            unsafe fn vnni($($argument: $type),*) {
                // SAFETY: the caller's promise; the instructions are enabled here.
                unsafe { $body::<$crate::quantized::dots::Vnni>($($argument),*) }
            }
            // SAFETY: the caller's promise; `Instructions::of` returns those of the machine.
            unsafe {
                match instructions {
                    Instructions::Portable => $body::<$crate::quantized::dots::Portable>($($argument),*),
                    #[cfg(target_arch = "x86_64")]
                    Instructions::Avx2 => avx2($($argument),*),
                    #[cfg(target_arch = "x86_64")]
                    Instructions::Vnni => vnni($($argument),*),
                }
            }
        }
    };
}
pub(super) use for_all_instructions;
