//! Training parameters of the methods.

use opendr_engine::params::Params;

use crate::act::ActConfig;
use crate::diffusion::DiffusionConfig;
use crate::method::ChunkMethod;
use crate::training::ChunkTrainingParams;
use crate::{Act, DiffusionPolicy};

/// The teacher of a training in an environment.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct TeacherParams {
    /// Name of the prior that demonstrates, in its newest version; a training on a data set needs none.
    pub demonstration_prior: Option<String>,
    /// Episodes that the prior demonstrates.
    #[param(default = 100, range = 1..=1_000_000)]
    pub demonstration_episodes: usize,
    /// Whether demonstrations that fail are left out.
    #[param(default = true)]
    pub successful_demonstrations: bool,
    /// Episodes of the evaluation after the training; 0 evaluates none.
    #[param(default = 50, range = 0..=1_000_000)]
    pub n_eval_episodes: u64,
}

/// A method with the parameters of its training.
pub trait ImitationMethod: ChunkMethod {
    /// Training parameters.
    type FitParams: Params;

    /// Returns the settings of the network, of the training, and of the teacher.
    fn parts(params: &Self::FitParams) -> (&Self::Config, &ChunkTrainingParams, &TeacherParams);
}

macro_rules! method {
    ($(#[$doc:meta])* $fit_params:ident, $method:ident($config:ident)) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq, Params)]
        pub struct $fit_params {
            /// Settings of the network.
            #[param(flatten)]
            pub config: $config,
            /// Settings of the training.
            #[param(flatten)]
            pub training: ChunkTrainingParams,
            /// Settings of the teacher.
            #[param(flatten)]
            pub teacher: TeacherParams,
        }

        impl ImitationMethod for $method {
            type FitParams = $fit_params;

            fn parts(params: &$fit_params) -> (&$config, &ChunkTrainingParams, &TeacherParams) {
                (&params.config, &params.training, &params.teacher)
            }
        }
    };
}

method! {
    /// Training parameters of ACT.
    ActFitParams,
    Act(ActConfig)
}

method! {
    /// Training parameters of diffusion policy.
    DiffusionFitParams,
    DiffusionPolicy(DiffusionConfig)
}
