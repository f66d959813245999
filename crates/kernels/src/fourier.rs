//! Fourier transform of real samples, of any even size, for several frames at once.
//!
//! A register contains the same sample of several frames, so that no values move within a register. Stockham's form:
//! every stage reads one array and writes the other, without reordering. Radix 4 and 2 have their own butterflies (a
//! window of 40 ms at 16 kHz has 640 samples, 2^7 * 5).

use std::f64::consts::TAU;

use crate::isa::{Isa, for_every_isa};
use crate::lanes::Lanes;

/// Number of frames that [`RealFourier`] transforms at once.
pub const FOURIER_FRAMES: usize = 16;

/// The same number of each frame.
type Frames = [f32; FOURIER_FRAMES];

/// A complex number shared by all frames.
type Complex = [f32; 2];

/// Output of [`RealFourier`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spectrum {
    /// Absolute value of each frequency.
    Magnitude,
    /// Squared absolute value of each frequency.
    Power,
}

/// A transform of one size, of [`FOURIER_FRAMES`] frames at once.
///
/// ```
/// use opendr_kernels::{FOURIER_FRAMES, FourierScratch, Isa, RealFourier, Spectrum};
///
/// let fourier = RealFourier::new(8);
/// let samples = [[1.0; FOURIER_FRAMES]; 8];
/// let mut power = Vec::new();
/// fourier.run(Isa::best(), Spectrum::Power, &samples, &mut FourierScratch::default(), &mut power);
/// assert_eq!(power.len(), 5);
/// assert!(power[0][0] == 64.0 && power[1..].iter().all(|frames| frames[0] < 1e-6));
/// ```
#[derive(Debug)]
pub struct RealFourier {
    size: usize,
    stages: Vec<Stage>,
    /// `exp(-2πi k / size)` for the first `size / 2 + 1` frequencies.
    turns: Vec<Complex>,
}

/// Work memory of [`RealFourier::run`]; reusing it avoids allocations.
#[derive(Debug, Default)]
pub struct FourierScratch {
    from: Vec<Frames>,
    to: Vec<Frames>,
}

/// A stage: `count` transforms of `radix` points for each of `stride` interleaved series.
#[derive(Debug)]
struct Stage {
    radix: usize,
    count: usize,
    stride: usize,
    /// `exp(-2πi p j / (radix * count))` at `j * count + p`.
    twiddles: Vec<Complex>,
    /// `exp(-2πi j / radix)`.
    roots: Vec<Complex>,
}

/// Returns `exp(-i angle(k))` for each index `k` below `count`.
fn turns(count: usize, angle: impl Fn(usize) -> f64) -> Vec<Complex> {
    (0..count).map(|at| [angle(at).cos() as f32, -angle(at).sin() as f32]).collect()
}

impl RealFourier {
    /// Creates a transform of `size` samples.
    ///
    /// # Panics
    /// When `size` is zero or odd.
    pub fn new(size: usize) -> Self {
        assert!(
            size > 0 && size.is_multiple_of(2),
            "a transform of {size} samples is not supported; use an even number"
        );
        let (mut rest, mut stride, mut stages) = (size / 2, 1, Vec::new());
        while rest > 1 {
            let factors = [4, 2].into_iter().chain((3..).step_by(2));
            let radix = factors.into_iter().find(|radix| rest.is_multiple_of(*radix)).unwrap_or(rest);
            rest /= radix;
            let whole = (radix * rest) as f64;
            stages.push(Stage {
                radix,
                count: rest,
                stride,
                twiddles: turns(radix * rest, |at| TAU * ((at / rest) * (at % rest)) as f64 / whole),
                roots: turns(radix, |at| TAU * at as f64 / radix as f64),
            });
            stride *= radix;
        }
        let turns = turns(size / 2 + 1, |at| TAU * at as f64 / size as f64);
        Self { size, stages, turns }
    }

    /// Returns the number of samples of the transform.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Replaces `values` by the magnitude or the power of each of the `size / 2 + 1` frequencies.
    ///
    /// # Panics
    /// When the number of `samples` is not `size`.
    pub fn run(
        &self,
        isa: Isa,
        kind: Spectrum,
        samples: &[[f32; FOURIER_FRAMES]],
        work: &mut FourierScratch,
        values: &mut Vec<[f32; FOURIER_FRAMES]>,
    ) {
        assert_eq!(samples.len(), self.size, "`samples` must have the size of the transform");
        let FourierScratch { from, to } = work;
        from.resize(self.size, Frames::default());
        to.resize(self.size, Frames::default());
        values.resize(self.size / 2 + 1, Frames::default());
        // Even samples are the real parts, odd samples the imaginary parts: one transform of half the size computes
        // both.
        let mut given = samples.as_ptr();
        for stage in &self.stages {
            // SAFETY: both are `size` numbers of each frame, half as many complex ones, and do not overlap.
            unsafe { dispatch_stage(isa, stage, given.cast(), to.as_mut_ptr().cast()) };
            std::mem::swap(from, to);
            given = from.as_ptr();
        }
        // SAFETY: `given` has `size` numbers of each frame, `turns` and `values` one for each of `size / 2 + 1` frequencies.
        unsafe { dispatch_spectrum(isa, kind, given.cast(), &self.turns, values.as_mut_ptr().cast()) };
    }
}

for_every_isa!(
    fn dispatch_stage = run_stage(stage: &Stage, from: *const f32, to: *mut f32)
);
for_every_isa!(
    fn dispatch_spectrum = spectrum_of_pairs(kind: Spectrum, pairs: *const f32, turns: &[Complex], values: *mut f32)
);

/// Complex numbers of as many frames as a register has lanes.
#[derive(Clone, Copy)]
struct Pair<V> {
    re: V,
    im: V,
}

/// # Safety
/// That of [`Lanes`]; the pointers of `load` and `store` are to complex numbers of all frames, of which `frame` is the first of
/// a register.
impl<V: Lanes> Pair<V> {
    #[inline(always)]
    unsafe fn load(from: *const f32, index: usize, frame: usize) -> Self {
        // SAFETY: the contract.
        unsafe {
            let re = from.add(2 * index * FOURIER_FRAMES + frame);
            Self { re: V::load(re), im: V::load(re.add(FOURIER_FRAMES)) }
        }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32, index: usize, frame: usize) {
        // SAFETY: the contract.
        unsafe {
            let re = to.add(2 * index * FOURIER_FRAMES + frame);
            self.re.store(re);
            self.im.store(re.add(FOURIER_FRAMES));
        }
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        // SAFETY: the contract.
        unsafe { Self { re: self.re.add(other.re), im: self.im.add(other.im) } }
    }

    #[inline(always)]
    unsafe fn sub(self, other: Self) -> Self {
        // SAFETY: the contract.
        unsafe { Self { re: self.re.sub(other.re), im: self.im.sub(other.im) } }
    }

    /// Returns the product with -i.
    #[inline(always)]
    unsafe fn turned_back(self) -> Self {
        // SAFETY: the contract.
        unsafe { Self { re: self.im, im: V::splat(0.0).sub(self.re) } }
    }

    #[inline(always)]
    unsafe fn turned(self, by: Complex) -> Self {
        // SAFETY: the contract.
        unsafe {
            let [re, im] = by.map(|part| V::splat(part));
            Self { re: self.re.mul(re).sub(self.im.mul(im)), im: self.re.mul(im).add(self.im.mul(re)) }
        }
    }
}

/// # Safety
/// That of [`Lanes`]; both pointers are to `radix * count * stride` complex numbers of all frames, apart from each other.
#[inline(always)]
unsafe fn run_stage<V: Lanes>(stage: &Stage, from: *const f32, to: *mut f32) {
    let Stage { radix, count, stride, .. } = *stage;
    let twiddle = |group: usize, part: usize| stage.twiddles[part * count + group];
    for group in 0..count {
        let turns =
            [1, 2, 3].map(|part| if part < radix { twiddle(group, part) } else { Complex::default() });
        for at in 0..stride {
            let place = |part: usize| (group * radix + part) * stride + at;
            for frame in (0..FOURIER_FRAMES).step_by(V::WIDTH) {
                // SAFETY: parts are below `radix`, groups below `count`: each place is one of the numbers.
                unsafe {
                    let input =
                        |part: usize| Pair::<V>::load(from, (group + part * count) * stride + at, frame);
                    match radix {
                        2 => {
                            let (a, b) = (input(0), input(1));
                            a.add(b).store(to, place(0), frame);
                            a.sub(b).turned(turns[0]).store(to, place(1), frame);
                        }
                        4 => {
                            let (a, b, c, d) = (input(0), input(1), input(2), input(3));
                            let (even, odd) = (a.add(c), b.add(d));
                            let (away, across) = (a.sub(c), b.sub(d).turned_back());
                            even.add(odd).store(to, place(0), frame);
                            away.add(across).turned(turns[0]).store(to, place(1), frame);
                            even.sub(odd).turned(turns[1]).store(to, place(2), frame);
                            away.sub(across).turned(turns[2]).store(to, place(3), frame);
                        }
                        // By the definition of the transform.
                        _ => {
                            for part in 0..radix {
                                let mut sum = input(0);
                                for of in 1..radix {
                                    sum = sum.add(input(of).turned(stage.roots[part * of % radix]));
                                }
                                sum.turned(twiddle(group, part)).store(to, place(part), frame);
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Computes the spectrum of all samples from the transform of their pairs.
///
/// # Safety
/// That of [`Lanes`]; `pairs` has one complex number less than `turns`, `values` as many numbers of all frames.
#[inline(always)]
unsafe fn spectrum_of_pairs<V: Lanes>(
    kind: Spectrum,
    pairs: *const f32,
    turns: &[Complex],
    values: *mut f32,
) {
    let half = turns.len() - 1;
    for (frequency, turn) in turns.iter().enumerate() {
        let (at, mirrored) = (frequency % half, (half - frequency) % half);
        for frame in (0..FOURIER_FRAMES).step_by(V::WIDTH) {
            // SAFETY: both places are below `half`, `frequency` is below the number of turns.
            unsafe {
                let (value, mirrored) =
                    (Pair::<V>::load(pairs, at, frame), Pair::<V>::load(pairs, mirrored, frame));
                // Spectra of the even and the odd samples, times two.
                let even = Pair { re: value.re.add(mirrored.re), im: value.im.sub(mirrored.im) };
                let odd = Pair { re: value.re.sub(mirrored.re), im: value.im.add(mirrored.im) };
                let sum = even.add(odd.turned_back().turned(*turn));
                let square = sum.im.mul_add(sum.im, sum.re.mul(sum.re));
                let power = square.mul(V::splat(0.25));
                let value = if kind == Spectrum::Magnitude { power.sqrt() } else { power };
                value.store(values.add(frequency * FOURIER_FRAMES + frame));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_equals_the_definition() {
        for size in [2, 4, 6, 8, 10, 14, 22, 32, 60, 98, 128, 400, 512, 640, 1102] {
            let sample = |frame: usize, at: usize| ((at * at + (3 + frame) * at) as f32 * 0.37).sin();
            let frames = |at: usize| std::array::from_fn(|frame| sample(frame, at));
            let samples: Vec<Frames> = (0..size).map(frames).collect();
            let wanted = |frequency: usize, frame: usize| {
                let part = |wave: fn(f64) -> f64| -> f64 {
                    let angle = |at: usize| TAU * (frequency * at % size) as f64 / size as f64;
                    (0..size).map(|at| f64::from(sample(frame, at)) * wave(angle(at))).sum()
                };
                part(f64::cos).powi(2) + part(f64::sin).powi(2)
            };
            let (fourier, mut work, mut power) =
                (RealFourier::new(size), FourierScratch::default(), Vec::new());
            for isa in Isa::available() {
                fourier.run(isa, Spectrum::Power, &samples, &mut work, &mut power);
                let mut magnitude = Vec::new();
                fourier.run(isa, Spectrum::Magnitude, &samples, &mut work, &mut magnitude);
                assert_eq!(power.len(), size / 2 + 1);
                for (frequency, power) in power.iter().enumerate() {
                    for frame in [0, 3, FOURIER_FRAMES - 1] {
                        assert_eq!(magnitude[frequency][frame], power[frame].sqrt());
                        let (power, wanted) = (f64::from(power[frame]), wanted(frequency, frame));
                        assert!(
                            (power - wanted).abs() < 1e-5 * size as f64 * (1.0 + wanted.sqrt()),
                            "{isa} {size} {frequency} {frame}: {power} {wanted}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    #[should_panic(expected = "even number")]
    fn odd_sizes_panic() {
        RealFourier::new(9);
    }
}
