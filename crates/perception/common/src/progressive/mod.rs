//! Networks that grow in their training, block by block and layer by layer.
//!
//! Heidari and Iosifidis, Progressive Spatio-Temporal Graph Convolutional Network for Skeleton-Based Human Action Recognition,
//! 2020. [`TopologyParams`] are the parameters of such a network. With the feature `training`, [`train_topology`] trains it: a
//! given topology at once, an empty one in stages.

#[cfg(feature = "training")]
mod growth;
#[cfg(feature = "training")]
mod inheritance;
#[cfg(feature = "training")]
mod stage_progress;

use opendr_engine::params::Params;

#[cfg(feature = "training")]
pub use growth::{Stage, train_topology};

/// Parameters of a network that may grow. The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct TopologyParams {
    /// Output channels of a block.
    #[param(default = 20, range = 1..=256)]
    pub blocksize: usize,
    /// Maximum number of blocks of a layer of a network that grows.
    #[param(default = 10, range = 1..=1000, alias = "numblocks")]
    pub num_blocks: usize,
    /// Maximum number of layers of a network that grows.
    #[param(default = 10, range = 1..=100, alias = "numlayers")]
    pub num_layers: usize,
    /// Number of blocks of each layer. Empty: `fit` finds it; the network grows while its training loss decreases.
    #[param(range = 1..=1000)]
    pub topology: Vec<usize>,
    /// Relative decrease of the training loss that a further layer must exceed.
    #[param(default = 0.0001, range = 0.0..=1.0)]
    pub layer_threshold: f64,
    /// Relative decrease of the training loss that a further block must exceed.
    #[param(default = 0.0001, range = 0.0..=1.0)]
    pub block_threshold: f64,
}

impl TopologyParams {
    /// Returns the parameters with another topology.
    #[must_use]
    pub fn with_topology(&self, topology: &[usize]) -> Self {
        Self { topology: topology.to_vec(), ..self.clone() }
    }

    /// Returns the output channels of each layer.
    pub fn channels(&self) -> Vec<usize> {
        self.topology.iter().map(|blocks| blocks * self.blocksize).collect()
    }
}
