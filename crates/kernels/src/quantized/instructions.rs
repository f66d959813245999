//! Instruction sets of the products of bytes, and functions that exist for each of them.

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

use super::dots::Dots;
use crate::isa::{Isa, Set};

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
        $visibility unsafe fn $name(instructions: $crate::quantized::instructions::Instructions, $($argument: $type),*) {
            use $crate::quantized::instructions::Instructions;
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2,fma")]
            unsafe fn avx2($($argument: $type),*) {
                // SAFETY: the caller's promise; the instructions are enabled here.
                unsafe { $body::<$crate::quantized::instructions::Avx2>($($argument),*) }
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f,avx512bw,avx512vl,avx512vnni")]
            unsafe fn vnni($($argument: $type),*) {
                // SAFETY: the caller's promise; the instructions are enabled here.
                unsafe { $body::<$crate::quantized::instructions::Vnni>($($argument),*) }
            }
            // SAFETY: the caller's promise; `Instructions::of` returns those of the machine.
            unsafe {
                match instructions {
                    Instructions::Portable => $body::<$crate::quantized::instructions::Portable>($($argument),*),
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
