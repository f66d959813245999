//! Trained network to ONNX.
//!
//! [`onnx`] runs the network's forward pass once on a device that records operations instead of executing them
//! (`burn-capture`), and writes what was recorded with [`opendr_onnx::Builder`], which evaluates what is known. The
//! network is taken as it infers: without dropout, with the running statistics of its batch normalisations, which end
//! up in the weights of the convolutions before them.
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
//! A recording knows numbers, not where they come from. With [`Input::open`] the forward pass is recorded twice, with
//! two sizes: what stays is fixed, what grows in proportion is the batch, and anything else is an error that names the
//! operation. Nothing is executed, so neither recording costs more than its list of operations.
//!
//! # Adding an operation
//!
//! Each family of operations has a file. A function there gets the operation as `burn-ir` describes it and writes
//! nodes through `Lowering`; it answers `false` for what it does not know, which becomes the
//! error that the user sees. What ONNX has no operator for, but Burn has (bicubic resizing, adaptive pooling of odd
//! sizes), is often linear: then Burn computes the matrix.

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

use lowering::Lowering;
use sizes::Sizes;
use trace::Trace;

/// Sizes that an open axis is recorded with. No layer has them by chance, and neither divides the other.
const BATCHES: [usize; 2] = [97, 101];

/// Writes `network` as an ONNX model (opset 17, IR version 8).
///
/// `inputs` is one [`Input`], or a tuple of them; `forward` gets a tensor for each. `forward` answers a tensor of any
/// rank and kind, or a tuple, array or vector of them, which become the model's outputs under the names in `outputs`.
/// Floats are written as `f32`, integers as `i64`.
///
/// # Errors
/// `Unsupported` when `forward` uses an operation that is not lowered, or its result depends on an open axis in
/// another way than by its size; `Internal` when the number of names is not the number of outputs.
///
/// # Panics
/// Where `forward` does: Burn's shape checks panic.
pub fn onnx<M: Module, I: Inputs, O: Outputs>(
    network: &M,
    inputs: I,
    outputs: &[&str],
    forward: impl Fn(&M, I::Tensors) -> O,
) -> Result<Vec<u8>> {
    let network = network.valid();
    trace::initialise(&network);
    let declared = inputs.declared();
    let record = |batch| Trace::record(&network, &inputs, batch, &forward);
    let open = declared.iter().any(|input| input.open.is_some());
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
            "the network gives {} outputs, but there are {} names: {}",
            trace.outputs.len(),
            outputs.len(),
            outputs.join(", ")
        )));
    }
    let mut graph = Lowering::new(&trace, &sizes, &declared, outputs)?.lower(outputs)?;
    passes::simplify(&mut graph);
    let mut model = model_from_graph(graph);
    "opendr-training".clone_into(&mut model.producer_name);
    Ok(bytes_from_model(&model))
}

#[cfg(test)]
mod tests;
