//! The inner loop: some pixels of a row by some registers of outputs.

use super::filters::Panel;
use super::geometry::Convolution;
use crate::lanes::Lanes;
use crate::unary::Unary;

/// Rows of a tile with one, two and three registers across: the sums use most registers.
pub(super) const fn most_pixels<V: Lanes>(vectors: usize) -> usize {
    match (V::REGISTERS >= 32, vectors) {
        (true, 1 | 2) => 12,
        (false, 2) => 6,
        (false, 3) => 4,
        _ => 8,
    }
}

/// What all tiles of a row of output pixels share.
pub(super) struct Row<'a> {
    pub(super) conv: &'a Convolution,
    /// First channel of the group in the image.
    pub(super) x: *const f32,
    /// The row of the output, from the first output of the panel on.
    pub(super) y: *mut f32,
    /// The row of the residual, or null.
    pub(super) residual: *const f32,
    pub(super) slopes: *const f32,
    pub(super) panel: Panel,
    /// Row of the input below the first row of taps, which may be negative.
    pub(super) input_row: isize,
    /// Rows of taps that lie within the input.
    pub(super) taps: [usize; 2],
    /// Bounds of the stored sums.
    pub(super) clamp: [f32; 2],
    /// Whether the bounds are all of the activation.
    pub(super) is_clamped: bool,
    /// Zeros for taps beside the input.
    pub(super) zeros: *const f32,
}

/// # Safety
/// The pixels lie in the output; all pointers of `row` are valid for the sizes of its convolution.
#[inline(always)]
pub(super) unsafe fn tile<V: Lanes, const R: usize, const N: usize>(row: &Row, first: usize) {
    let conv = row.conv;
    let window = &conv.window;
    let channels = conv.filters.group_channels();
    // A row of taps: one run of all channels of neighbouring taps, or a run per tap.
    let planar = conv.filters.is_planar();
    let left = (first * window.strides[1]) as isize - window.pads[1] as isize;
    let last = left + ((R - 1) * window.strides[1] + (window.kernel[1] - 1) * window.dilations[1]) as isize;
    let inside = left >= 0 && last < window.input[1] as isize;
    let merged = inside && window.dilations[1] == 1 && (planar || conv.x.pixel == channels);
    let step = conv.x.pixel * window.strides[1];
    // SAFETY: by contract.
    unsafe {
        let mut sums = [[V::splat(0.0); N]; R];
        let runs = if planar { channels } else { 1 };
        let depth = if planar { 1 } else { channels };
        let row_length = window.kernel[1] * channels * N * V::WIDTH;
        for ky in row.taps[0]..row.taps[1] {
            let y = (row.input_row + (ky * window.dilations[0]) as isize) as usize;
            let mut b = row.panel.weights.add(ky * row_length);
            for run in 0..runs {
                let line = row.x.wrapping_add(y * conv.x.row + run * conv.x.channel);
                let (parts, count) =
                    if merged { (1, window.kernel[1] * depth) } else { (window.kernel[1], depth) };
                for kx in 0..parts {
                    let x = left + (kx * window.dilations[1]) as isize;
                    let pixels = if inside {
                        let start = line.wrapping_add(x as usize * conv.x.pixel);
                        std::array::from_fn(|i| start.wrapping_add(i * step))
                    } else {
                        std::array::from_fn(|i| {
                            let x = x + (i * window.strides[1]) as isize;
                            let outside = x < 0 || x >= window.input[1] as isize;
                            if outside { row.zeros } else { line.wrapping_add(x as usize * conv.x.pixel) }
                        })
                    };
                    add_products(&mut sums, pixels, count, b);
                    b = b.wrapping_add(count * N * V::WIDTH);
                }
            }
        }
        store(row, first, &sums);
    }
}

/// A tile of a planar image, all taps of which lie within it, with a constant step between pixels: an instruction
/// reads each number at a distance that it contains.
///
/// # Safety
/// As for [`tile`]; the columns of all taps lie within the input.
#[inline(always)]
pub(super) unsafe fn planar_tile<V: Lanes, const R: usize, const N: usize, const S: usize>(
    row: &Row,
    first: usize,
) {
    let conv = row.conv;
    let window = &conv.window;
    let channels = conv.filters.group_channels();
    let left = first * S - window.pads[1];
    // SAFETY: by contract.
    unsafe {
        let mut sums = [[V::splat(0.0); N]; R];
        let mut b = row.panel.weights.add(row.taps[0] * window.kernel[1] * channels * N * V::WIDTH);
        for ky in row.taps[0]..row.taps[1] {
            let y = (row.input_row + (ky * window.dilations[0]) as isize) as usize;
            for channel in 0..channels {
                let line = row.x.add(y * conv.x.row + channel * conv.x.channel + left);
                for kx in 0..window.kernel[1] {
                    let x = line.add(kx);
                    let mut weights = [V::splat(0.0); N];
                    for (j, weight) in weights.iter_mut().enumerate() {
                        *weight = V::load(b.add(j * V::WIDTH));
                    }
                    for (i, sums) in sums.iter_mut().enumerate() {
                        let x = V::splat(*x.add(i * S));
                        for (sum, &weight) in sums.iter_mut().zip(&weights) {
                            *sum = x.mul_add(weight, *sum);
                        }
                    }
                    b = b.add(N * V::WIDTH);
                }
            }
        }
        store(row, first, &sums);
    }
}

/// Adds the products of `depth` numbers of each pixel and as many rows of weights, in their order.
#[inline(always)]
unsafe fn add_products<V: Lanes, const R: usize, const N: usize>(
    sums: &mut [[V; N]; R],
    pixels: [*const f32; R],
    depth: usize,
    b: *const f32,
) {
    // SAFETY: the caller's promise.
    unsafe {
        let mut local = *sums;
        let whole = depth / 4 * 4;
        let mut step = 0;
        while step < whole {
            for k in step..step + 4 {
                add_step(&mut local, &pixels, k, b.add(k * N * V::WIDTH));
            }
            step += 4;
        }
        for k in whole..depth {
            add_step(&mut local, &pixels, k, b.add(k * N * V::WIDTH));
        }
        *sums = local;
    }
}

#[inline(always)]
unsafe fn add_step<V: Lanes, const R: usize, const N: usize>(
    sums: &mut [[V; N]; R],
    pixels: &[*const f32; R],
    k: usize,
    b: *const f32,
) {
    // SAFETY: the caller's promise.
    unsafe {
        let mut weights = [V::splat(0.0); N];
        for (j, weight) in weights.iter_mut().enumerate() {
            *weight = V::load(b.add(j * V::WIDTH));
        }
        for i in 0..R {
            let x = V::splat(*pixels[i].add(k));
            for j in 0..N {
                sums[i][j] = x.mul_add(weights[j], sums[i][j]);
            }
        }
    }
}

/// Adds the bias to a tile and stores it, clamped: that is the identity, ReLU and ReLU6. Other functions follow in [`finish`].
///
/// The bias comes last: a sum that begins with a large bias loses the low bits of every product.
#[inline(always)]
unsafe fn store<V: Lanes, const R: usize, const N: usize>(row: &Row, first: usize, sums: &[[V; N]; R]) {
    let stride = row.conv.y.pixel;
    // SAFETY: pixels and outputs lie within the output; registers of an incomplete panel are counted.
    unsafe {
        let y = row.y.add(first * stride);
        let (low, high) = (V::splat(row.clamp[0]), V::splat(row.clamp[1]));
        let mut bias = [V::splat(0.0); N];
        for (j, bias) in bias.iter_mut().enumerate() {
            *bias = V::load(row.panel.bias.add(j * V::WIDTH));
        }
        if row.panel.used >= N * V::WIDTH {
            for (i, sums) in sums.iter().enumerate() {
                for (j, &sum) in sums.iter().enumerate() {
                    high.min(low.max(sum.add(bias[j]))).store(y.add(i * stride + j * V::WIDTH));
                }
            }
            return;
        }
        for (i, sums) in sums.iter().enumerate() {
            for (&sum, (bias, at)) in
                sums.iter().zip(bias.into_iter().zip((0..row.panel.used).step_by(V::WIDTH)))
            {
                let value = high.min(low.max(sum.add(bias)));
                let (to, count) = (y.add(i * stride + at), row.panel.used - at);
                if count >= V::WIDTH { value.store(to) } else { value.store_some(to, count) }
            }
        }
    }
}

/// Adds the residual and applies the activation function to stored sums.
///
/// # Safety
/// The pixels lie in the output; all pointers of `row` are valid for the sizes of its convolution.
#[inline(always)]
pub(super) unsafe fn finish<V: Lanes>(row: &Row, [first, end]: [usize; 2]) {
    let conv = row.conv;
    let used = row.panel.used.min(row.panel.vectors * V::WIDTH);
    let activation = if row.is_clamped { Unary::Identity } else { conv.finish.activation };
    let zero = |from: *const f32| from.is_null();
    // Where the panel has all channels, pixels are one run: few channels would leave registers empty.
    let is_run =
        zero(row.slopes) && used == conv.y.pixel && (zero(row.residual) || conv.residual.pixel == used);
    let pixels = if is_run { first..first + 1 } else { first..end };
    let length = if is_run { (end - first) * used } else { used };
    // SAFETY: by contract; partial registers are counted.
    unsafe {
        for pixel in pixels {
            let y = row.y.add(pixel * conv.y.pixel);
            for j in (0..length).step_by(V::WIDTH) {
                let count = (length - j).min(V::WIDTH);
                let load = |from: *const f32| {
                    if count == V::WIDTH { V::load(from) } else { V::load_some(from, count) }
                };
                let mut value: V = load(y.add(j));
                let residual = if zero(row.residual) {
                    None
                } else {
                    Some(row.residual.add(pixel * conv.residual.pixel + j))
                };
                if let Some(residual) = residual.filter(|_| !conv.finish.residual_last) {
                    value = value.add(load(residual));
                }
                if zero(row.slopes) {
                    value = activation.of(value);
                } else {
                    let none = V::splat(0.0);
                    value = V::load(row.slopes.add(j)).mul_add(none.min(value), none.max(value));
                }
                if let Some(residual) = residual.filter(|_| conv.finish.residual_last) {
                    value = value.add(load(residual));
                }
                if count == V::WIDTH { value.store(y.add(j)) } else { value.store_some(y.add(j), count) }
            }
        }
    }
}
