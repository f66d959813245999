//! Training of PST-GCN.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob, Learner as _};
use opendr_engine::model::Model;
use opendr_engine::params::Params as _;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::progressive::{Stage, TopologyParams, train_topology};
use opendr_training::{fit_learner, open_for_training, seeded_device};

use super::{ProgressiveSpatioTemporalGcn, ProgressiveSpatioTemporalGcnParams};
use crate::skeleton_based_action_recognition::network::ActionNetwork;
use crate::skeleton_based_action_recognition::objective::{ActionObjective, Form};
use crate::skeleton_based_action_recognition::{SkeletonClipParams, SpatioTemporalGcnFitParams};

impl ProgressiveSpatioTemporalGcnParams {
    /// Returns the parameters of a network with another topology.
    fn with_topology(&self, topology: &[usize]) -> Self {
        Self { growth: self.growth.with_topology(topology), ..self.clone() }
    }

    /// Returns the limits of the growth, with at most as many layers as leave a frame of a clip.
    fn limited_growth(&self) -> TopologyParams {
        let SkeletonClipParams { num_frames, temporal_kernel, .. } = self.clip;
        let possible = num_frames.saturating_sub(1) / (temporal_kernel - 1);
        let num_layers = self.growth.num_layers.min(possible.max(1));
        TopologyParams { num_layers, ..self.growth.clone() }
    }
}

impl Fit for ProgressiveSpatioTemporalGcn {
    type FitParams = SpatioTemporalGcnFitParams;

    fn fit(
        base: Option<&Model>,
        params: &ProgressiveSpatioTemporalGcnParams,
        fit_params: &SpatioTemporalGcnFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, params.clip.num_class, "num_class")?;
        let mut train = |stage: &Stage<'_>| {
            let device = seeded_device(stage.job, stage.training)?;
            let network = |topology: &[usize]| -> Result<_> {
                let sizes = params.with_topology(topology).sizes()?;
                let network = ActionNetwork::new(&sizes, classes.len(), fit_params.dropout, &device)?;
                Ok((network, sizes))
            };
            let (initial, sizes) = network(stage.topology)?;
            let initial = stage.network(initial, |topology| Ok(network(topology)?.0))?;
            let params = params.with_topology(stage.topology);
            let objective = ActionObjective {
                learner: Self::SPEC.name,
                sizes,
                form: Form::Clip,
                params: params.to_map(),
                classes: classes.clone(),
                smoothing: fit_params.label_smoothing,
                augment: fit_params.augment,
            };
            fit_learner::<Self, _>(
                &objective,
                initial,
                &params,
                stage.training,
                &*dataset,
                val_dataset,
                stage.job,
            )
        };
        train_topology(&params.limited_growth(), &fit_params.training, base, job, &mut train)
    }
}
