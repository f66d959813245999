//! Training objective of the detector.

use burn::tensor::{Device, Tensor, TensorData};
use opendr_datasets::augment::{CloudFlip, Pipeline};
use opendr_engine::Result;
use opendr_engine::learner::Learner;
use opendr_engine::model::Manifest;
use opendr_engine::target::Classes;
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::layout::PillarLayout;
use super::loss::PillarLoss;
use super::network::{CHANNELS, PillarNetwork};
use super::point_features::{CHUNK, POINT_FILE};
use super::targets::{PillarBatch, PillarBatches};
use super::{OUTPUTS, PILLAR_FILE, VoxelObjectDetection3d};
use crate::pillars::{PillarPoint, Voxeliser};

/// Training objective of PointPillars.
#[derive(Debug)]
pub struct PillarObjective {
    /// Grid and anchors.
    pub layout: PillarLayout,
    /// Classes of the network; boxes of other classes are background.
    pub classes: Classes,
    /// Whether scans are mirrored at random.
    pub augment: bool,
}

impl Objective for PillarObjective {
    type Network = PillarNetwork;
    type Collate = PillarBatches;

    fn collate(&self) -> Result<PillarBatches> {
        Ok(PillarBatches { layout: self.layout.clone(), classes: self.classes.clone() })
    }

    fn pipeline(&self) -> Result<Pipeline> {
        if self.augment { Pipeline::default().sometimes(0.5, CloudFlip {}) } else { Ok(Pipeline::default()) }
    }

    fn loss(&self, network: &PillarNetwork, batch: &PillarBatch, device: &Device) -> Result<Loss> {
        let grid = &self.layout.grid;
        let count = batch.cells.len();
        let shape = [batch.scans, grid.rows(), grid.columns()];
        let canvas = if count == 0 {
            Tensor::zeros([shape[0], CHANNELS, shape[1], shape[2]], device)
        } else {
            let matrix = |numbers: &[f32], columns: usize| {
                let data = TensorData::new(numbers.to_vec(), [numbers.len() / columns, columns]);
                Tensor::<2>::from_data(data, device)
            };
            let points = matrix(&batch.points, PillarPoint::FEATURES);
            let pooled = network.pooled(points, &batch.pillars, count)?;
            let pillars = Tensor::cat(vec![pooled, matrix(&batch.statistics, Voxeliser::STATISTICS)], 1);
            PillarNetwork::canvas(pillars, &batch.cells, shape)
        };
        let PillarLoss { scores, offsets, directions } =
            PillarLoss::new(network.forward(canvas), batch, device);
        let total = scores.clone() + offsets.clone() + directions.clone();
        let parts = vec![("cls_loss", scores), ("loc_loss", offsets), ("dir_loss", directions)];
        Ok(Loss { total, parts })
    }

    fn container(&self, network: &PillarNetwork) -> Result<Container> {
        let grid = &self.layout.grid;
        let input = Input::new("points", [CHUNK, PillarPoint::FEATURES]);
        let points = export::onnx(network, input, &["features"], |network, points| network.features(points))?;
        let input = Input::new("pillars", [1, CHANNELS, grid.rows(), grid.columns()]);
        let pillars = export::onnx(network, input, &OUTPUTS, |network, canvas| {
            let output = network.forward(canvas);
            (output.scores, output.offsets, output.backs)
        })?;
        let spec = VoxelObjectDetection3d::SPEC;
        let mut manifest = Manifest::new(spec.name, "");
        manifest.task = Some(spec.task);
        manifest.classes = self.classes.clone();
        manifest.write_inputs(&self.layout)?;
        let files = vec![
            (POINT_FILE.to_owned(), points),
            (PILLAR_FILE.to_owned(), pillars),
            (TRAINABLE.to_owned(), bytes_from_network(network)?),
        ];
        Ok(Container { manifest, files })
    }
}
