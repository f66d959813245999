//! Training weights in a container, beside its ONNX file, from which a further training starts.

use burn::module::Module;
use burn::store::ModuleRecord;
use burn::tensor::Bytes;
use opendr_engine::model::Model;
use opendr_engine::{Error, Result};

/// File name in the container. The ONNX file cannot replace it: batch normalisations are folded there.
pub const TRAINABLE: &str = "network.bpk";

/// Returns the weights of `network` in Burn's format.
///
/// # Errors
/// `Internal` when the weights cannot be serialised.
pub fn bytes_from_network<M: Module>(network: &M) -> Result<Vec<u8>> {
    let bytes = network.valid().into_record().into_bytes();
    let bytes = bytes.map_err(|error| {
        Error::internal("the weights of the network cannot be serialised").with_source(error)
    })?;
    Ok(bytes.to_vec())
}

/// Returns `network` with the weights of the base container, if there is one.
///
/// # Errors
/// `Format` when the container has no such weights, or those of a network of other sizes.
pub fn network_from_base<M: Module>(network: M, base: Option<&Model>) -> Result<M> {
    let Some(base) = base else { return Ok(network) };
    if !base.manifest().files.iter().any(|file| file.name == TRAINABLE) {
        return Err(Error::format(format!(
            "{} has no {TRAINABLE}, so training cannot resume from it; train a new model",
            base.path().display()
        )));
    }
    let other = || {
        format!(
            "{TRAINABLE} of {} belongs to a network of other sizes or classes; give the parameters of its training, or train \
             a new model",
            base.path().display()
        )
    };
    let record = ModuleRecord::from_bytes(Bytes::from_bytes_vec(base.file(TRAINABLE)?))
        .map_err(|error| Error::format(other()).with_source(error))?;
    network.try_load_record(record).map_err(|error| Error::format(other()).with_source(error))
}
