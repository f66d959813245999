//! Pooling of tensors with channels last.

use crate::compute::Compute;
use crate::conv::Window;
use crate::isa::for_every_isa;
use crate::lanes::Lanes;

/// What a pooling computes of a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pooling {
    /// The largest number; minus infinity of a window outside of the input.
    Max,
    /// The mean of the numbers that lie within the input.
    Mean,
    /// The mean with zeros around the input, which end after that many below and to the right.
    MeanWithPadding {
        /// Zeros below and to the right.
        pads_after: [usize; 2],
    },
}

impl Pooling {
    /// Pools `batch` images of that many channels.
    ///
    /// # Panics
    /// When the slices are shorter than the shapes require.
    pub fn run(
        self,
        compute: &Compute,
        window: &Window,
        batch: usize,
        channels: usize,
        x: &[f32],
        y: &mut [f32],
    ) {
        let [height, width] = window.output;
        assert!(x.len() >= batch * window.input[0] * window.input[1] * channels, "the input is too short");
        assert_eq!(y.len(), batch * height * width * channels, "the output must have the stated shape");
        if y.is_empty() {
            return;
        }
        let isa = compute.isa();
        compute.pool().run_on_pieces(y, width * channels, |index, y| {
            let job = Job {
                pooling: self,
                window,
                channels,
                x: x[index / height * window.input[0] * window.input[1] * channels..].as_ptr(),
                y: y.as_mut_ptr(),
            };
            // SAFETY: the sizes have been checked; `y` is the row.
            unsafe { dispatch_row(isa, &job, index % height) }
        });
    }
}

struct Job<'a> {
    pooling: Pooling,
    window: &'a Window,
    channels: usize,
    x: *const f32,
    y: *mut f32,
}

/// Returns where a window begins, its first tap within the input, the end of those, and the taps that are counted.
fn taps(job: &Job<'_>, at: usize, axis: usize) -> (isize, usize, usize, usize) {
    let window = job.window;
    let start = (at * window.strides[axis]) as isize - window.pads[axis] as isize;
    let place = |k: usize| start + (k * window.dilations[axis]) as isize;
    let input = window.input[axis] as isize;
    let first = (0..window.kernel[axis]).find(|&k| place(k) >= 0).unwrap_or(window.kernel[axis]);
    let end = (first..window.kernel[axis]).find(|&k| place(k) >= input).unwrap_or(window.kernel[axis]);
    let counted = match job.pooling {
        Pooling::MeanWithPadding { pads_after } => {
            (0..window.kernel[axis]).filter(|&k| place(k) < input + pads_after[axis] as isize).count()
        }
        _ => end - first,
    };
    (start, first, end, counted)
}

for_every_isa!(fn dispatch_row = row(job: &Job<'_>, oy: usize));

/// # Safety
/// The pointers are valid for the shapes of the job.
#[inline(always)]
unsafe fn row<V: Lanes>(job: &Job<'_>, oy: usize) {
    let (window, channels) = (job.window, job.channels);
    let is_max = job.pooling == Pooling::Max;
    let (top, first_row, end_row, rows) = taps(job, oy, 0);
    for ox in 0..window.output[1] {
        let (left, first, end, columns) = taps(job, ox, 1);
        let scale = 1.0 / (rows * columns).max(1) as f32;
        // SAFETY: all taps lie within the input; the last register is counted.
        unsafe {
            for channel in (0..channels).step_by(V::WIDTH) {
                let count = (channels - channel).min(V::WIDTH);
                let mut value = V::splat(if is_max { f32::NEG_INFINITY } else { 0.0 });
                for ky in first_row..end_row {
                    let y = (top + (ky * window.dilations[0]) as isize) as usize;
                    for kx in first..end {
                        let x = (left + (kx * window.dilations[1]) as isize) as usize;
                        let at = job.x.add((y * window.input[1] + x) * channels + channel);
                        let tap = if count == V::WIDTH { V::load(at) } else { V::load_some(at, count) };
                        value = if is_max { value.max(tap) } else { value.add(tap) };
                    }
                }
                if !is_max {
                    value = value.mul(V::splat(scale));
                }
                let to = job.y.add(ox * channels + channel);
                if count == V::WIDTH { value.store(to) } else { value.store_some(to, count) }
            }
        }
    }
}
