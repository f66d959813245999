//! `plain_rten MODEL.onnx DIMS THREADS RUNS [WARMUP]`: prints the milliseconds of each run, a line each.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use rten::{Model, RunOptions, ThreadPool};
use rten_tensor::Tensor;
use rten_tensor::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, dims, threads, runs] = arguments.as_slice() else {
        return Err("usage: plain_rten MODEL.onnx 1,3,H,W THREADS RUNS".into());
    };
    let dims = dims.split(',').map(str::parse).collect::<Result<Vec<usize>, _>>()?;
    // Noise: no run finds more zeros than a photograph has.
    let mut state = 1u32;
    let values = (0..dims.iter().product())
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        })
        .collect::<Vec<_>>();
    let model = Model::load_file(model)?;
    let pool = Arc::new(ThreadPool::with_num_threads(threads.parse()?));
    let input = Tensor::from_data(&dims, values);
    for _ in 0..runs.parse()? {
        let options = RunOptions::default().with_thread_pool(Some(Arc::clone(&pool)));
        let start = Instant::now();
        let outputs = model.run(vec![(model.input_ids()[0], input.view().into())], model.output_ids(), Some(options))?;
        println!("{}", start.elapsed().as_secs_f64() * 1e3);
        drop(outputs);
    }
    Ok(())
}
