//! Import of pretrained weights into a Burn module: safetensors, PyTorch checkpoints, ONNX models.
//!
//! ```no_run
//! use opendr_training::weights::{Rules, WeightTable};
//! # use burn::module::Module;
//! # fn start<M: Module>(network: M) -> opendr_engine::Result<M> {
//! let table = WeightTable::from_file("mobilenet_v2.pth".as_ref())?;
//! let rules = Rules::by_name().rename("features.*", "backbone.*").skip("head");
//! let (network, report) = table.apply(network, &rules)?;
//! report.complete()?;
//! # Ok(network)
//! # }
//! ```

mod apply;
mod fill;
mod layer;
mod names;
mod onnx;
mod order;
mod pattern;
mod pytorch;
mod read;
mod report;
mod rules;
mod safetensors;
mod slot;
mod table;

#[cfg(test)]
mod tests;

pub use report::{Mismatch, Report};
pub use rules::Rules;
pub use table::{Weight, WeightTable};
