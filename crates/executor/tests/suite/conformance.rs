//! The node tests of the PyPI package `onnx` for the operators that the executor claims.
//!
//! `OPENDR_ONNX_NODE_TESTS` is the folder that `node_tests.py` wrote; without it the test ends at once.

use std::collections::BTreeMap;
use std::path::Path;

use opendr_engine::ErrorKind;
use opendr_executor::{Data, Executor, Tensor, supported_operators};
use opendr_kernels::Compute;
use opendr_onnx::model_from_bytes;
use opendr_onnx::proto::{ModelProto, TensorProto};
use prost::Message as _;

/// Tests whose expected output is not that of ONNX Runtime 1.31, with which the executor agrees: with aligned corners it divides by the
/// rounded length of the output, the test by the length before rounding.
const DIFFERS_FROM_ONNX_RUNTIME: [&str; 2] = [
    "test_resize_downsample_scales_linear_align_corners",
    "test_resize_downsample_scales_cubic_align_corners",
];

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
///
/// Shapes, axes and the like are inputs of most test models and constants of most networks: what is refused with
/// inputs is run again with constants in their place.
fn run(folder: &Path, model: ModelProto) -> Option<bool> {
    let inputs = model.graph.as_ref()?.input.len();
    (0..=inputs)
        .rev()
        .find_map(|kept| run_with_inputs(folder, with_constants(folder, model.clone(), kept)?, kept))
}

/// Returns the model with its inputs after the first `kept` as initializers.
fn with_constants(folder: &Path, mut model: ModelProto, kept: usize) -> Option<ModelProto> {
    let graph = model.graph.as_mut()?;
    for (i, input) in graph.input.split_off(kept).into_iter().enumerate() {
        let file = folder.join(format!("test_data_set_0/input_{}.pb", kept + i));
        let tensor = TensorProto::decode(std::fs::read(file).ok()?.as_slice()).ok()?;
        graph.initializer.push(TensorProto { name: input.name, ..tensor });
    }
    Some(model)
}

fn run_with_inputs(folder: &Path, model: ModelProto, count: usize) -> Option<bool> {
    let mut executor = match Executor::open(&model.encode_to_vec(), Compute::single()) {
        Ok(executor) => executor,
        Err(error) if error.kind() == ErrorKind::Unsupported => return None,
        Err(error) => {
            println!("{}: {error}", folder.display());
            return Some(false);
        }
    };
    let set = folder.join("test_data_set_0");
    let inputs: Option<Vec<_>> = (0..count).map(|i| read(&set.join(format!("input_{i}.pb")))).collect();
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
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        if DIFFERS_FROM_ONNX_RUNTIME.contains(&name.as_str()) {
            continue;
        }
        let Ok(bytes) = std::fs::read(folder.join("model.onnx")) else { continue };
        let Ok(model) = model_from_bytes(&bytes) else { continue };
        let nodes = model.graph.as_ref().map_or(&[][..], |graph| &graph.node);
        let [node] = nodes else { continue };
        if !claimed.contains(&node.op_type.as_str()) || !model.functions.is_empty() {
            continue;
        }
        let count = counts.entry(node.op_type.clone()).or_default();
        match run(&folder, model) {
            Some(true) => count[0] += 1,
            Some(false) => wrong.push(name),
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
    assert!(sum(0) >= 690, "only {} tests passed", sum(0));
}

#[test]
fn the_page_lists_every_operator() {
    let page = std::fs::read_to_string(crate::root().join("docs/onnx.md")).unwrap();
    let (_, list) = page.split_once("## Operators").unwrap();
    let (list, _) = list.split_once('.').unwrap();
    let listed: Vec<&str> = list.split('`').skip(1).step_by(2).collect();
    assert_eq!(listed, supported_operators().collect::<Vec<_>>());
}
