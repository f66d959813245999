//! Limits of the machine, measured: arithmetic and bandwidth of the memory.

use std::hint::black_box;
use std::time::Instant;

use crate::compute::Compute;
use crate::isa::for_every_isa;
use crate::lanes::Lanes;

/// Rounds of a measurement; the fastest one counts, because other programs only add time.
const ROUNDS: usize = 8;
/// Fused multiplications and additions of a register in a round.
const STEPS: usize = 200_000;
/// Independent sums, more than a processor computes at a time, and few enough for 16 registers.
const SUMS: usize = 12;
/// Numbers that are copied in a round: more than caches have.
const NUMBERS: usize = 1 << 24;
/// Numbers that a thread copies at a time.
const PIECE: usize = 1 << 18;

/// Limits of the machine for one instruction set and number of threads, as measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Multiplications and additions of single-precision numbers per second, in registers.
    pub operations_per_s: f64,
    /// Bytes that a copy of an array larger than the caches reads and writes per second.
    pub bytes_per_s: f64,
}

impl Limits {
    /// Measures the limits in some tenths of a second. The result is too low while other programs run.
    pub fn measure(compute: &Compute) -> Self {
        let threads = compute.pool().threads();
        let operations = fastest(|| {
            let mut sums = vec![0.0_f32; threads];
            compute.pool().run_on_pieces(&mut sums, 1, |_, sum| {
                // SAFETY: the body has no contract of its own.
                sum[0] = unsafe { multiply_and_add(compute.isa(), STEPS) };
            });
            black_box(sums);
        });
        let from = vec![1.0_f32; NUMBERS];
        let mut to = vec![0.0_f32; NUMBERS];
        let copy = fastest(|| {
            compute.pool().run_on_pieces(&mut to, PIECE, |index, to| {
                to.copy_from_slice(&from[index * PIECE..][..to.len()]);
            });
            black_box(&to);
        });
        // SAFETY: the body has no contract of its own.
        let width = unsafe { width(compute.isa()) };
        Self {
            operations_per_s: (2 * threads * STEPS * SUMS * width) as f64 / operations,
            bytes_per_s: (2 * NUMBERS * size_of::<f32>()) as f64 / copy,
        }
    }
}

/// Returns the seconds of the fastest of some calls.
fn fastest(mut call: impl FnMut()) -> f64 {
    let round = |_| {
        let start = Instant::now();
        call();
        start.elapsed().as_secs_f64()
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min).max(1e-9)
}

/// Returns a sum that depends on every multiplication.
#[inline(always)]
unsafe fn multiply_and_add_body<V: Lanes>(steps: usize) -> f32 {
    let mut numbers = [0.0; crate::lanes::MAX_WIDTH];
    // SAFETY: the instructions are enabled by the caller, and `numbers` has the widest register.
    unsafe {
        let (factor, term) = (V::splat(black_box(0.5)), V::splat(black_box(1.0)));
        let mut sums = [V::splat(0.0); SUMS];
        for _ in 0..steps {
            for sum in &mut sums {
                *sum = sum.mul_add(factor, term);
            }
        }
        for sum in sums {
            let mut own = [0.0; crate::lanes::MAX_WIDTH];
            sum.store(own.as_mut_ptr());
            numbers.iter_mut().zip(own).for_each(|(number, own)| *number += own);
        }
    }
    numbers.iter().sum()
}

#[inline(always)]
unsafe fn width_body<V: Lanes>() -> usize {
    V::WIDTH
}

for_every_isa! {
    /// Runs a chain of multiplications and additions in each of some registers.
    fn multiply_and_add = multiply_and_add_body(steps: usize) -> f32
}

for_every_isa! {
    /// Returns the numbers of a register.
    fn width = width_body() -> usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_numbers_of_this_machine() {
        let Limits { operations_per_s, bytes_per_s } = Limits::measure(&Compute::with_threads(2));
        assert!(operations_per_s.is_finite() && operations_per_s > 1e8, "{operations_per_s}");
        assert!(bytes_per_s.is_finite() && bytes_per_s > 1e6, "{bytes_per_s}");
    }

    #[test]
    fn every_instruction_set_computes_the_same_chain() {
        let lanes = |isa| {
            // SAFETY: the instruction sets are those of this machine.
            unsafe { multiply_and_add(isa, 100) / (SUMS * width(isa)) as f32 }
        };
        for isa in crate::isa::Isa::available() {
            assert!((lanes(isa) - 2.0).abs() < 1e-4, "{isa}");
        }
    }
}
