//! Damaged files: an error or a result, never a panic.

use opendr_engine::Random;
use opendr_executor::{Data, Executor, Tensor, fuzzing};
use opendr_kernels::Compute;

use crate::control_flow::{branches, growing, sums};
use crate::data_shapes::positive;
use crate::graphs::bytes;

/// Small networks of this repository, which have most operators between them.
const FILES: [&str; 5] = [
    "keypoint_gesture/hand.onnx",
    "image_classifier/masked_face.onnx",
    "gated_recurrent_unit/ecg5000.onnx",
    "vpit/streets.onnx",
    "co_st_gcn/jhmdb.onnx",
];

fn weights() -> std::path::PathBuf {
    crate::root().join("models/weights")
}

/// Opens a model and runs it, where it opens, on zeros.
fn open_and_run(bytes: &[u8]) {
    let Ok(mut executor) = Executor::open(bytes, Compute::single()) else { return };
    let shapes: Vec<Vec<usize>> =
        executor.input_shapes().map(|dims| dims.iter().map(|dim| dim.unwrap_or(2)).collect()).collect();
    let counts: Vec<usize> = shapes.iter().map(|shape| shape.iter().product()).collect();
    if counts.iter().any(|&count| count > 1 << 22) {
        return;
    }
    let zeros: Vec<Vec<f32>> = counts.iter().map(|&count| vec![0.0; count]).collect();
    let inputs: Vec<Tensor<'_>> =
        shapes.iter().zip(&zeros).map(|(shape, zeros)| Tensor { shape, data: Data::F32(zeros) }).collect();
    let _ = executor.run(&inputs, &mut |_| Ok(()));
}

#[test]
fn mutations_of_loops_and_branches_end_in_an_error_or_a_result() {
    let mut random = Random::new(12);
    let mut next = |most: usize| (random.uniform(0.0, 1.0) * most as f32) as usize;
    for graph in [sums(), growing(), branches("c", &[]), positive()] {
        let bytes = bytes(graph);
        fuzzing::model(&bytes);
        for _ in 0..1500 {
            let mut mutated = bytes.clone();
            for _ in 0..=next(2) {
                let at = next(bytes.len()).min(bytes.len() - 1);
                mutated[at] =
                    if next(2) == 0 { next(256) as u8 } else { mutated[at] ^ (1 << next(8).min(7)) };
            }
            fuzzing::model(&mutated);
        }
    }
}

#[test]
fn mutations_of_real_files_end_in_an_error_or_a_result() {
    let mut random = Random::new(11);
    let mut next = |most: usize| (random.uniform(0.0, 1.0) * most as f32) as usize;
    for file in FILES {
        let bytes = std::fs::read(weights().join(file)).unwrap();
        open_and_run(&bytes);
        // Most of a file is weights; the graph is at both ends.
        for _ in 0..400 {
            let mut mutated = bytes.clone();
            for _ in 0..=next(3) {
                let at = match next(3) {
                    0 => next(bytes.len()),
                    1 => next(bytes.len().min(2000)),
                    _ => bytes.len() - 1 - next(bytes.len().min(2000)),
                };
                let at = at.min(bytes.len() - 1);
                mutated[at] = match next(3) {
                    0 => next(256) as u8,
                    1 => mutated[at] ^ (1 << next(8).min(7)),
                    _ => [0, 1, 0x7f, 0x80, 0xff][next(5).min(4)],
                };
            }
            open_and_run(&mutated);
        }
        for _ in 0..40 {
            open_and_run(&bytes[..next(bytes.len())]);
        }
    }
}
