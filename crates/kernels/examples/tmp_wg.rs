use opendr_kernels::*;
use std::time::Instant;
fn main() {
    for threads in [1, 2] {
        let compute = Compute::with_threads(threads);
        for (c, size, b) in [(64, 32, 64), (128, 16, 64), (256, 8, 64), (512, 4, 64)] {
            for k in [3usize, 1] {
                let window = Window {
                    kernel: [k; 2],
                    strides: [1; 2],
                    dilations: [1; 2],
                    pads: [k / 2; 2],
                    input: [size; 2],
                    output: [size; 2],
                };
                let conv = TrainingConvolution { batch: b, channels: c, outputs: c, groups: 1, window };
                let x = vec![0.5; conv.input_length()];
                let w = vec![0.5; conv.weights_length()];
                let mut y = vec![0.5; conv.output_length()];
                let mut dw = w.clone();
                let mut dx = x.clone();
                let flop = 2.0 * (conv.output_length() * c * k * k) as f64;
                let mut best = [f64::MAX; 3];
                for _ in 0..7 {
                    let t = Instant::now();
                    y = conv.forward(&compute, &x, &w, None);
                    best[0] = best[0].min(t.elapsed().as_secs_f64());
                    let t = Instant::now();
                    dx = conv.input_gradient(&compute, &w, &y);
                    best[1] = best[1].min(t.elapsed().as_secs_f64());
                    let t = Instant::now();
                    conv.weight_gradient(&compute, &x, &y, &mut dw);
                    best[2] = best[2].min(t.elapsed().as_secs_f64());
                }
                println!(
                    "{threads} threads {k}x{k} {c} ch {size}: GFLOP/s forward {:.0} dx {:.0} dw {:.0}",
                    flop / best[0] / 1e9,
                    flop / best[1] / 1e9,
                    flop / best[2] / 1e9
                );
            }
        }
    }
}
