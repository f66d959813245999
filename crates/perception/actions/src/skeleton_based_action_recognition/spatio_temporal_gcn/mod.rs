//! ST-GCN: convolutions over joints and bones, and convolutions through time, on clips.
//!
//! For complete recordings; [`CoStGcn`](super::CoStGcn) classifies every frame of a stream with the weights of ST-GCN, at a fraction
//! of the arithmetic. The parameter `method_name` chooses the architecture:
//!
//! * ST-GCN: Yan, Xiong and Lin, Spatial Temporal Graph Convolutional Networks for Skeleton-Based Action Recognition, AAAI
//!   2018; partitions by distance from the centre of the body, learnt edge weights.
//! * TA-GCN: Heidari and Iosifidis, Temporal Attention-Augmented Graph Convolutional Network for Efficient Skeleton-Based Human
//!   Action Recognition, ICPR 2020; after two graph convolutions, only the frames with the highest attention are processed.
//! * ST-BLN: Heidari and Iosifidis, On the spatial attention in Spatio-Temporal Graph Convolutional Networks for skeleton-based
//!   human action recognition, IJCNN 2021; learnt matrices in place of the skeleton's graph, symmetric ones on request.

#[cfg(feature = "training")]
mod fit;

#[cfg(feature = "training")]
pub use fit::SpatioTemporalGcnFitParams;

use opendr_engine::data::SkeletonSequence;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result, Task};

use super::clip_network::{ClipNetwork, SkeletonClipParams};
use super::model_checks::check_architecture;
use super::sizes::{Architecture, NetworkSizes};

opendr_engine::choices! {
    /// Network architecture.
    pub enum Method {
        /// Spatial-temporal graph convolutions (Yan et al., 2018).
        StGcn = "stgcn",
        /// Graph convolutions on the frames with the highest attention (Heidari and Iosifidis, 2020).
        TaGcn = "tagcn",
        /// Bilinear layers without a given graph (Heidari and Iosifidis, 2021).
        StBln = "stbln",
    }
}

/// Parameters of [`SpatioTemporalGcn`]. The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct SpatioTemporalGcnParams {
    /// Parameters common to the learners of clips.
    #[param(flatten)]
    pub clip: SkeletonClipParams,
    /// Network architecture.
    pub method_name: Method,
    /// Whether the matrices of `stbln` are symmetric.
    #[param(default = false)]
    pub stbln_symmetric: bool,
    /// Number of frames that `tagcn` selects.
    #[param(default = 100, range = 1..=10_000)]
    pub num_subframes: usize,
    /// Output channels of each block; the first two of `tagcn` do not convolve through time. None: 64, 64, 64, 64, 128, 128, 128,
    /// 256, 256, 256; for `tagcn` 64, 64, 128, 128, 256, 256.
    #[param(range = 1..=4096)]
    pub channels: Option<Vec<usize>>,
}

impl SpatioTemporalGcnParams {
    /// Returns the sizes of the network.
    ///
    /// # Errors
    /// `InvalidParam` when parameters contradict each other.
    pub(super) fn sizes(&self) -> Result<NetworkSizes> {
        let architecture = match self.method_name {
            Method::StGcn => Architecture::StGcn,
            Method::TaGcn => Architecture::TaGcn { subframes: self.num_subframes },
            Method::StBln => Architecture::StBln { symmetric: self.stbln_symmetric },
        };
        if self.stbln_symmetric && self.method_name != Method::StBln {
            return Err(Error::invalid_param(format!(
                "stbln_symmetric = true, but method_name = {}; choose stbln or omit stbln_symmetric",
                self.method_name.name()
            )));
        }
        let channels = self.channels.clone().unwrap_or_else(|| match self.method_name {
            Method::TaGcn => vec![64, 64, 128, 128, 256, 256],
            _ => vec![64, 64, 64, 64, 128, 128, 128, 256, 256, 256],
        });
        self.clip.sizes(architecture, channels)
    }
}

/// A loaded network.
pub struct SpatioTemporalGcn {
    params: SpatioTemporalGcnParams,
    network: ClipNetwork,
}

impl Learner for SpatioTemporalGcn {
    const SPEC: Spec = Spec::new("spatio_temporal_gcn", Task::SkeletonBasedActionRecognition)
        .class("SpatioTemporalGCNLearner")
        .about("ST-GCN, TA-GCN or ST-BLN classifies the action in a clip of a moving skeleton; trainable.")
        .without_effect(WITHOUT_EFFECT);
    type Params = SpatioTemporalGcnParams;
    type Input<'a> = &'a SkeletonSequence;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: SpatioTemporalGcnParams, device: Device) -> Result<Self> {
        check_architecture("method_name", &params.method_name, model)?;
        let network = ClipNetwork::load(model, &params.sizes()?, params.clip.num_class, device)?;
        Ok(Self { network, params })
    }

    fn params(&self) -> &SpatioTemporalGcnParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut SpatioTemporalGcnParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.network.classes()
    }

    fn infer_into(&self, _: &mut (), sequence: &SkeletonSequence, category: &mut Category) -> Result<()> {
        self.network.infer_into(self.params.clip.num_person, sequence, category)
    }
}

/// Arguments of OpenDR's learners of clips without effect.
pub(super) const WITHOUT_EFFECT: &[(&str, &str)] = &[
    ("experiment_name", "the output folder names the run"),
    ("device_ind", "use `device`"),
    ("val_batch_size", "validation runs the learner on one clip at a time"),
    ("start_epoch", "use `resume` of `fit`"),
    ("dataset_name", "the data set has a name"),
];
