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
    /// `exp(-2πi p j / (radix * count))` at `j * count + p`.
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
                twiddles: Planes::turns(radix * rest, |at| TAU * ((at / rest) * (at % rest)) as f64 / whole),
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
        power.resize(half + 1, 0.0);
        let Planes { re, im } = &work.from;
        power[0] = (re[0] + im[0]).powi(2);
        power[half] = (re[0] - im[0]).powi(2);
        let count = half - 1;
        let (re, im, power) = (&re[1..][..count], &im[1..][..count], &mut power[1..][..count]);
        let (turn_re, turn_im) = (&self.turns.re[1..][..count], &self.turns.im[1..][..count]);
        for at in 0..count {
            let mirrored = count - 1 - at;
            let (even_re, even_im) = (re[at] + re[mirrored], im[at] - im[mirrored]);
            let odd = [im[at] + im[mirrored], re[mirrored] - re[at]];
            let [odd_re, odd_im] = product(odd, [turn_re[at], turn_im[at]]);
            power[at] = 0.25 * ((even_re + odd_re).powi(2) + (even_im + odd_im).powi(2));
        }
    }
}

impl Stage {
    fn run(&self, from: &Planes, to: &mut Planes) {
        let Self { radix, count, stride, .. } = *self;
        if (radix, stride) == (4, 1) {
            return self.butterflies_4(from, to);
        }
        for group in 0..count {
            let to_re = &mut to.re[group * radix * stride..][..radix * stride];
            let to_im = &mut to.im[group * radix * stride..][..radix * stride];
            let input = |part: usize| {
                let begin = (group + part * count) * stride;
                (&from.re[begin..][..stride], &from.im[begin..][..stride])
            };
            match radix {
                2 => self.butterfly_2(group, [input(0), input(1)], to_re, to_im),
                4 => self.butterfly_4(group, [input(0), input(1), input(2), input(3)], to_re, to_im),
                _ => self.butterfly(group, input, to_re, to_im),
            }
        }
    }

    fn twiddle(&self, group: usize, part: usize) -> [f32; 2] {
        self.twiddles.at(part * self.count + group)
    }

    /// The first stage, where the groups are the neighbours.
    fn butterflies_4(&self, from: &Planes, to: &mut Planes) {
        let count = self.count;
        let [a_re, b_re, c_re, d_re] = quarters(&from.re, count);
        let [a_im, b_im, c_im, d_im] = quarters(&from.im, count);
        let [_, turn_re_1, turn_re_2, turn_re_3] = quarters(&self.twiddles.re, count);
        let [_, turn_im_1, turn_im_2, turn_im_3] = quarters(&self.twiddles.im, count);
        let outputs = to.re.chunks_exact_mut(4).zip(to.im.chunks_exact_mut(4));
        for (at, (to_re, to_im)) in outputs.enumerate().take(count) {
            let input =
                [[a_re[at], a_im[at]], [b_re[at], b_im[at]], [c_re[at], c_im[at]], [d_re[at], d_im[at]]];
            let turns = [
                [turn_re_1[at], turn_im_1[at]],
                [turn_re_2[at], turn_im_2[at]],
                [turn_re_3[at], turn_im_3[at]],
            ];
            let output = points_4(input, turns);
            for part in 0..4 {
                [to_re[part], to_im[part]] = output[part];
            }
        }
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
        let turns = [self.twiddle(group, 1), self.twiddle(group, 2), self.twiddle(group, 3)];
        let [(a_re, a_im), (b_re, b_im), (c_re, c_im), (d_re, d_im)] = input;
        let (low, high) = to_re.split_at_mut(2 * self.stride);
        let ((re_0, re_1), (re_2, re_3)) = (low.split_at_mut(self.stride), high.split_at_mut(self.stride));
        let (low, high) = to_im.split_at_mut(2 * self.stride);
        let ((im_0, im_1), (im_2, im_3)) = (low.split_at_mut(self.stride), high.split_at_mut(self.stride));
        for at in 0..self.stride {
            let input =
                [[a_re[at], a_im[at]], [b_re[at], b_im[at]], [c_re[at], c_im[at]], [d_re[at], d_im[at]]];
            let output = points_4(input, turns);
            [re_0[at], im_0[at]] = output[0];
            [re_1[at], im_1[at]] = output[1];
            [re_2[at], im_2[at]] = output[2];
            [re_3[at], im_3[at]] = output[3];
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

/// Four parts of `count` numbers each.
fn quarters(plane: &[f32], count: usize) -> [&[f32]; 4] {
    let (low, high) = plane[..4 * count].split_at(2 * count);
    let ((a, b), (c, d)) = (low.split_at(count), high.split_at(count));
    [a, b, c, d]
}

/// A transform of four points, all but the first turned after it.
#[inline(always)]
fn points_4([a, b, c, d]: [[f32; 2]; 4], turns: [[f32; 2]; 3]) -> [[f32; 2]; 4] {
    let (sum, gap) = ([a[0] + c[0], a[1] + c[1]], [a[0] - c[0], a[1] - c[1]]);
    let other = [b[0] + d[0], b[1] + d[1]];
    // (b - d) times -i.
    let turned = [b[1] - d[1], d[0] - b[0]];
    [
        [sum[0] + other[0], sum[1] + other[1]],
        product([gap[0] + turned[0], gap[1] + turned[1]], turns[0]),
        product([sum[0] - other[0], sum[1] - other[1]], turns[1]),
        product([gap[0] - turned[0], gap[1] - turned[1]], turns[2]),
    ]
}

#[inline(always)]
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
