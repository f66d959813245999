//! Division of a convolution into pieces, and the loop over the tiles of a piece.

use super::filters::width_of;
use super::geometry::{Convolution, Strides, Window};
use super::tile::{Row, finish, most_pixels, planar_tile, tile};
use crate::compute::Compute;
use crate::isa::for_every_isa;
use crate::lanes::Lanes;
use crate::pool::WorkerPool;
use crate::unary::Unary;

/// Number of multiplications from which on several threads are used.
const PARALLEL_FROM: usize = 1 << 17;
/// Numbers of the input that a piece reads: they stay in the L2 cache while all weights pass.
const PIECE_INPUT: usize = 1 << 16;
/// Multiplications of a piece, where there are more pieces than 4 per thread.
const PIECE_PRODUCTS: usize = 1 << 21;
/// Pixels whose sums are stored before the rest of the work on them: they stay in the L1 cache.
const FINISHED: usize = 72;
const ZEROS: usize = 4096;
static NOTHING: [f32; ZEROS] = [0.0; ZEROS];

struct Job<'a> {
    conv: &'a Convolution,
    x: *const f32,
    y: *mut f32,
    residual: *const f32,
    zeros: *const f32,
    /// Pixels of a row per piece, pieces per row, rows per piece, pieces per column.
    pixels: usize,
    across: usize,
    rows: usize,
    down: usize,
    /// Panels per piece, pieces per group.
    panels: usize,
    shares: usize,
}

// SAFETY: pieces read the inputs and write disjoint parts of the output.
unsafe impl Sync for Job<'_> {}

impl Convolution {
    /// Computes the convolution. `residual` has the shape of the output.
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
        let Window { input, output, .. } = self.window;
        let filters = &*self.filters;
        if self.batch == 0 || output.contains(&0) || filters.outputs() == 0 {
            return;
        }
        assert_eq!(filters.kernel(), self.window.kernel, "the filters must have the size of the kernel");
        self.y.check_written(output, filters.outputs());
        let side_by_side = if filters.is_planar() { self.x.pixel } else { self.x.channel };
        assert_eq!(side_by_side, 1, "pixels of planes, or channels of pixels, must lie side by side");
        let reach = |at: Strides, [height, width]: [usize; 2], channels: usize| {
            (self.batch - 1) * at.image
                + height.saturating_sub(1) * at.row
                + width.saturating_sub(1) * at.pixel
                + channels.saturating_sub(1) * at.channel
                + 1
        };
        assert!(
            input.contains(&0) || x.len() >= reach(self.x, input, filters.channels()),
            "the input is too short"
        );
        assert!(length >= reach(self.y, output, filters.outputs()), "the output is too short");
        if let Some(residual) = residual {
            assert_eq!(self.residual.channel, 1, "the channels of the residual must lie side by side");
            assert!(
                residual.len() >= reach(self.residual, output, filters.outputs()),
                "the residual is too short"
            );
        }
        if let Some(slopes) = &self.finish.slopes {
            assert!(slopes.len() >= filters.padded_outputs(), "one slope per output channel, rounded up");
        }
        // SAFETY: sizes have been checked.
        unsafe { run(self, Some(compute.pool()), x, residual, y) };
    }
}

/// Computes a convolution on the threads of a pool, or on this one.
///
/// # Safety
/// The sizes have been checked; the output may be written, and nothing else uses it.
pub(super) unsafe fn run(
    conv: &Convolution,
    pool: Option<&WorkerPool>,
    x: &[f32],
    residual: Option<&[f32]>,
    y: *mut f32,
) {
    let mut flat;
    let mut conv = conv;
    let window = conv.window;
    let [height, width] = window.output;
    let rows_join = conv.y.row == width * conv.y.pixel
        && conv.x.row == width * conv.x.pixel
        && (residual.is_none() || conv.residual.row == width * conv.residual.pixel);
    let in_order = window.kernel[0] == 1 || !conv.filters.is_planar();
    if window.is_columnwise() && in_order && rows_join && height > 1 {
        // One long row, whose taps are as far apart as rows: no tile ends at the end of a row.
        let [input, _] = window.input;
        flat = conv.clone();
        flat.window = Window {
            kernel: [1, window.kernel[0]],
            dilations: [1, window.dilations[0] * width],
            pads: [0, window.pads[0] * width],
            input: [1, input * width],
            output: [1, height * width],
            ..window
        };
        conv = &flat;
    }
    let zeros: Vec<f32> = if conv.filters.group_channels() > ZEROS {
        vec![0.0; conv.filters.group_channels()]
    } else {
        Vec::new()
    };
    let mut job = divide(conv, pool.map_or(1, WorkerPool::threads));
    job.x = x.as_ptr();
    job.y = y;
    job.residual = residual.map_or(std::ptr::null(), <[f32]>::as_ptr);
    job.zeros = if zeros.is_empty() { NOTHING.as_ptr() } else { zeros.as_ptr() };
    let pieces = conv.batch * job.across * job.down * job.shares * conv.filters.groups();
    let isa = conv.filters.isa();
    // SAFETY: all sizes have been checked; pieces do not overlap.
    let work = |piece| unsafe { dispatch_piece(isa, &job, piece) };
    match pool.filter(|_| products(conv) >= PARALLEL_FROM) {
        Some(pool) => pool.run(pieces, work),
        None => (0..pieces).for_each(work),
    }
}

/// Returns the number of multiplications.
fn products(conv: &Convolution) -> usize {
    let [height, width] = conv.window.output;
    conv.batch * height * width * conv.filters.depth() * conv.filters.outputs()
}

fn divide(conv: &Convolution, threads: usize) -> Job<'_> {
    let [height, width] = conv.window.output;
    let filters = &*conv.filters;
    let (panels, depth) = (filters.panel_count(), filters.depth());
    let pixel_input = filters.group_channels() * conv.window.strides[0] * conv.window.strides[1];
    let output_pixels = (PIECE_INPUT / pixel_input.max(1)).max(24);
    let weights = depth * filters.group_outputs();
    let input = conv.window.input[0] * conv.window.input[1] * filters.group_channels();
    let mut job = Job {
        conv,
        x: std::ptr::null(),
        y: std::ptr::null_mut(),
        residual: std::ptr::null(),
        zeros: std::ptr::null(),
        pixels: width,
        across: 1,
        rows: height,
        down: 1,
        panels,
        shares: 1,
    };
    if weights > input && panels >= 2 * threads && threads > 1 {
        // Each thread reads a part of the weights and the whole input.
        job.panels = panels.div_ceil(threads * (panels / threads).min(4));
        job.shares = panels.div_ceil(job.panels);
    }
    // Many pieces end at the same time on all threads, but each costs as much to begin as some of its products.
    let pieces = (products(conv) / PIECE_PRODUCTS).clamp(4 * threads, 16 * threads);
    let wanted = if job.shares > 1 || threads == 1 { 1 } else { pieces };
    let tile = 24;
    if height == 1 {
        let most = output_pixels.min(width.div_ceil(wanted)).max(tile);
        job.pixels = most.div_ceil(tile) * tile;
        job.across = width.div_ceil(job.pixels);
    } else {
        job.rows = (output_pixels / width).min(height.div_ceil(wanted)).clamp(1, height);
        job.down = height.div_ceil(job.rows);
    }
    job
}

for_every_isa!(fn dispatch_piece = piece_in_tiles(job: &Job<'_>, piece: usize));

/// # Safety
/// The pointers of `job` are valid for its convolution.
#[inline(always)]
unsafe fn piece_in_tiles<V: Lanes>(job: &Job<'_>, piece: usize) {
    let conv = job.conv;
    let filters = &*conv.filters;
    debug_assert_eq!(width_of(filters.isa()), V::WIDTH);
    let window = &conv.window;
    let (clamp, is_clamped, is_finished) = bounds(job);
    let (share, piece) = (piece % job.shares, piece / job.shares);
    let (across, piece) = (piece % job.across, piece / job.across);
    let (down, piece) = (piece % job.down, piece / job.down);
    let (group, image) = (piece % filters.groups(), piece / filters.groups());
    let (first_row, first_pixel) = (down * job.rows, across * job.pixels);
    let last_row = (first_row + job.rows).min(window.output[0]);
    let last_pixel = (first_pixel + job.pixels).min(window.output[1]);
    let last_panel = ((share + 1) * job.panels).min(filters.panel_count());
    for panel in share * job.panels..last_panel {
        let panel = filters.panel(group, panel);
        for oy in first_row..last_row {
            let input_row = window.first_tap(0, oy);
            let taps = window.taps_inside(0, input_row);
            // SAFETY: the sizes have been checked.
            unsafe {
                let residual = if job.residual.is_null() {
                    job.residual
                } else {
                    job.residual.add(image * conv.residual.image + oy * conv.residual.row + panel.first)
                };
                let slopes = conv
                    .finish
                    .slopes
                    .as_ref()
                    .map_or(std::ptr::null(), |slopes| slopes.as_ptr().add(panel.padded_first));
                let row = Row {
                    conv,
                    x: job.x.add(image * conv.x.image + group * filters.group_channels() * conv.x.channel),
                    y: job.y.add(image * conv.y.image + oy * conv.y.row + panel.first),
                    residual,
                    slopes,
                    panel,
                    input_row,
                    taps,
                    clamp,
                    is_clamped,
                    zeros: job.zeros,
                };
                for first in (first_pixel..last_pixel).step_by(FINISHED) {
                    let end = (first + FINISHED).min(last_pixel);
                    match panel.vectors {
                        1 => pixels::<V, 1>(&row, first, end),
                        2 => pixels::<V, 2>(&row, first, end),
                        _ => pixels::<V, 3>(&row, first, end),
                    }
                    if !is_finished {
                        finish::<V>(&row, [first, end]);
                    }
                }
            }
        }
    }
}

/// Returns the bounds of stored sums, whether they are the activation, and whether nothing else follows.
fn bounds(job: &Job<'_>) -> ([f32; 2], bool, bool) {
    let finish = &job.conv.finish;
    let all = [f32::NEG_INFINITY, f32::INFINITY];
    if finish.slopes.is_some() || (!job.residual.is_null() && !finish.residual_last) {
        return (all, false, false);
    }
    let (clamp, is_clamped) = match finish.activation {
        Unary::Identity => (all, true),
        Unary::Relu => ([0.0, f32::INFINITY], true),
        Unary::Clip { low, high } => ([low, high], true),
        _ => (all, false),
    };
    (clamp, is_clamped, is_clamped && job.residual.is_null())
}

/// Runs the tiles of some pixels: as few as possible, of nearly equal size.
#[inline(always)]
unsafe fn pixels<V: Lanes, const N: usize>(row: &Row, first: usize, end: usize) {
    let most = most_pixels::<V>(N);
    let window = &row.conv.window;
    let step = if row.conv.filters.is_planar() && window.dilations[1] == 1 { window.strides[1] } else { 0 };
    // Output pixels all of whose taps lie within the row.
    let inner_end = (window.input[1] + window.pads[1])
        .checked_sub(window.kernel[1])
        .map_or(0, |last| last / window.strides[1] + 1);
    let mut at = first;
    while at < end {
        let left = end - at;
        if (step == 1 || step == 2) && left >= most && at * step >= window.pads[1] && at + most <= inner_end {
            // SAFETY: passed on.
            unsafe {
                match (most, step) {
                    (4, 1) => planar_tile::<V, 4, N, 1>(row, at),
                    (4, _) => planar_tile::<V, 4, N, 2>(row, at),
                    (6, 1) => planar_tile::<V, 6, N, 1>(row, at),
                    (6, _) => planar_tile::<V, 6, N, 2>(row, at),
                    (8, 1) => planar_tile::<V, 8, N, 1>(row, at),
                    (8, _) => planar_tile::<V, 8, N, 2>(row, at),
                    (_, 1) => planar_tile::<V, 12, N, 1>(row, at),
                    _ => planar_tile::<V, 12, N, 2>(row, at),
                }
            }
            at += most;
            continue;
        }
        // At the left edge of a planar image a single pixel, so that the others are inner ones.
        let size =
            if step > 0 && at * step < window.pads[1] { 1 } else { left.div_ceil(left.div_ceil(most)) };
        // SAFETY: passed on.
        unsafe {
            match size {
                1 => tile::<V, 1, N>(row, at),
                2 => tile::<V, 2, N>(row, at),
                3 => tile::<V, 3, N>(row, at),
                4 => tile::<V, 4, N>(row, at),
                5 if most > 4 => tile::<V, 5, N>(row, at),
                6 if most > 4 => tile::<V, 6, N>(row, at),
                7 if most > 6 => tile::<V, 7, N>(row, at),
                8 if most > 6 => tile::<V, 8, N>(row, at),
                9 if most > 8 => tile::<V, 9, N>(row, at),
                10 if most > 8 => tile::<V, 10, N>(row, at),
                11 if most > 8 => tile::<V, 11, N>(row, at),
                _ if most > 8 => tile::<V, 12, N>(row, at),
                _ => (),
            }
        }
        at += size;
    }
}
