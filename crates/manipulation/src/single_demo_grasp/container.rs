//! The files of a model.

use std::path::Path;

use opendr_engine::Result;
use opendr_engine::learner::Spec;
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::params::Params as _;

use super::network::GraspNetwork;
use super::params::SingleDemoGraspParams;

const NETWORK_FILE: &str = "grasp.bin";

/// Reads the network of a container.
///
/// # Errors
/// `Format` for the container of another learner or damaged files.
pub(super) fn read(model: &Model) -> Result<GraspNetwork> {
    GraspNetwork::from_bytes(&model.file(NETWORK_FILE)?)
}

/// Writes a container.
///
/// # Errors
/// `Io` if writing fails.
pub(super) fn write(
    path: &Path,
    spec: Spec,
    network: &GraspNetwork,
    params: &SingleDemoGraspParams,
) -> Result<()> {
    let mut manifest = Manifest::new(spec.name, "");
    manifest.task = Some(spec.task);
    manifest.params = params.to_map();
    manifest.lineage.source = "trained from a single demonstration".to_owned();
    let mut writer = ModelWriter::new(path, manifest)?;
    writer.add(NETWORK_FILE, &network.to_bytes())?;
    writer.finish().map(drop)
}
