//! Export of a trained network to ONNX.
//!
//! [`onnx`] runs the network's forward pass once on a device that records operations instead of executing them
//! (`burn-capture`), and writes the recording with [`opendr_onnx::Builder`], which folds constants. The network is exported in
//! inference mode: without dropout, with the running statistics of its batch normalisations, which are folded into the
//! convolutions before them.
//!
//! ```
//! use burn::nn::LinearConfig;
//! use burn::tensor::{Device, activation::softmax};
//! use opendr_training::export::{self, Input};
//!
//! # fn main() -> opendr_engine::Result<()> {
//! let network = LinearConfig::new(4, 2).init(&Device::flex());
//! let input = Input::new("features", [1, 4]).open(0);
//! let model = export::onnx(&network, input, &["logits", "probabilities"], |network, features| {
//!     let logits = network.forward(features);
//!     (logits.clone(), softmax(logits, 1))
//! })?;
//! # assert!(!model.is_empty());
//! # Ok(())
//! # }
//! ```
//!
//! # Open batch
//!
//! A recording contains sizes, not their origin. With [`Input::open`] the forward pass is recorded twice, with two batch sizes:
//! sizes that stay equal are fixed, sizes in proportion to the batch follow it, and anything else is an error with the name of
//! the operation. Nothing is executed, so a recording costs no more than its list of operations.
//!
//! # Adding an operation
//!
//! Each family of operations has a file. Its functions receive an operation as described by `burn-ir` and write nodes through
//! `Lowering`; they return `false` for an unknown operation, which becomes an error. Operations of Burn without an ONNX
//! operator (bicubic resizing, adaptive pooling of uneven sizes) are often linear: Burn then computes their matrix.

mod activation;
mod arithmetic;
mod attention;
mod comparison;
mod convolution;
mod creation;
mod function;
mod indexing;
mod input;
mod lowering;
mod matrix;
mod normalization;
mod operation_name;
mod operations;
mod output;
mod pooling;
mod rearrangement;
mod recurrent;
mod reduction;
mod resampling;
mod sizes;
mod sorting;
mod trace;

use burn::module::Module;
use opendr_engine::{Error, Result};
use opendr_onnx::{bytes_from_model, model_from_graph, passes};

pub use input::{ElementKind, Input, Inputs};
pub use output::Outputs;
pub(crate) use recurrent::record_gru;

use input::Declared;
use lowering::Lowering;
use sizes::Sizes;
use trace::Trace;

/// Batch sizes of the two recordings. No layer has these sizes by chance, and neither divides the other.
const BATCHES: [usize; 2] = [97, 101];

/// Exports `network` as an ONNX model (opset 17, IR version 8).
///
/// `inputs` is one [`Input`], or a tuple of them; `forward` receives a tensor for each and returns a tensor of any rank and
/// element type, or a tuple, array or vector of tensors. These become the model's outputs with the names in `outputs`. Floats
/// are written as `f32`, integers as `i64`.
///
/// # Errors
/// `Unsupported` when `forward` uses an operation without lowering, or its result depends on an open axis other than by its
/// size; `Internal` when the number of names differs from the number of outputs.
///
/// # Panics
/// When `forward` panics, such as by Burn's shape checks.
pub fn onnx<M: Module, I: Inputs, O: Outputs>(
    network: &M,
    inputs: I,
    outputs: &[&str],
    forward: impl Fn(&M, I::Tensors) -> O,
) -> Result<Vec<u8>> {
    let network = network.valid();
    trace::initialise(&network);
    let record = |batch| {
        Trace::record(&mut |device, trace| {
            let network = network.clone().to_device(device);
            trace.name_parameters(&network);
            let tensors = inputs.tensors(batch, device, &mut trace.inputs)?;
            forward(&network, tensors).ids(&mut trace.outputs)
        })
    };
    onnx_of_recordings(&record, &inputs.declared(), outputs)
}

/// Returns the model of a network from `record`, which records a forward pass with a batch size.
fn onnx_of_recordings(
    record: &dyn Fn(usize) -> Result<Trace>,
    inputs: &[Declared],
    outputs: &[&str],
) -> Result<Vec<u8>> {
    let open = inputs.iter().any(|input| input.open.is_some());
    let (trace, sizes) = match open {
        true => {
            let (mut trace, other) = (record(BATCHES[0])?, record(BATCHES[1])?);
            let sizes = Sizes::reconciled(&mut trace, &other, BATCHES)?;
            (trace, sizes)
        }
        false => (record(1)?, Sizes::Fixed),
    };
    if trace.outputs.len() != outputs.len() {
        return Err(Error::internal(format!(
            "the network has {} outputs, but there are {} names: {}",
            trace.outputs.len(),
            outputs.len(),
            outputs.join(", ")
        )));
    }
    let mut graph = Lowering::new(&trace, &sizes, inputs, outputs)?.lower(outputs)?;
    passes::simplify(&mut graph);
    let mut model = model_from_graph(graph);
    "opendr-training".clone_into(&mut model.producer_name);
    Ok(bytes_from_model(&model))
}

#[cfg(test)]
mod tests;
