use crate::quantized::dots::Dots;
use crate::quantized::output::Bounds;

const WIDTH: usize = 8;

/// Eight sums in plain Rust.
#[derive(Clone, Copy)]
pub(in crate::quantized) struct Portable([i32; WIDTH]);

/// Returns the two 16-bit parts of a word.
#[inline(always)]
fn parts(word: i32) -> [i32; 2] {
    [i32::from(word as i16), word >> 16]
}

impl Dots for Portable {
    const WIDTH: usize = WIDTH;
    const TAPS: usize = 2;
    const VECTORS: usize = 2;
    const PIXELS: usize = 1;

    #[inline(always)]
    unsafe fn splat(value: i32) -> Self {
        Self([value; WIDTH])
    }

    #[inline(always)]
    unsafe fn load(from: *const i32) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { from.cast::<[i32; WIDTH]>().read_unaligned() })
    }

    #[inline(always)]
    unsafe fn dot(self, x: Self, weights: Self) -> Self {
        Self(std::array::from_fn(|i| {
            let ([x, next_x], [weight, next_weight]) = (parts(x.0[i]), parts(weights.0[i]));
            self.0[i].wrapping_add(x.wrapping_mul(weight)).wrapping_add(next_x.wrapping_mul(next_weight))
        }))
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].wrapping_add(other.0[i])))
    }

    #[inline(always)]
    unsafe fn add_multiple(self, factor: i32, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].wrapping_add(factor.wrapping_mul(other.0[i]))))
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut i32) {
        // SAFETY: the trait's contract.
        unsafe { to.cast::<[i32; WIDTH]>().write_unaligned(self.0) }
    }

    #[inline(always)]
    unsafe fn store_bytes(self, scales: *const f32, bounds: &Bounds, to: *mut u8, count: usize) {
        for (i, &sum) in self.0.iter().enumerate().take(count) {
            // SAFETY: the trait's contract.
            unsafe { *to.add(i) = bounds.byte(sum, *scales.add(i)) }
        }
    }

    #[inline(always)]
    unsafe fn column(rows: &[*const u8; 4], count: usize, flip: u8, zero: i32) -> [Self; 4] {
        std::array::from_fn(|register| {
            Self(std::array::from_fn(|lane| {
                let at = register * WIDTH + lane;
                // SAFETY: the trait's contract, for `count` bytes only.
                let part = |row: *const u8| unsafe {
                    if at < count { i32::from(*row.add(at) ^ flip) - zero } else { 0 }
                };
                (part(rows[0]) & 0xffff) | (part(rows[1]) << 16)
            }))
        })
    }

    #[inline(always)]
    unsafe fn store_column(sums: &[Self; 4], scales: *const f32, bounds: &Bounds, to: *mut u8, count: usize) {
        for (register, sums) in sums.iter().enumerate() {
            let at = register * WIDTH;
            // SAFETY: the trait's contract.
            unsafe {
                sums.store_bytes(
                    scales.wrapping_add(at),
                    bounds,
                    to.wrapping_add(at),
                    count.saturating_sub(at),
                );
            }
        }
    }

    fn channel(register: usize, lane: usize) -> usize {
        register * WIDTH + lane
    }
}
