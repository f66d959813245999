//! Batch normalisation of tensors with channels last, with the gradients of a training step.

use crate::aligned::{Output, written};
use crate::compute::Compute;
use crate::isa::{Isa, for_every_isa};
use crate::lanes::{Lanes, MAX_WIDTH};
use crate::unary::Unary;

/// Numbers of a chunk of pixels, whose statistics are summed by one thread.
const CHUNK: usize = 1 << 14;

/// Normalisation by the statistics of a batch (Ioffe and Szegedy, *Batch Normalization*, 2015), of pixels with channels last:
/// `y = activation((x - mean) / √(variance + epsilon) gamma + beta)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BatchNormalization<'a> {
    /// Factor of each channel.
    pub gamma: &'a [f32],
    /// Term of each channel.
    pub beta: &'a [f32],
    /// What is added to the variance.
    pub epsilon: f32,
    /// Activation function that follows, one that [`Unary::is_differentiable`].
    pub activation: Unary,
}

/// Mean and biased variance of each channel.
#[derive(Debug, Clone, PartialEq)]
pub struct BatchStatistics {
    /// Means.
    pub mean: Vec<f32>,
    /// Biased variances.
    pub variance: Vec<f32>,
}

/// Factor and term of each channel, filled up to whole registers.
struct Affine {
    scale: Vec<f32>,
    shift: Vec<f32>,
}

impl BatchNormalization<'_> {
    fn channels(&self) -> usize {
        self.gamma.len()
    }

    fn check(&self, x: &[f32], y: &[f32]) {
        assert_eq!(self.beta.len(), self.channels(), "one term per channel");
        assert!(self.activation.is_differentiable(), "the activation function has a gradient");
        assert_eq!(x.len(), y.len(), "the output must have the size of the input");
        assert!(x.len().is_multiple_of(self.channels().max(1)), "the pixels must have all channels");
    }

    fn affine(&self, statistics: &BatchStatistics) -> Affine {
        let padded = self.channels().next_multiple_of(MAX_WIDTH);
        let (mut scale, mut shift) = (vec![0.0; padded], vec![0.0; padded]);
        let all = statistics.mean.iter().zip(&statistics.variance).zip(self.gamma.iter().zip(self.beta));
        for (channel, ((mean, variance), (gamma, beta))) in all.enumerate() {
            scale[channel] = gamma / (variance + self.epsilon).sqrt();
            shift[channel] = beta - mean * scale[channel];
        }
        Affine { scale, shift }
    }

    /// Returns the output of pixels, and their statistics.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn forward(&self, compute: &Compute, x: &[f32]) -> (Vec<f32>, BatchStatistics) {
        self.check(x, x);
        let channels = self.channels();
        if x.is_empty() {
            let zeros = vec![0.0; channels];
            return (Vec::new(), BatchStatistics { mean: zeros.clone(), variance: zeros });
        }
        let statistics = statistics(compute, x, channels);
        (self.inference(compute, x, &statistics), statistics)
    }

    /// Returns the output of pixels with statistics that are given.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn inference(&self, compute: &Compute, x: &[f32], statistics: &BatchStatistics) -> Vec<f32> {
        self.check(x, x);
        self.check_statistics(statistics);
        let affine = self.affine(statistics);
        let at_once = pixels_of_chunk(self.channels()) * self.channels().max(1);
        // SAFETY: the chunks write every number of the output.
        unsafe {
            written(x.len(), |y| {
                let y = Output(y);
                compute.pool().run(x.len().div_ceil(at_once), |chunk| {
                    let x = &x[chunk * at_once..x.len().min((chunk + 1) * at_once)];
                    dispatch_normalize(compute.isa(), x, y.at(chunk * at_once), &affine, self);
                });
            })
            .0
        }
    }

    fn check_statistics(&self, statistics: &BatchStatistics) {
        let is_whole =
            statistics.mean.len() == self.channels() && statistics.variance.len() == self.channels();
        assert!(is_whole, "one mean and variance per channel");
    }

    /// Replaces the gradient of the output by that of the input, and returns those of `gamma` and `beta`.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn backward(
        &self,
        compute: &Compute,
        x: &[f32],
        statistics: &BatchStatistics,
        dy: &mut [f32],
    ) -> [Vec<f32>; 2] {
        self.check(x, dy);
        let channels = self.channels();
        self.check_statistics(statistics);
        if x.is_empty() {
            return [vec![0.0; channels], vec![0.0; channels]];
        }
        let affine = self.affine(statistics);
        let padded = affine.scale.len();
        let mut mean = statistics.mean.clone();
        mean.resize(padded, 0.0);
        let all = &*dy;
        let sums = chunk_sums(compute, x.len(), channels, |isa, pixels, to| {
            let (x, dy) = (&x[pixels.clone()], &all[pixels]);
            // SAFETY: both have whole pixels; factors and terms are filled up.
            unsafe { dispatch_gradients(isa, x, dy, &affine, &mean, self, to) };
        });
        let total = |which: usize| {
            let mut all = vec![0.0_f64; channels];
            for chunk in sums.chunks(2 * padded) {
                all.iter_mut()
                    .zip(&chunk[which * padded..])
                    .for_each(|(sum, value)| *sum += f64::from(*value));
            }
            all
        };
        let (of_dy, of_products) = (total(0), total(1));
        // dx = scale (dy - mean(dy) - (x - mean) mean(dy (x - mean)) / (variance + epsilon)), as factor dy + slope x + term.
        let pixels = (x.len() / channels) as f64;
        let (mut slope, mut term) = (vec![0.0; padded], vec![0.0; padded]);
        let mut dgamma = vec![0.0; channels];
        for channel in 0..channels {
            let inverse = 1.0 / (f64::from(statistics.variance[channel]) + f64::from(self.epsilon));
            let scale = f64::from(affine.scale[channel]);
            let along = scale * inverse * of_products[channel] / pixels;
            slope[channel] = -along as f32;
            term[channel] = (along * f64::from(mean[channel]) - scale * of_dy[channel] / pixels) as f32;
            dgamma[channel] = (of_products[channel] * inverse.sqrt()) as f32;
        }
        self.combine(compute, x, dy, &affine, [&slope, &term]);
        [dgamma, of_dy.into_iter().map(|sum| sum as f32).collect()]
    }

    /// Replaces the gradient of the output by that of the input, with statistics that are given.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn inference_backward(
        &self,
        compute: &Compute,
        x: &[f32],
        statistics: &BatchStatistics,
        dy: &mut [f32],
    ) {
        self.check(x, dy);
        self.check_statistics(statistics);
        let affine = self.affine(statistics);
        let zeros = vec![0.0; affine.scale.len()];
        self.combine(compute, x, dy, &affine, [&zeros, &zeros]);
    }

    /// Replaces `dy` by `scale dy + slope x + term`.
    fn combine(
        &self,
        compute: &Compute,
        x: &[f32],
        dy: &mut [f32],
        affine: &Affine,
        [slope, term]: [&[f32]; 2],
    ) {
        let at_once = pixels_of_chunk(self.channels()) * self.channels().max(1);
        compute.pool().run_on_pieces(dy, at_once, |chunk, dy| {
            let x = &x[chunk * at_once..][..dy.len()];
            // SAFETY: both have whole pixels; factors and terms are filled up.
            unsafe { dispatch_combine(compute.isa(), x, dy, affine, [slope, term], self) };
        });
    }
}

fn pixels_of_chunk(channels: usize) -> usize {
    (CHUNK / channels.max(1)).max(16)
}

/// Returns two sums of each chunk and channel, which `sum` writes: chunks do not depend on the number of threads.
fn chunk_sums(
    compute: &Compute,
    length: usize,
    channels: usize,
    sum: impl Fn(Isa, std::ops::Range<usize>, &mut [f32]) + Sync,
) -> Vec<f32> {
    let at_once = pixels_of_chunk(channels) * channels;
    let padded = channels.next_multiple_of(MAX_WIDTH);
    let mut sums = vec![0.0; length.div_ceil(at_once) * 2 * padded];
    compute.pool().run_on_pieces(&mut sums, 2 * padded, |chunk, to| {
        sum(compute.isa(), chunk * at_once..((chunk + 1) * at_once).min(length), to);
    });
    sums
}

fn statistics(compute: &Compute, x: &[f32], channels: usize) -> BatchStatistics {
    let padded = channels.next_multiple_of(MAX_WIDTH);
    let at_once = pixels_of_chunk(channels) * channels;
    let sums = chunk_sums(compute, x.len(), channels, |isa, pixels, to| {
        // SAFETY: the pixels are whole, and the sums filled up.
        unsafe { dispatch_moments(isa, &x[pixels], channels, to) };
    });
    // Chunks are joined by Chan's formula (Chan, Golub and LeVeque, 1983).
    let mut mean = vec![0.0_f64; channels];
    let mut squares = vec![0.0_f64; channels];
    let mut count = 0.0_f64;
    for (chunk, sums) in sums.chunks(2 * padded).enumerate() {
        let first = &x[chunk * at_once..];
        let pixels = (first.len().min(at_once) / channels) as f64;
        let all = count + pixels;
        for channel in 0..channels {
            let (sum, square) = (f64::from(sums[channel]), f64::from(sums[padded + channel]));
            let own_mean = f64::from(first[channel]) + sum / pixels;
            let own_squares = square - sum * sum / pixels;
            let distance = own_mean - mean[channel];
            squares[channel] += own_squares.max(0.0) + distance * distance * count * pixels / all;
            mean[channel] += distance * pixels / all;
        }
        count = all;
    }
    BatchStatistics {
        mean: mean.into_iter().map(|mean| mean as f32).collect(),
        variance: squares.into_iter().map(|sum| (sum / count) as f32).collect(),
    }
}

for_every_isa!(fn dispatch_moments = moments(x: &[f32], channels: usize, to: &mut [f32]));

/// Writes the sums of `x - first` and of their squares, where `first` is the first pixel.
#[inline(always)]
unsafe fn moments<V: Lanes>(x: &[f32], channels: usize, to: &mut [f32]) {
    let padded = to.len() / 2;
    for channel in (0..channels).step_by(V::WIDTH) {
        let count = (channels - channel).min(V::WIDTH);
        // SAFETY: channels and pixels lie within the slices.
        unsafe {
            let first = load::<V>(x.as_ptr().add(channel), count);
            let (mut sum, mut squares) = (V::splat(0.0), V::splat(0.0));
            let mut from = x.as_ptr().add(channel);
            for _ in 0..x.len() / channels {
                let distance = load::<V>(from, count).sub(first);
                sum = sum.add(distance);
                squares = distance.mul_add(distance, squares);
                from = from.wrapping_add(channels);
            }
            sum.store(to.as_mut_ptr().add(channel));
            squares.store(to.as_mut_ptr().add(padded + channel));
        }
    }
}

#[inline(always)]
unsafe fn load<V: Lanes>(from: *const f32, count: usize) -> V {
    // SAFETY: passed on.
    unsafe { if count == V::WIDTH { V::load(from) } else { V::load_some(from, count) } }
}

#[inline(always)]
unsafe fn store<V: Lanes>(value: V, to: *mut f32, count: usize) {
    // SAFETY: passed on.
    unsafe { if count == V::WIDTH { value.store(to) } else { value.store_some(to, count) } }
}

for_every_isa!(fn dispatch_normalize = normalize(x: &[f32], y: *mut f32, affine: &Affine, norm: &BatchNormalization<'_>));

#[inline(always)]
unsafe fn normalize<V: Lanes>(x: &[f32], y: *mut f32, affine: &Affine, norm: &BatchNormalization<'_>) {
    let channels = norm.channels();
    for pixel in (0..x.len()).step_by(channels) {
        for channel in (0..channels).step_by(V::WIDTH) {
            let count = (channels - channel).min(V::WIDTH);
            // SAFETY: channels and pixels lie within the slices.
            unsafe {
                let scale = V::load(affine.scale.as_ptr().add(channel));
                let shift = V::load(affine.shift.as_ptr().add(channel));
                let value = load::<V>(x.as_ptr().add(pixel + channel), count).mul_add(scale, shift);
                store(norm.activation.of(value), y.add(pixel + channel), count);
            }
        }
    }
}

for_every_isa!(fn dispatch_gradients = gradients(x: &[f32], dy: &[f32], affine: &Affine, mean: &[f32], norm: &BatchNormalization<'_>, to: &mut [f32]));

/// Writes the sums of `dy` and of `dy (x - mean)`.
#[inline(always)]
unsafe fn gradients<V: Lanes>(
    x: &[f32],
    dy: &[f32],
    affine: &Affine,
    mean: &[f32],
    norm: &BatchNormalization<'_>,
    to: &mut [f32],
) {
    let (channels, padded) = (norm.channels(), to.len() / 2);
    for channel in (0..channels).step_by(V::WIDTH) {
        let count = (channels - channel).min(V::WIDTH);
        // SAFETY: channels and pixels lie within the slices.
        unsafe {
            let scale = V::load(affine.scale.as_ptr().add(channel));
            let shift = V::load(affine.shift.as_ptr().add(channel));
            let mean = V::load(mean.as_ptr().add(channel));
            let (mut sum, mut products) = (V::splat(0.0), V::splat(0.0));
            let (mut x_from, mut dy_from) = (x.as_ptr().add(channel), dy.as_ptr().add(channel));
            for _ in 0..x.len() / channels {
                let value = load::<V>(x_from, count);
                let gradient =
                    before_activation(load::<V>(dy_from, count), value, scale, shift, norm.activation);
                sum = sum.add(gradient);
                products = gradient.mul_add(value.sub(mean), products);
                x_from = x_from.wrapping_add(channels);
                dy_from = dy_from.wrapping_add(channels);
            }
            sum.store(to.as_mut_ptr().add(channel));
            products.store(to.as_mut_ptr().add(padded + channel));
        }
    }
}

/// Returns the gradient before the activation function.
#[inline(always)]
unsafe fn before_activation<V: Lanes>(dy: V, x: V, scale: V, shift: V, activation: Unary) -> V {
    // SAFETY: passed on.
    unsafe { activation.backward_of(x.mul_add(scale, shift), dy) }
}

for_every_isa!(fn dispatch_combine = combine(x: &[f32], dy: &mut [f32], affine: &Affine, line: [&[f32]; 2], norm: &BatchNormalization<'_>));

#[inline(always)]
unsafe fn combine<V: Lanes>(
    x: &[f32],
    dy: &mut [f32],
    affine: &Affine,
    [slope, term]: [&[f32]; 2],
    norm: &BatchNormalization<'_>,
) {
    let channels = norm.channels();
    for pixel in (0..x.len()).step_by(channels) {
        for channel in (0..channels).step_by(V::WIDTH) {
            let count = (channels - channel).min(V::WIDTH);
            // SAFETY: channels and pixels lie within the slices.
            unsafe {
                let scale = V::load(affine.scale.as_ptr().add(channel));
                let shift = V::load(affine.shift.as_ptr().add(channel));
                let slope = V::load(slope.as_ptr().add(channel));
                let term = V::load(term.as_ptr().add(channel));
                let value = load::<V>(x.as_ptr().add(pixel + channel), count);
                let gradient = load::<V>(dy.as_ptr().add(pixel + channel), count);
                let gradient = before_activation(gradient, value, scale, shift, norm.activation);
                let whole = gradient.mul_add(scale, value.mul_add(slope, term));
                store(whole, dy.as_mut_ptr().add(pixel + channel), count);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::pool::WorkerPool;
    use crate::reference::{assert_near, random};

    /// Distance between a number and its f64 reference, relative to the largest one.
    const TOLERANCE: f64 = 1e-4;

    /// Output, gradient of the input, of gamma and of beta.
    fn by_definition(norm: &BatchNormalization<'_>, x: &[f32], dy: &[f32]) -> [Vec<f64>; 4] {
        let channels = norm.channels();
        let pixels = x.len() / channels;
        let mut all = [vec![0.0; x.len()], vec![0.0; x.len()], vec![0.0; channels], vec![0.0; channels]];
        let [y, dx, dgamma, dbeta] = &mut all;
        for channel in 0..channels {
            let at = |pixel: usize| pixel * channels + channel;
            let value = |pixel| f64::from(x[at(pixel)]);
            let mean = (0..pixels).map(value).sum::<f64>() / pixels as f64;
            let variance =
                (0..pixels).map(|pixel| (value(pixel) - mean).powi(2)).sum::<f64>() / pixels as f64;
            let deviation = (variance + f64::from(norm.epsilon)).sqrt();
            let normalized = |pixel| (value(pixel) - mean) / deviation;
            let (gamma, beta) = (f64::from(norm.gamma[channel]), f64::from(norm.beta[channel]));
            let output = |pixel| gamma * normalized(pixel) + beta;
            let sigmoid = |value: f64| 1.0 / (1.0 + (-value).exp());
            let activated = |value: f64| match norm.activation {
                Unary::Relu => value.max(0.0),
                Unary::Clip { low, high } => value.clamp(f64::from(low), f64::from(high)),
                Unary::Swish => value * sigmoid(value),
                _ => value,
            };
            let gradient = |pixel: usize| {
                let (value, step) = (output(pixel), 1e-6);
                (activated(value + step) - activated(value - step)) / (2.0 * step) * f64::from(dy[at(pixel)])
            };
            dbeta[channel] = (0..pixels).map(gradient).sum();
            dgamma[channel] = (0..pixels).map(|pixel| gradient(pixel) * normalized(pixel)).sum();
            for pixel in 0..pixels {
                y[at(pixel)] = activated(output(pixel));
                let mean_terms = (dbeta[channel] + normalized(pixel) * dgamma[channel]) / pixels as f64;
                dx[at(pixel)] = gamma / deviation * (gradient(pixel) - mean_terms);
            }
        }
        all
    }

    #[test]
    fn both_passes_equal_their_definition() {
        for (channels, pixels, offset) in
            [(1, 50, 0.0), (5, 300, 2.0), (16, 5000, -1.0), (37, 1100, 30.0), (64, 1, 0.0)]
        {
            for activation in
                [Unary::Identity, Unary::Relu, Unary::Clip { low: 0.0, high: 0.6 }, Unary::Swish]
            {
                let x: Vec<f32> = random(channels * pixels, 1).into_iter().map(|x| x + offset).collect();
                let (dy, gamma) = (random(x.len(), 2), random(channels, 3));
                // Never zero, where a single pixel would lie at the kink of ReLU.
                let beta: Vec<f32> = random(channels, 4).into_iter().map(|beta| beta + 0.3003).collect();
                let norm = BatchNormalization { gamma: &gamma, beta: &beta, epsilon: 1e-5, activation };
                let [y_wanted, dx_wanted, dgamma_wanted, dbeta_wanted] = by_definition(&norm, &x, &dy);
                for isa in Isa::available() {
                    let mut of_one = None;
                    for threads in [1, 3] {
                        let compute = Compute::new(isa, Arc::new(WorkerPool::new(threads)));
                        let mut dx = dy.clone();
                        let (y, statistics) = norm.forward(&compute, &x);
                        let [dgamma, dbeta] = norm.backward(&compute, &x, &statistics, &mut dx);
                        let what = format!("{channels} channels, {pixels} pixels, {isa}");
                        assert_near(&y, &y_wanted, TOLERANCE, &what);
                        if pixels > 1 {
                            assert_near(&dx, &dx_wanted, TOLERANCE, &what);
                        }
                        assert_near(&dgamma, &dgamma_wanted, TOLERANCE, &what);
                        assert_near(&dbeta, &dbeta_wanted, TOLERANCE, &what);
                        let results = (y, dx, dgamma, dbeta, statistics);
                        assert_eq!(
                            *of_one.get_or_insert_with(|| results.clone()),
                            results,
                            "{what}: threads"
                        );
                    }
                }
            }
        }
    }
}
