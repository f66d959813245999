//! Training of PointPillars.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Statistics};
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device};

use super::anchors::AnchorKind;
use super::layout::PillarLayout;
use super::network::PillarNetwork;
use super::objective::PillarObjective;
use super::{VoxelObjectDetection3d, VoxelObjectDetection3dParams};
use crate::pillars::PillarGrid;

/// Training parameters of [`VoxelObjectDetection3d`].
#[derive(Debug, Clone, Params)]
pub struct VoxelObjectDetection3dFitParams {
    /// Classes to detect, of `Car`, `Pedestrian` and `Cyclist`; `Car` when empty.
    #[param(default = Vec::new())]
    pub classes: Vec<String>,
    /// Range ahead of the lidar.
    #[param(default = 51.2, range = 4.0..=200.0, unit = "m")]
    pub ahead: f32,
    /// Range to either side of the lidar.
    #[param(default = 25.6, range = 2.0..=100.0, unit = "m")]
    pub aside: f32,
    /// Side of a pillar.
    #[param(default = 0.32, range = 0.05..=5.0, unit = "m")]
    pub pillar: f32,
    /// Whether scans are mirrored at random.
    #[param(default = true)]
    pub augment: bool,
    /// Parameters common to all trainings.
    #[param(
        flatten,
        lr = 0.002,
        epochs = 10,
        batch_size = 4,
        weight_decay = 0.01,
        grad_clip = 10.0,
        lr_schedule = ScheduleKind::Cosine,
        warmup_steps = 50,
        num_workers = 1
    )]
    pub training: TrainingParams,
}

/// Range of heights in metres from the lidar.
const HEIGHTS: [f32; 2] = [-3.0, 1.0];
/// The stages of the network halve the grid three times.
const MULTIPLE: usize = 8;

impl Fit for VoxelObjectDetection3d {
    type FitParams = VoxelObjectDetection3dFitParams;

    fn fit(
        base: Option<&Model>,
        params: &VoxelObjectDetection3dParams,
        fit_params: &VoxelObjectDetection3dFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let objective = fit_params.objective(base)?;
        let network = PillarNetwork::new(objective.layout.anchors.len(), &seeded_device(job, training)?);
        let network = network_from_base(network, base)?;
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

impl VoxelObjectDetection3dFitParams {
    fn objective(&self, base: Option<&Model>) -> Result<PillarObjective> {
        if let Some(model) = base {
            let layout = PillarLayout::from_manifest(model.manifest())?;
            let classes = model.manifest().classes.clone();
            return Ok(PillarObjective { layout, classes, augment: self.augment });
        }
        let grid =
            PillarGrid { x: [0.0, self.ahead], y: [-self.aside, self.aside], z: HEIGHTS, side: self.pillar };
        grid.check()?;
        let sides = [grid.columns(), grid.rows()];
        if sides.iter().any(|side| !side.is_multiple_of(MULTIPLE)) {
            return Err(Error::invalid_param(format!(
                "{} m ahead and {} m to either side are {} x {} pillars of {} m; choose ranges where both are multiples of \
                 {MULTIPLE}",
                self.ahead, self.aside, sides[0], sides[1], self.pillar
            )));
        }
        let classes: Classes = match &self.classes[..] {
            [] => ["Car"].into_iter().collect(),
            names => names.iter().map(String::as_str).collect(),
        };
        let mut anchors = Vec::new();
        for (number, name) in classes.iter().enumerate() {
            anchors.extend(AnchorKind::of_class(name, number)?);
        }
        AnchorKind::check(&anchors, classes.len())?;
        Ok(PillarObjective {
            layout: PillarLayout { grid, stride: 2, anchors },
            classes,
            augment: self.augment,
        })
    }
}
