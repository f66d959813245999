//! The weights of a network as it is trained, beside its ONNX in the container: what a further training begins with.

use burn::module::Module;
use burn::store::ModuleRecord;
use burn::tensor::Bytes;
use opendr_engine::model::Model;
use opendr_engine::{Error, Result};

/// The file in the container. The ONNX beside it cannot stand for it: batch normalisations are gone there.
pub const TRAINABLE: &str = "network.bpk";

/// Returns the weights of `network` as the bytes of the file.
///
/// # Errors
/// `Internal` when something of the network has no form on disk.
pub fn bytes_from_network<M: Module>(network: &M) -> Result<Vec<u8>> {
    let bytes = network.valid().into_record().into_bytes();
    let bytes = bytes.map_err(|error| Error::internal("a network has no form on disk").with_source(error))?;
    Ok(bytes.to_vec())
}

/// Returns `network` with the weights of the container that training begins with, where there is one.
///
/// # Errors
/// `Format` when the container has none, or those of a network of other sizes.
pub fn network_from_base<M: Module>(network: M, base: Option<&Model>) -> Result<M> {
    let Some(base) = base else { return Ok(network) };
    if !base.manifest().files.iter().any(|file| file.name == TRAINABLE) {
        return Err(Error::format(format!(
            "{} has no {TRAINABLE}, so that training cannot go on from it; train a new model",
            base.path().display()
        )));
    }
    let other = || {
        format!(
            "{TRAINABLE} of {} is of a network of other sizes or classes; give the parameters it was made with, or train \
             a new model",
            base.path().display()
        )
    };
    let record = ModuleRecord::from_bytes(Bytes::from_bytes_vec(base.file(TRAINABLE)?))
        .map_err(|error| Error::format(other()).with_source(error))?;
    network.try_load_record(record).map_err(|error| Error::format(other()).with_source(error))
}
