//! The number of threads changes no bit.

use std::sync::Arc;

use opendr_engine::Random;
use opendr_executor::{Data, Executor, Tensor};
use opendr_kernels::{Compute, Isa, WorkerPool};

#[test]
fn every_number_of_threads_gives_the_same_bits() {
    let weights = crate::root().join("models/weights");
    for (file, shape) in [
        ("bisenet/drawn_streets.onnx", vec![1, 3, 96, 128]),
        ("efficient_lps/streets.onnx", vec![1, 5, 64, 512]),
        ("spatio_temporal_gcn/jhmdb.onnx", vec![1, 6, 32, 15]),
        ("gated_recurrent_unit/ecg5000.onnx", vec![1, 140, 1]),
    ] {
        let bytes = std::fs::read(weights.join(file)).unwrap();
        let mut random = Random::new(3);
        let x: Vec<f32> = (0..shape.iter().product()).map(|_| random.uniform(-1.0, 1.0)).collect();
        let mut wanted: Vec<Vec<u32>> = Vec::new();
        for threads in [1, 2, 3, 5] {
            let compute = Compute::new(Isa::best(), Arc::new(WorkerPool::new(threads)));
            let mut executor = Executor::open(&bytes, compute).unwrap();
            for _ in 0..2 {
                let mut bits = Vec::new();
                executor
                    .run(&[Tensor { shape: &shape, data: Data::F32(&x) }], &mut |outputs| {
                        for output in outputs {
                            if let Data::F32(values) = output.data {
                                bits.push(values.iter().map(|value| value.to_bits()).collect());
                            }
                        }
                        Ok(())
                    })
                    .unwrap();
                if wanted.is_empty() {
                    wanted = bits;
                } else {
                    assert!(bits == wanted, "{file} with {threads} threads");
                }
            }
        }
    }
}
