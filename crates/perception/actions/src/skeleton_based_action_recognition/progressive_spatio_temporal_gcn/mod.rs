//! PST-GCN: spatio-temporal graph convolutions whose number of layers and channels is found in the training.
//!
//! Heidari and Iosifidis, Progressive Spatio-Temporal Graph Convolutional Network for Skeleton-Based Human Action Recognition,
//! 2020. Without a given `topology`, `fit` starts with one layer of one block and adds blocks and layers while the training
//! loss decreases ([`progressive`](opendr_perception_common::progressive)). The network has the joints, features and clips of
//! [`SpatioTemporalGcn`](super::SpatioTemporalGcn).

#[cfg(feature = "training")]
mod fit;

use opendr_engine::data::SkeletonSequence;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Result, Task};
use opendr_perception_common::progressive::TopologyParams;

use super::clip_network::{ClipNetwork, SkeletonClipParams};
use super::sizes::{Architecture, NetworkSizes};
use super::spatio_temporal_gcn::WITHOUT_EFFECT;

/// Parameters of [`ProgressiveSpatioTemporalGcn`]. The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct ProgressiveSpatioTemporalGcnParams {
    /// Parameters common to the learners of clips.
    #[param(flatten)]
    pub clip: SkeletonClipParams,
    /// Topology of the network, and limits of its growth.
    #[param(flatten)]
    pub growth: TopologyParams,
}

impl ProgressiveSpatioTemporalGcnParams {
    /// Returns the sizes of the network.
    ///
    /// # Errors
    /// `InvalidParam` when `num_point` contradicts the graph.
    fn sizes(&self) -> Result<NetworkSizes> {
        self.clip.sizes(Architecture::PstGcn, self.growth.channels())
    }
}

/// A loaded network.
pub struct ProgressiveSpatioTemporalGcn {
    params: ProgressiveSpatioTemporalGcnParams,
    network: ClipNetwork,
}

impl Learner for ProgressiveSpatioTemporalGcn {
    const SPEC: Spec = Spec::new("progressive_spatio_temporal_gcn", Task::SkeletonBasedActionRecognition)
        .class("ProgressiveSpatioTemporalGCNLearner")
        .about("PST-GCN classifies the action in a clip of a moving skeleton; its network grows in the training.")
        .without_effect(WITHOUT_EFFECT);
    type Params = ProgressiveSpatioTemporalGcnParams;
    type Input<'a> = &'a SkeletonSequence;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: ProgressiveSpatioTemporalGcnParams, device: Device) -> Result<Self> {
        let network = ClipNetwork::load(model, &params.sizes()?, params.clip.num_class, device)?;
        Ok(Self { network, params })
    }

    fn params(&self) -> &ProgressiveSpatioTemporalGcnParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ProgressiveSpatioTemporalGcnParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.network.classes()
    }

    fn infer_into(&self, _: &mut (), sequence: &SkeletonSequence, category: &mut Category) -> Result<()> {
        self.network.infer_into(self.params.clip.num_person, sequence, category)
    }
}
