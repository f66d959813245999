//! Convolutions of 3x3 taps by fewer products (Winograd; Lavin and Gray, *Fast algorithms for convolutional neural networks*, 2016,
//! F(4x4, 3x3)): 36 products per 16 output pixels in place of 144, between transforms of the input and of the sums.

use std::sync::Arc;

use super::filters::Filters;
use super::geometry::{Convolution, Finish, Strides, Window};
use super::piece;
use crate::aligned::{PATCHES, SUMS, negligible, with_buffer};
use crate::compute::Compute;
use crate::cost::LayerCost;
use crate::isa::{Isa, for_every_isa};
use crate::lanes::{Lanes, MAX_WIDTH};
use crate::pool::Pieces;
use crate::unary::Unary;

/// Output pixels of a tile along an axis.
pub(super) const TILE: usize = 4;
/// Input pixels of a tile along an axis.
pub(super) const SIZE: usize = TILE + 2;
/// Products per tile, channel and output.
pub(super) const PRODUCTS: usize = SIZE * SIZE;
/// Numbers of the transformed tiles and sums of a piece: they stay in the L2 cache.
const PIECE: usize = 1 << 18;
/// Output pixels from which on the saved products pay for four times as many weights, when a model opens too.
const LEAST_PIXELS: usize = 2048;

/// Transformed weights of 3x3 taps, packed for products.
#[derive(Debug)]
pub struct WinogradFilters {
    products: Vec<Arc<Filters>>,
    channels: usize,
    outputs: usize,
    /// Filled up to whole registers of any instruction set.
    bias: Vec<f32>,
}

impl WinogradFilters {
    /// Transforms weights of the shape `[outputs, channels, 3, 3]`.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn new(
        compute: &Compute,
        weights: &[f32],
        [outputs, channels]: [usize; 2],
        bias: Option<&[f32]>,
    ) -> Self {
        assert_eq!(weights.len(), 9 * outputs * channels, "the weights must have the stated shape");
        let one = || Filters::zeros(compute, [1, outputs, channels], [1, 1], None, false);
        let mut products: Vec<Filters> = std::iter::repeat_with(one).take(PRODUCTS).collect();
        let least = negligible(weights);
        for panel in 0..products[0].panel_count() {
            let first = panel * products[0].panel_outputs();
            let panels: Vec<Pieces<'_, f32>> = products
                .iter_mut()
                .map(|filters| {
                    let weights = filters.weights_mut(panel);
                    let row = weights.len() / channels;
                    Pieces::new(weights, row)
                })
                .collect();
            let isa = compute.isa();
            compute.pool().run(channels, |channel| {
                // SAFETY: each channel has rows of its own.
                let mut rows: [&mut [f32]; PRODUCTS] =
                    std::array::from_fn(|product| unsafe { panels[product].get(channel) });
                let taps = Taps { weights, outputs, channels, channel, least };
                // SAFETY: the rows have whole registers.
                unsafe { dispatch_taps(isa, &taps, first, &mut rows) };
            });
        }
        let products = products.into_iter().map(Arc::new).collect();
        let mut padded = vec![0.0; outputs.next_multiple_of(MAX_WIDTH)];
        if let Some(bias) = bias {
            assert_eq!(bias.len(), outputs, "one bias per output");
            padded[..outputs].copy_from_slice(bias);
        }
        Self { products, channels, outputs, bias: padded }
    }

    /// Returns the bytes of the packed weights.
    pub fn bytes(&self) -> usize {
        self.products.iter().map(|filters| filters.bytes()).sum::<usize>() + size_of_val(self.bias.as_slice())
    }

    /// Returns `values`, one per output, with the padding of the bias.
    pub fn padded(&self, values: &[f32]) -> Vec<f32> {
        let mut all = values.to_vec();
        all.resize(self.bias.len(), 0.0);
        all
    }
}

/// The taps of a channel, for all outputs.
struct Taps<'a> {
    weights: &'a [f32],
    outputs: usize,
    channels: usize,
    channel: usize,
    /// Magnitude below which a weight counts as zero.
    least: f32,
}

for_every_isa!(fn dispatch_taps = transform_taps(taps: &Taps<'_>, first: usize, rows: &mut [&mut [f32]; PRODUCTS]));

/// Writes `G taps G^T` of the outputs from `first` on to a row of each product.
///
/// # Safety
/// The rows have whole registers.
#[inline(always)]
unsafe fn transform_taps<V: Lanes>(taps: &Taps<'_>, first: usize, rows: &mut [&mut [f32]; PRODUCTS]) {
    for at in (0..rows[0].len()).step_by(V::WIDTH) {
        // A line of the outputs for each tap.
        let mut lines = [[0.0; MAX_WIDTH]; 9];
        let outputs = first + at..(first + at + V::WIDTH).min(taps.outputs);
        for (i, output) in outputs.enumerate() {
            let from = &taps.weights[9 * (output * taps.channels + taps.channel)..][..9];
            for (line, &weight) in lines.iter_mut().zip(from) {
                line[i] = if weight.abs() < taps.least { 0.0 } else { weight };
            }
        }
        // SAFETY: lines and rows have whole registers.
        unsafe {
            let tap = |at: usize| V::load(lines[at].as_ptr());
            let across = [0, 3, 6].map(|y| of_taps([tap(y), tap(y + 1), tap(y + 2)]));
            for x in 0..SIZE {
                let down = of_taps(across.map(|line| line[x]));
                for (y, value) in down.into_iter().enumerate() {
                    value.store(rows[y * SIZE + x].as_mut_ptr().add(at));
                }
            }
        }
    }
}

/// Returns `G g`.
#[inline(always)]
unsafe fn of_taps<V: Lanes>([a, b, c]: [V; 3]) -> [V; SIZE] {
    // SAFETY: passed on.
    unsafe {
        let part = |value: V, divisor: f32| value.mul(V::splat(1.0 / divisor));
        let (sum, even, odd) = (a.add(c), part(a, 24.0).add(part(c, 6.0)), part(b, 12.0));
        [part(a, 4.0), part(sum.add(b), -6.0), part(sum.sub(b), -6.0), even.add(odd), even.sub(odd), c]
    }
}

/// A convolution of 3x3 taps without strides, of tensors with channels last.
#[derive(Debug, Clone)]
pub struct Winograd {
    /// Weights and bias.
    pub filters: Arc<WinogradFilters>,
    /// Geometry.
    pub window: Window,
    /// Number of images.
    pub batch: usize,
    /// Layout of the output; its channels lie side by side.
    pub y: Strides,
    /// What follows the sums. The residual has the shape of the output, side by side.
    pub finish: Finish,
}

impl Winograd {
    /// Returns whether the transforms cost less than the products that they save, for weights that are packed once.
    pub fn is_faster(window: &Window, sizes: [usize; 2]) -> bool {
        let [height, width] = window.output;
        Self::has_kernel(window, sizes) && height * width >= LEAST_PIXELS
    }

    /// Returns whether a convolution has 3x3 taps without strides, and outputs and channels that fill registers.
    pub fn has_kernel(window: &Window, [outputs, channels]: [usize; 2]) -> bool {
        let is_plain = window.kernel == [3, 3] && window.strides == [1, 1] && window.dilations == [1, 1];
        is_plain && channels >= 16 && outputs >= 16
    }

    /// Returns the arithmetic of the convolution by its definition, and the bytes of the weights.
    pub fn cost(&self) -> LayerCost {
        let [height, width] = self.window.output;
        let factors = [self.batch, height, width, self.filters.outputs, self.filters.channels, 9];
        LayerCost::floats(&factors).with_weights(self.filters.bytes())
    }

    /// Computes the convolution.
    ///
    /// # Panics
    /// When the slices are shorter than the shapes and strides require.
    pub fn run(&self, compute: &Compute, x: &[f32], residual: Option<&[f32]>, y: &mut [f32]) {
        // SAFETY: the output has that length.
        unsafe { self.run_to(compute, x, residual, y.as_mut_ptr(), y.len()) }
    }

    /// Computes the convolution to `length` numbers, none of which is read before it is written.
    ///
    /// # Safety
    /// The numbers may be written, and nothing else uses them.
    pub(super) unsafe fn run_to(
        &self,
        compute: &Compute,
        x: &[f32],
        residual: Option<&[f32]>,
        y: *mut f32,
        length: usize,
    ) {
        let (filters, window) = (&*self.filters, &self.window);
        let [height, width] = window.output;
        if self.batch == 0 || height * width * filters.outputs == 0 {
            return;
        }
        let pixels = self.batch * height * width;
        let input = self.batch * window.input[0] * window.input[1] * filters.channels;
        assert!(x.len() >= input, "the input is too short");
        self.y.check_written(window.output, filters.outputs);
        let last = (self.batch - 1) * self.y.image + (height - 1) * self.y.row + (width - 1) * self.y.pixel;
        assert!(length >= last + filters.outputs, "the output is too short");
        let is_long = residual.is_none_or(|residual| residual.len() >= pixels * filters.outputs);
        assert!(is_long, "the residual is too short");
        if let Some(slopes) = &self.finish.slopes {
            assert!(slopes.len() >= filters.bias.len(), "one slope per output channel, rounded up");
        }
        let down = height.div_ceil(TILE);
        let across = width.div_ceil(TILE);
        let tiles = self.batch * down * across;
        let most = (PIECE / (PRODUCTS * (filters.channels + filters.outputs))).max(1);
        let fair = tiles.div_ceil(4 * compute.pool().threads());
        let at_once = most.min(fair.max(12)).min(tiles);
        let job = Job {
            conv: self,
            x: x.as_ptr(),
            y,
            residual: residual.map_or(std::ptr::null(), <[f32]>::as_ptr),
            tiles: [down, across],
        };
        let isa: Isa = compute.isa();
        compute.pool().run(tiles.div_ceil(at_once), |piece| {
            let range = [piece * at_once, ((piece + 1) * at_once).min(tiles)];
            let count = range[1] - range[0];
            with_buffer(&PATCHES, PRODUCTS * count * filters.channels, |patches| {
                with_buffer(&SUMS, PRODUCTS * count * filters.outputs, |sums| {
                    // SAFETY: sizes have been checked; the buffers are as long as the tiles.
                    unsafe { dispatch_patches(isa, &job, range, patches.as_mut_ptr()) };
                    let size = [1, count];
                    let window = Window {
                        kernel: [1, 1],
                        strides: [1, 1],
                        dilations: [1, 1],
                        pads: [0, 0],
                        input: size,
                        output: size,
                    };
                    let y = Strides::channels_last(size, filters.outputs);
                    let lengths = [count * filters.channels, count * filters.outputs];
                    let of_products = patches.chunks(lengths[0]).zip(sums.chunks_mut(lengths[1]));
                    for (product, (patches, sums)) in filters.products.iter().zip(of_products) {
                        let product = Convolution {
                            filters: Arc::clone(product),
                            window,
                            batch: 1,
                            x: Strides::channels_last(size, filters.channels),
                            y,
                            residual: y,
                            finish: Finish::default(),
                        };
                        // SAFETY: the buffers have the sizes of the product.
                        unsafe { piece::run(&product, None, patches, None, sums.as_mut_ptr()) };
                    }
                    // SAFETY: as above; pieces write disjoint tiles.
                    unsafe { dispatch_outputs(isa, &job, range, sums.as_ptr()) };
                });
            });
        });
    }
}

struct Job<'a> {
    conv: &'a Winograd,
    x: *const f32,
    y: *mut f32,
    residual: *const f32,
    /// Tiles down and across an image.
    tiles: [usize; 2],
}

// SAFETY: pieces read the inputs and write disjoint tiles of the output.
unsafe impl Sync for Job<'_> {}

impl Job<'_> {
    /// Returns the image of a tile, and its first output row and column.
    fn place(&self, tile: usize) -> (usize, [usize; 2]) {
        let [down, across] = self.tiles;
        let (image, at) = (tile / (down * across), tile % (down * across));
        (image, [at / across * TILE, at % across * TILE])
    }
}

for_every_isa!(fn dispatch_patches = transform_patches(job: &Job<'_>, tiles: [usize; 2], to: *mut f32));

/// Writes `B^T patch B` of each tile and channel, a matrix of tiles by channels for each product.
///
/// # Safety
/// The input has the size of the convolution, and `to` that of the tiles.
#[inline(always)]
unsafe fn transform_patches<V: Lanes>(job: &Job<'_>, [first, end]: [usize; 2], to: *mut f32) {
    let (window, channels) = (&job.conv.window, job.conv.filters.channels);
    let step = (end - first) * channels;
    for tile in first..end {
        let (image, [row, column]) = job.place(tile);
        let (top, left) = (row as isize - window.pads[0] as isize, column as isize - window.pads[1] as isize);
        let plane = Plane { start: job.x, image, size: window.input, channels };
        for channel in (0..channels).step_by(V::WIDTH) {
            let count = (channels - channel).min(V::WIDTH);
            // SAFETY: pixels outside of the input are not read.
            unsafe {
                let mut patch = plane.patch::<V, SIZE>([top, left], channel, count);
                for line in &mut patch {
                    *line = of_input(*line);
                }
                let to = to.add((tile - first) * channels + channel);
                for j in 0..SIZE {
                    let column = of_input(patch.map(|line| line[j]));
                    for (i, value) in column.into_iter().enumerate() {
                        let to = to.add((i * SIZE + j) * step);
                        if count == V::WIDTH { value.store(to) } else { value.store_some(to, count) }
                    }
                }
            }
        }
    }
}

/// An image of a batch with channels last.
pub(super) struct Plane {
    pub(super) start: *const f32,
    pub(super) image: usize,
    pub(super) size: [usize; 2],
    pub(super) channels: usize,
}

impl Plane {
    /// Returns a register of channels of each pixel of a square; zeros outside of the image.
    #[inline(always)]
    pub(super) unsafe fn patch<V: Lanes, const N: usize>(
        &self,
        [top, left]: [isize; 2],
        channel: usize,
        count: usize,
    ) -> [[V; N]; N] {
        let [height, width] = self.size;
        // SAFETY: pixels outside of the image are not read.
        unsafe {
            let mut patch = [[V::splat(0.0); N]; N];
            for (i, line) in patch.iter_mut().enumerate() {
                let y = top + i as isize;
                if y < 0 || y >= height as isize {
                    continue;
                }
                let row = (self.image * height + y as usize) * width;
                for (j, value) in line.iter_mut().enumerate() {
                    let x = left + j as isize;
                    if x >= 0 && x < width as isize {
                        let from = self.start.add((row + x as usize) * self.channels + channel);
                        *value = if count == V::WIDTH { V::load(from) } else { V::load_some(from, count) };
                    }
                }
            }
            patch
        }
    }
}

/// Returns `B^T d`.
#[inline(always)]
pub(super) unsafe fn of_input<V: Lanes>(d: [V; SIZE]) -> [V; SIZE] {
    // SAFETY: passed on.
    unsafe {
        let (four, five, two) = (V::splat(4.0), V::splat(-5.0), V::splat(2.0));
        let [a, b, c, d, e, f] = d;
        let even = e.sub(c.mul(four));
        let odd = d.sub(b.mul(four));
        let difference = e.sub(c);
        let twice = d.sub(b).mul(two);
        [
            a.mul_add(four, c.mul_add(five, e)),
            even.add(odd),
            even.sub(odd),
            difference.add(twice),
            difference.sub(twice),
            b.mul_add(four, d.mul_add(five, f)),
        ]
    }
}

for_every_isa!(fn dispatch_outputs = transform_sums(job: &Job<'_>, tiles: [usize; 2], from: *const f32));

/// Writes `A^T sums A` of each tile and output channel, with what follows the sums.
///
/// # Safety
/// The output has the size of the convolution, and `from` that of the tiles.
#[inline(always)]
unsafe fn transform_sums<V: Lanes>(job: &Job<'_>, [first, end]: [usize; 2], from: *const f32) {
    let (conv, outputs) = (job.conv, job.conv.filters.outputs);
    let [height, width] = conv.window.output;
    let step = (end - first) * outputs;
    for tile in first..end {
        let (image, [row, column]) = job.place(tile);
        let (rows, columns) = ((height - row).min(TILE), (width - column).min(TILE));
        for channel in (0..outputs).step_by(V::WIDTH) {
            let count = (outputs - channel).min(V::WIDTH);
            // SAFETY: pixels outside of the output are not written.
            unsafe {
                let load = |from: *const f32| {
                    if count == V::WIDTH { V::load(from) } else { V::load_some(from, count) }
                };
                let from = from.add((tile - first) * outputs + channel);
                let mut half = [[V::splat(0.0); SIZE]; TILE];
                for j in 0..SIZE {
                    let mut sums = [V::splat(0.0); SIZE];
                    for (i, sum) in sums.iter_mut().enumerate() {
                        *sum = load(from.add((i * SIZE + j) * step));
                    }
                    for (line, value) in half.iter_mut().zip(of_sums(sums)) {
                        line[j] = value;
                    }
                }
                let bias = V::load(conv.filters.bias.as_ptr().add(channel));
                for (i, line) in half.into_iter().enumerate().take(rows) {
                    let pixel = (image * height + row + i) * width + column;
                    let y = job
                        .y
                        .add(image * conv.y.image + (row + i) * conv.y.row + column * conv.y.pixel + channel);
                    for (j, sum) in of_sums(line).into_iter().enumerate().take(columns) {
                        let residual = if job.residual.is_null() {
                            None
                        } else {
                            Some(load(job.residual.add((pixel + j) * outputs + channel)))
                        };
                        let value = finished(&conv.finish, sum.add(bias), residual, channel);
                        let to = y.add(j * conv.y.pixel);
                        if count == V::WIDTH { value.store(to) } else { value.store_some(to, count) }
                    }
                }
            }
        }
    }
}

/// Returns a sum with its residual after the activation function.
#[inline(always)]
unsafe fn finished<V: Lanes>(finish: &Finish, sum: V, residual: Option<V>, channel: usize) -> V {
    // SAFETY: passed on; there are slopes for whole registers.
    unsafe {
        let before = residual.filter(|_| !finish.residual_last);
        let value = before.map_or(sum, |residual| sum.add(residual));
        let value = match (&finish.slopes, finish.activation) {
            (Some(slopes), _) => {
                let zero = V::splat(0.0);
                V::load(slopes.as_ptr().add(channel)).mul_add(zero.min(value), zero.max(value))
            }
            (None, Unary::Identity) => value,
            (None, Unary::Relu) => V::splat(0.0).max(value),
            (None, activation) => activation.of(value),
        };
        residual.filter(|_| finish.residual_last).map_or(value, |residual| value.add(residual))
    }
}

/// Returns `A^T m`.
#[inline(always)]
unsafe fn of_sums<V: Lanes>(m: [V; SIZE]) -> [V; TILE] {
    // SAFETY: passed on.
    unsafe {
        let [a, b, c, d, e, f] = m;
        let (sum, difference) = (b.add(c), b.sub(c));
        let (far, apart) = (d.add(e), d.sub(e));
        [
            a.add(sum).add(far),
            apart.mul_add(V::splat(2.0), difference),
            far.mul_add(V::splat(4.0), sum),
            apart.mul_add(V::splat(8.0), difference).add(f),
        ]
    }
}
