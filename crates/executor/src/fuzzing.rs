//! What a fuzz target feeds.

use opendr_kernels::Compute;

use crate::{Data, Executor, Kind, Tensor};

/// Largest number of elements of an input.
const LARGEST: usize = 1 << 16;

/// Opens a model. Where it opens, runs it on ones of the types that it declares, with 2 for each open dimension.
pub fn model(bytes: &[u8]) {
    let Ok(mut executor) = Executor::open(bytes, Compute::single()) else { return };
    let shapes: Vec<Vec<usize>> =
        executor.input_shapes().map(|dims| dims.iter().map(|dim| dim.unwrap_or(2)).collect()).collect();
    let count = |shape: &Vec<usize>| shape.iter().try_fold(1, |count: usize, dim| count.checked_mul(*dim));
    let counts: Option<Vec<usize>> = shapes.iter().map(count).collect();
    let Some(counts) = counts.filter(|counts| counts.iter().all(|count| *count <= LARGEST)) else { return };
    let most = counts.iter().copied().max().unwrap_or(0);
    let (floats, longs, ints) = (vec![1.0; most], vec![1; most], vec![1; most]);
    let (bytes, signed) = (vec![1; most], vec![1; most]);
    let kinds: Vec<Kind> = executor.inputs().map(|(_, kind)| kind).collect();
    let inputs = shapes.iter().zip(counts).zip(kinds).map(|((shape, count), kind)| {
        let data = match kind {
            Kind::F32 | Kind::F16 => Data::F32(&floats[..count]),
            Kind::I64 => Data::I64(&longs[..count]),
            Kind::I32 => Data::I32(&ints[..count]),
            Kind::U8 => Data::U8(&bytes[..count]),
            Kind::I8 => Data::I8(&signed[..count]),
            Kind::Bool => Data::Bool(&bytes[..count]),
        };
        Tensor { shape, data }
    });
    executor.run(&inputs.collect::<Vec<_>>(), &mut |_| Ok(())).ok();
}
