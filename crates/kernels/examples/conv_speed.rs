//! Prints the speed of convolutions: `cargo run --release -p opendr-kernels --example conv_speed`.
//!
//! One line for each case: size, microseconds (the fastest of many runs), GFLOPS.

use std::sync::Arc;
use std::time::Instant;

use opendr_engine::Random;
use opendr_kernels::{
    Compute, Convolution, DepthwiseConvolution, DepthwiseFilters, Filters, Finish, Strides, Window,
};

fn main() {
    let compute = Compute::single();
    println!("# {} on 1 thread", compute.isa());
    for [size, channels, outputs, kernel, stride] in [
        [416, 3, 32, 3, 2],
        [256, 3, 16, 7, 2],
        [208, 12, 16, 3, 1],
        [160, 16, 16, 3, 1],
        [160, 16, 16, 1, 1],
        [160, 16, 32, 1, 1],
        [208, 32, 64, 3, 2],
        [104, 64, 64, 3, 1],
        [104, 32, 32, 3, 1],
        [52, 64, 64, 3, 1],
        [52, 128, 128, 1, 1],
        [26, 128, 128, 3, 1],
        [26, 256, 256, 1, 1],
        [13, 512, 512, 1, 1],
        [13, 256, 512, 3, 1],
    ] {
        let window = square(size, kernel, stride);
        let output = window.output[0];
        let mut random = Random::new(1);
        let mut numbers =
            |count: usize| -> Vec<f32> { (0..count).map(|_| random.uniform(-1.0, 1.0)).collect() };
        let (x, weights) = (numbers(size * size * channels), numbers(outputs * channels * kernel * kernel));
        let planar = channels < 8;
        let filters = Filters::new(&compute, &weights, [1, outputs, channels], window.kernel, None, planar);
        let strides = if planar {
            Strides::planar(window.input, channels)
        } else {
            Strides::channels_last(window.input, channels)
        };
        let y_strides = Strides::channels_last(window.output, outputs);
        let conv = Convolution {
            filters: Arc::new(filters),
            window,
            batch: 1,
            x: strides,
            y: y_strides,
            residual: y_strides,
            finish: Finish::default(),
        };
        let mut y = vec![0.0; output * output * outputs];
        let operations = (2 * output * output * outputs * channels * kernel * kernel) as f64;
        report(
            &format!("conv {size}x{size}x{channels}->{outputs} {kernel}x{kernel}/{stride}"),
            operations,
            || {
                conv.run(&compute, &x, None, &mut y);
            },
        );
    }
    for [size, channels, kernel, stride] in [
        [112, 32, 3, 1],
        [112, 64, 3, 2],
        [56, 128, 3, 1],
        [28, 96, 5, 1],
        [14, 512, 3, 1],
        [7, 960, 3, 1],
        [28, 72, 3, 1],
        [28, 120, 5, 1],
        [14, 480, 3, 2],
    ] {
        let window = square(size, kernel, stride);
        let output = window.output[0];
        let (mut x, mut y) = (Vec::new(), Vec::new());
        let x = aligned(&mut x, size * size * channels);
        let y = aligned(&mut y, output * output * channels);
        let filters =
            DepthwiseFilters::new(&vec![0.1; channels * kernel * kernel], channels, window.kernel, None);
        let depthwise = DepthwiseConvolution {
            filters: Arc::new(filters),
            window,
            batch: 1,
            x: Strides::channels_last(window.input, channels),
            y: Strides::channels_last(window.output, channels),
            finish: Finish::default(),
        };
        let operations = (2 * output * output * channels * kernel * kernel) as f64;
        report(&format!("depthwise {size}x{size}x{channels} {kernel}x{kernel}/{stride}"), operations, || {
            depthwise.run(&compute, x, y);
        });
    }
}

/// Returns `length` numbers that begin at a cache line, as those of the executor's arena.
fn aligned(numbers: &mut Vec<f32>, length: usize) -> &mut [f32] {
    numbers.resize(length + 16, 0.5);
    let first = numbers.as_ptr().align_offset(64);
    &mut numbers[first..][..length]
}

fn square(size: usize, kernel: usize, stride: usize) -> Window {
    let output = (size - 1) / stride + 1;
    Window {
        kernel: [kernel; 2],
        strides: [stride; 2],
        dilations: [1; 2],
        pads: [kernel / 2; 2],
        input: [size; 2],
        output: [output; 2],
    }
}

fn report(name: &str, operations: f64, mut call: impl FnMut()) {
    let mut best = f64::INFINITY;
    for _ in 0..40 {
        let start = Instant::now();
        call();
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("{name} {:.1} {:.1}", best * 1e6, operations / best / 1e9);
}
