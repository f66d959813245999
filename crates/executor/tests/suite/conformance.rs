//! The node tests of the PyPI package `onnx` for the operators that the executor claims.
//!
//! `OPENDR_ONNX_NODE_TESTS` is the folder `onnx/backend/test/data/node` of an installed package; without it the test
//! ends at once.

use std::collections::BTreeMap;
use std::path::Path;

use opendr_engine::ErrorKind;
use opendr_executor::{Data, Executor, Tensor, supported_operators};
use opendr_kernels::Compute;
use opendr_onnx::model_from_bytes;
use opendr_onnx::proto::TensorProto;
use prost::Message as _;

/// Elements of a test tensor, of a type that the executor has.
enum Elements {
    F32(Vec<f32>),
    I64(Vec<i64>),
    I32(Vec<i32>),
    U8(Vec<u8>),
    I8(Vec<i8>),
    Bool(Vec<u8>),
}

fn read(path: &Path) -> Option<(Vec<usize>, Elements)> {
    let tensor = TensorProto::decode(std::fs::read(path).ok()?.as_slice()).ok()?;
    let shape: Vec<usize> = tensor.dims.iter().map(|&dim| dim as usize).collect();
    let raw = &tensor.raw_data;
    let elements = match tensor.data_type {
        1 => Elements::F32(raw.as_chunks().0.iter().map(|&b| f32::from_le_bytes(b)).collect()),
        7 => Elements::I64(raw.as_chunks().0.iter().map(|&b| i64::from_le_bytes(b)).collect()),
        6 => Elements::I32(raw.as_chunks().0.iter().map(|&b| i32::from_le_bytes(b)).collect()),
        2 => Elements::U8(raw.clone()),
        3 => Elements::I8(raw.iter().map(|&b| b as i8).collect()),
        9 => Elements::Bool(raw.clone()),
        _ => return None,
    };
    Some((shape, elements))
}

fn view((shape, elements): &(Vec<usize>, Elements)) -> Tensor<'_> {
    let data = match elements {
        Elements::F32(data) => Data::F32(data),
        Elements::I64(data) => Data::I64(data),
        Elements::I32(data) => Data::I32(data),
        Elements::U8(data) => Data::U8(data),
        Elements::I8(data) => Data::I8(data),
        Elements::Bool(data) => Data::Bool(data),
    };
    Tensor { shape, data }
}

fn differs(wanted: &Tensor<'_>, got: &Tensor<'_>) -> bool {
    if wanted.shape != got.shape {
        return true;
    }
    match (wanted.data, got.data) {
        (Data::F32(a), Data::F32(b)) => a.iter().zip(b).any(|(a, b)| {
            let same = a == b || (a.is_nan() && b.is_nan());
            !same && ((a - b).abs() / a.abs().max(1.0)).partial_cmp(&1e-3) != Some(std::cmp::Ordering::Less)
        }),
        (Data::I64(a), Data::I64(b)) => a != b,
        (Data::I32(a), Data::I32(b)) => a != b,
        (Data::U8(a), Data::U8(b)) | (Data::Bool(a), Data::Bool(b)) => a != b,
        (Data::I8(a), Data::I8(b)) => a != b,
        _ => true,
    }
}

/// Runs one test; `None` where the executor refuses the model or has no such type.
fn run(folder: &Path) -> Option<bool> {
    let bytes = std::fs::read(folder.join("model.onnx")).ok()?;
    let mut executor = match Executor::open(&bytes, Compute::single()) {
        Ok(executor) => executor,
        Err(error) if error.kind() == ErrorKind::Unsupported => return None,
        Err(error) => {
            println!("{}: {error}", folder.display());
            return Some(false);
        }
    };
    let set = folder.join("test_data_set_0");
    let inputs: Option<Vec<_>> =
        (0..executor.inputs().count()).map(|i| read(&set.join(format!("input_{i}.pb")))).collect();
    let wanted: Option<Vec<_>> =
        (0..executor.outputs().count()).map(|i| read(&set.join(format!("output_{i}.pb")))).collect();
    let (inputs, wanted) = (inputs?, wanted?);
    let inputs: Vec<Tensor<'_>> = inputs.iter().map(view).collect();
    let mut is_equal = true;
    let ran = executor.run(&inputs, &mut |outputs| {
        is_equal = outputs.iter().zip(&wanted).all(|(got, wanted)| !differs(&view(wanted), got));
        Ok(())
    });
    match ran {
        Ok(()) => Some(is_equal),
        Err(error) if error.kind() == ErrorKind::Unsupported => None,
        Err(error) => {
            println!("{}: {error}", folder.display());
            Some(false)
        }
    }
}

#[test]
fn node_tests_of_claimed_operators_pass() {
    let Ok(root) = std::env::var("OPENDR_ONNX_NODE_TESTS") else { return };
    let claimed: Vec<&str> = supported_operators().collect();
    let mut counts: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    let mut wrong = Vec::new();
    for entry in std::fs::read_dir(root).unwrap() {
        let folder = entry.unwrap().path();
        let Ok(bytes) = std::fs::read(folder.join("model.onnx")) else { continue };
        let Ok(model) = model_from_bytes(&bytes) else { continue };
        let graph = model.graph.unwrap_or_default();
        let [node] = graph.node.as_slice() else { continue };
        if !claimed.contains(&node.op_type.as_str()) || !model.functions.is_empty() {
            continue;
        }
        let count = counts.entry(node.op_type.clone()).or_default();
        match run(&folder) {
            Some(true) => count[0] += 1,
            Some(false) => wrong.push(folder.file_name().unwrap().to_string_lossy().into_owned()),
            None => count[1] += 1,
        }
    }
    for (operator, [passed, refused]) in &counts {
        println!("{operator}: {passed} passed, {refused} refused");
    }
    let sum = |i: usize| counts.values().map(|count| count[i]).sum::<usize>();
    println!("{} passed, {} refused, {} wrong", sum(0), sum(1), wrong.len());
    wrong.sort();
    assert!(wrong.is_empty(), "{wrong:#?}");
}
