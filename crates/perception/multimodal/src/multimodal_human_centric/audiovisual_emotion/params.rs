//! Parameters of the learner.

use opendr_engine::params::Params;

opendr_engine::choices! {
    /// Fusion of the two branches.
    pub enum AudiovisualFusion {
        /// Between the halves of the branches: attention weights the time steps of the other branch.
        IntermediateAttention = "ia",
        /// Between the halves of the branches: the attended features of the other branch are added.
        IntermediateTransformer = "it",
        /// At the ends of the branches: each continues with the attended features of the other.
        LateTransformer = "lt",
    }
}

/// Parameters of [`AudiovisualEmotion`](super::AudiovisualEmotion). The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct AudiovisualEmotionParams {
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=10_000)]
    pub num_class: Option<usize>,
    /// Number of frames of the face, sampled evenly from the video.
    #[param(default = 15, range = 2..=256)]
    pub seq_length: usize,
    /// Fusion of the two branches.
    pub fusion: AudiovisualFusion,
    /// Sample rate of the audio.
    #[param(default = 22_050, range = 8000..=48_000, unit = "Hz")]
    pub sample_rate: u32,
    /// Duration of the audio that is used, from its start; shorter audio is padded.
    #[param(default = 3.6, range = 0.2..=60.0, unit = "s")]
    pub seconds: f64,
}
