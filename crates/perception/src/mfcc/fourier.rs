//! The Fourier transform of real samples, of any even size.
//!
//! Stockham's form: every stage reads one pair of planes and writes the other, without reordering, and its innermost loop
//! runs over neighbours, which the compiler makes vector instructions of. Factors of four and two have butterflies of
//! their own (a window of 40 ms at 16 kHz has 640 samples, 2^7 * 5).

use std::f64::consts::TAU;

/// A transform of one size.
pub(super) struct RealFourier {
    size: usize,
    stages: Vec<Stage>,
    /// `exp(-2πi k / size)` for the first `size / 2 + 1` frequencies.
    turns: Planes,
}

/// Memory for one transform.
#[derive(Default)]
pub(super) struct FourierWork {
    from: Planes,
    to: Planes,
}

/// Complex numbers, real and imaginary parts apart.
#[derive(Default)]
struct Planes {
    re: Vec<f32>,
    im: Vec<f32>,
}

/// One stage: `count` transforms of `radix` points for each of `stride` interleaved series.
struct Stage {
    radix: usize,
    count: usize,
    stride: usize,
    /// `exp(-2πi p j / (radix * count))` at `p * radix + j`.
    twiddles: Planes,
    /// `exp(-2πi j / radix)`.
    roots: Planes,
}

impl Planes {
    fn turns(count: usize, angle: impl Fn(usize) -> f64) -> Self {
        Self {
            re: (0..count).map(|at| angle(at).cos() as f32).collect(),
            im: (0..count).map(|at| -angle(at).sin() as f32).collect(),
        }
    }

    fn resize(&mut self, size: usize) {
        self.re.resize(size, 0.0);
        self.im.resize(size, 0.0);
    }

    fn at(&self, index: usize) -> [f32; 2] {
        [self.re[index], self.im[index]]
    }
}

impl RealFourier {
    /// For `size` samples, an even number.
    pub fn new(size: usize) -> Self {
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
                twiddles: Planes::turns(radix * rest, |at| {
                    TAU * ((at / radix) * (at % radix)) as f64 / whole
                }),
                roots: Planes::turns(radix, |at| TAU * at as f64 / radix as f64),
            });
            stride *= radix;
        }
        let turns = Planes::turns(size / 2 + 1, |at| TAU * at as f64 / size as f64);
        Self { size, stages, turns }
    }

    /// Samples of a transform.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Replaces `power` by the square of the absolute value of each of the `size / 2 + 1` frequencies of `samples`.
    pub fn power(&self, samples: &[f32], work: &mut FourierWork, power: &mut Vec<f32>) {
        let half = self.size / 2;
        work.from.resize(half);
        work.to.resize(half);
        // Even samples as real, odd samples as imaginary parts: one transform of half the size serves both.
        let places = work.from.re.iter_mut().zip(&mut work.from.im);
        places.zip(samples.chunks_exact(2)).for_each(|((re, im), pair)| (*re, *im) = (pair[0], pair[1]));
        for stage in &self.stages {
            stage.run(&work.from, &mut work.to);
            std::mem::swap(&mut work.from, &mut work.to);
        }
        power.clear();
        power.extend((0..=half).map(|frequency| {
            let [a, b] = work.from.at(frequency % half);
            let [c, d] = work.from.at((half - frequency) % half);
            let (even, odd) = ([a + c, b - d], [b + d, c - a]);
            let [re, im] = product(odd, self.turns.at(frequency));
            0.25 * ((even[0] + re).powi(2) + (even[1] + im).powi(2))
        }));
    }
}

impl Stage {
    fn run(&self, from: &Planes, to: &mut Planes) {
        let Self { radix, count, stride, .. } = *self;
        for group in 0..count {
            let to_re = &mut to.re[group * radix * stride..][..radix * stride];
            let to_im = &mut to.im[group * radix * stride..][..radix * stride];
            let input = |part: usize| {
                let begin = (group + part * count) * stride;
                (&from.re[begin..][..stride], &from.im[begin..][..stride])
            };
            match radix {
                2 => self.butterfly_2(group, [0, 1].map(input), to_re, to_im),
                4 => self.butterfly_4(group, [0, 1, 2, 3].map(input), to_re, to_im),
                _ => self.butterfly(group, input, to_re, to_im),
            }
        }
    }

    fn twiddle(&self, group: usize, part: usize) -> [f32; 2] {
        self.twiddles.at(group * self.radix + part)
    }

    fn butterfly_2(&self, group: usize, input: [(&[f32], &[f32]); 2], to_re: &mut [f32], to_im: &mut [f32]) {
        let turn = self.twiddle(group, 1);
        let [(a_re, a_im), (b_re, b_im)] = input;
        let (re_0, re_1) = to_re.split_at_mut(self.stride);
        let (im_0, im_1) = to_im.split_at_mut(self.stride);
        for at in 0..self.stride {
            (re_0[at], im_0[at]) = (a_re[at] + b_re[at], a_im[at] + b_im[at]);
            [re_1[at], im_1[at]] = product([a_re[at] - b_re[at], a_im[at] - b_im[at]], turn);
        }
    }

    fn butterfly_4(&self, group: usize, input: [(&[f32], &[f32]); 4], to_re: &mut [f32], to_im: &mut [f32]) {
        let turns = [1, 2, 3].map(|part| self.twiddle(group, part));
        let [(a_re, a_im), (b_re, b_im), (c_re, c_im), (d_re, d_im)] = input;
        let (low, high) = to_re.split_at_mut(2 * self.stride);
        let ((re_0, re_1), (re_2, re_3)) = (low.split_at_mut(self.stride), high.split_at_mut(self.stride));
        let (low, high) = to_im.split_at_mut(2 * self.stride);
        let ((im_0, im_1), (im_2, im_3)) = (low.split_at_mut(self.stride), high.split_at_mut(self.stride));
        for at in 0..self.stride {
            let (sum_re, sum_im) = (a_re[at] + c_re[at], a_im[at] + c_im[at]);
            let (gap_re, gap_im) = (a_re[at] - c_re[at], a_im[at] - c_im[at]);
            let (other_re, other_im) = (b_re[at] + d_re[at], b_im[at] + d_im[at]);
            // (b - d) times -i.
            let (turned_re, turned_im) = (b_im[at] - d_im[at], d_re[at] - b_re[at]);
            (re_0[at], im_0[at]) = (sum_re + other_re, sum_im + other_im);
            [re_1[at], im_1[at]] = product([gap_re + turned_re, gap_im + turned_im], turns[0]);
            [re_2[at], im_2[at]] = product([sum_re - other_re, sum_im - other_im], turns[1]);
            [re_3[at], im_3[at]] = product([gap_re - turned_re, gap_im - turned_im], turns[2]);
        }
    }

    /// For any radix, by its definition.
    fn butterfly<'a>(
        &self,
        group: usize,
        input: impl Fn(usize) -> (&'a [f32], &'a [f32]),
        to_re: &mut [f32],
        to_im: &mut [f32],
    ) {
        let outputs = to_re.chunks_exact_mut(self.stride).zip(to_im.chunks_exact_mut(self.stride));
        for (part, (to_re, to_im)) in outputs.enumerate() {
            to_re.fill(0.0);
            to_im.fill(0.0);
            let turn = self.twiddle(group, part);
            for of in 0..self.radix {
                let root = product(self.roots.at(part * of % self.radix), turn);
                let (from_re, from_im) = input(of);
                for at in 0..self.stride {
                    let [re, im] = product([from_re[at], from_im[at]], root);
                    to_re[at] += re;
                    to_im[at] += im;
                }
            }
        }
    }
}

fn product(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_is_that_of_the_definition() {
        for size in [2, 4, 6, 8, 10, 14, 22, 32, 60, 98, 128, 400, 512, 640, 1102] {
            let samples: Vec<f32> = (0..size).map(|at| ((at * at + 3 * at) as f32 * 0.37).sin()).collect();
            let (mut power, mut work) = (Vec::new(), FourierWork::default());
            RealFourier::new(size).power(&samples, &mut work, &mut power);
            assert_eq!(power.len(), size / 2 + 1);
            for (frequency, power) in power.iter().enumerate() {
                let part = |wave: fn(f64) -> f64| -> f64 {
                    let angle = |at: usize| TAU * (frequency * at % size) as f64 / size as f64;
                    samples.iter().enumerate().map(|(at, sample)| f64::from(*sample) * wave(angle(at))).sum()
                };
                let wanted = part(f64::cos).powi(2) + part(f64::sin).powi(2);
                let error = (f64::from(*power) - wanted).abs();
                assert!(
                    error < 1e-5 * size as f64 * (1.0 + wanted.sqrt()),
                    "{size} {frequency}: {power} {wanted}"
                );
            }
        }
    }
}
