//! Training objective of Lightweight OpenPose: the maps of the persons in an image.

use burn::tensor::{Device, Tensor, TensorData};
use opendr_datasets::augment::{Colour, Flip, Pipeline};
use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::learner::{Learner as _, Spec};
use opendr_engine::model::Manifest;
use opendr_engine::params::ParamValue;
use opendr_engine::target::{BoundingBox, Keypoint, Pose, PoseList};
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::dynamic_sides::with_dynamic_sides;
use opendr_perception_common::frozen_layers::FrozenLayers;
use opendr_perception_common::joints::opendr_joints_from_pose;
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};
use opendr_vision::{InputGeometry, LetterboxAlign, Preprocess};

use super::network::{Maps, Network, NetworkConfig};
use super::person_crop::PersonCrop;
use super::{LEVEL, LightweightOpenPose, OUTPUTS, STRIDE};
use crate::pose_estimation::part_affinity::{FIELDS, Grid, HEAT_MAPS, JOINTS, MapEncoder};

/// Training objective of Lightweight OpenPose. Samples are images with [`PoseList`]s of OpenDR's or COCO's joints.
pub(super) struct PoseObjective {
    pub(super) config: NetworkConfig,
    /// Side of the training images, a multiple of 8.
    pub(super) side: usize,
    /// Height of the network's input at inference.
    pub(super) base_height: usize,
    pub(super) augment: bool,
    /// The backbone, if it is frozen.
    pub(super) frozen: Option<FrozenLayers>,
}

/// File name of the network's sizes in a container.
pub(super) const CONFIG: &str = "network.json";

impl Objective for PoseObjective {
    type Network = Network;
    type Collate = PoseBatches;

    fn collate(&self) -> Result<PoseBatches> {
        Ok(PoseBatches::new(self.side))
    }

    fn pipeline(&self) -> Result<Pipeline> {
        if !self.augment {
            return Ok(Pipeline::default());
        }
        Pipeline::default()
            .then(PersonCrop { size: self.side, ..PersonCrop::default() })?
            .sometimes(0.5, Flip::default())?
            .sometimes(0.5, Colour::default())
    }

    /// Half the squared errors, summed over the maps of all stages (Osokin, 2018; Cao et al., Eq. 5), as the mean over the
    /// batch.
    fn loss(&self, network: &Network, batch: &PoseBatch, device: &Device) -> Result<Loss> {
        let count = batch.len();
        let (side, cells) = (self.side, self.side / STRIDE);
        let tensor = |values: &[f32], shape: [usize; 4]| {
            Tensor::<4>::from_data(TensorData::new(values.to_vec(), shape), device)
        };
        let shape = [count, 3, side, side];
        let features = match &self.frozen {
            Some(backbone) => backbone.run(&batch.pictures, shape, device)?.swap_remove(0),
            None => network.backbone.forward(tensor(&batch.pictures, shape)),
        };
        let heat = tensor(&batch.heat, [count, HEAT_MAPS, cells, cells]);
        let fields = tensor(&batch.fields, [count, FIELDS, cells, cells]);
        let mask = tensor(&batch.mask, [count, 1, cells, cells]);
        let squared_error = |output: Tensor<4>, target_maps: &Tensor<4>| {
            let difference = (output - target_maps.clone()) * mask.clone();
            (difference.clone() * difference).sum() / (2 * count) as f64
        };
        let zero = || Tensor::<1>::zeros([1], device);
        let (mut heat_loss, mut field_loss) = (zero(), zero());
        for [stage_heat, stage_fields] in network.forward_from(features) {
            heat_loss = heat_loss + squared_error(stage_heat, &heat);
            field_loss = field_loss + squared_error(stage_fields, &fields);
        }
        let total = heat_loss.clone() + field_loss.clone();
        Ok(Loss { total, parts: vec![("heatmap_loss", heat_loss), ("paf_loss", field_loss)] })
    }

    fn container(&self, network: &Network) -> Result<Container> {
        let side = 4 * STRIDE;
        let input = Input::new("image", [1, 3, side, side]);
        let onnx = export::onnx(network, input, &OUTPUTS, |network: &Network, image| -> Maps {
            network.forward_last_stage(image)
        })?;
        Ok(Container {
            manifest: self.manifest(),
            files: vec![
                ("model.onnx".to_owned(), with_dynamic_sides(&onnx)?),
                (CONFIG.to_owned(), self.config.to_string().into_bytes()),
            ],
        })
    }
}

impl PoseObjective {
    fn manifest(&self) -> Manifest {
        let Spec { name, task, .. } = LightweightOpenPose::SPEC;
        let levels = [LEVEL; 3];
        let image = serde_json::json!({ "layout": "NCHW", "colour": "rgb", "mean": levels, "std": levels });
        let mut manifest = Manifest::new(name, "");
        manifest.task = Some(task);
        manifest.params.insert("base_height".to_owned(), ParamValue::Int(self.base_height as i64));
        manifest.inputs.insert("image".to_owned(), image);
        manifest
    }
}

/// Collates samples with one image and its [`PoseList`] into [`PoseBatch`]es.
pub(super) struct PoseBatches {
    preprocess: Preprocess,
    painter: MapEncoder,
    grid: Grid,
}

/// Images and their target maps, one after the other.
#[derive(Debug, Default)]
pub(super) struct PoseBatch {
    /// Values of the images, `[3, side, side]` each, in -1..=1.
    pictures: Vec<f32>,
    heat: Vec<f32>,
    fields: Vec<f32>,
    /// Weight of each cell: 1, or 0 where persons have no annotated joints.
    mask: Vec<f32>,
    count: usize,
}

impl PoseBatch {
    pub(super) fn len(&self) -> usize {
        self.count
    }

    #[cfg(test)]
    pub(super) fn mask_of(&self, at: usize) -> &[f32] {
        let cells = self.mask.len() / self.count.max(1);
        &self.mask[at * cells..(at + 1) * cells]
    }
}

impl PoseBatches {
    pub(super) fn new(side: usize) -> Self {
        let cells = side / STRIDE;
        Self {
            // The loader is parallel already.
            preprocess: Preprocess::new(side, side)
                .letterbox(LetterboxAlign::Centre, LEVEL)
                .normalise([LEVEL; 3], [LEVEL; 3])
                .threads(1),
            painter: MapEncoder::default(),
            grid: Grid { rows: cells, columns: cells, stride: STRIDE as f32 },
        }
    }

    /// Writes 0 in the boxes of crowds and of persons without joints.
    fn paint_mask(&self, poses: &PoseList, geometry: &InputGeometry, mask: &mut [f32]) {
        let crowd = |region: &BoundingBox| region.segment.as_ref().is_some_and(|segment| segment.iscrowd);
        let unknown = poses.poses.iter().filter_map(|pose| {
            let region = pose.region.as_deref()?;
            let joints = pose.keypoints.iter().any(Keypoint::is_detected);
            (!joints || crowd(region)).then(|| region.corners())
        });
        for [x0, y0, x1, y1] in unknown {
            let [left, top] = self.grid.cell_from_point(geometry.input_from_image([x0, y0]));
            let [right, bottom] = self.grid.cell_from_point(geometry.input_from_image([x1, y1]));
            for (row, cells) in mask.chunks_exact_mut(self.grid.columns).enumerate() {
                for (column, cell) in cells.iter_mut().enumerate() {
                    let inside = (left..=right).contains(&(column as f32));
                    if inside && (top..=bottom).contains(&(row as f32)) {
                        *cell = 0.0;
                    }
                }
            }
        }
    }
}

impl Collate for PoseBatches {
    type Batch = PoseBatch;

    fn start(&self, capacity: usize) -> PoseBatch {
        let room = |count: usize| Vec::with_capacity(capacity * count);
        let cells = self.grid.cells();
        PoseBatch {
            pictures: room(self.preprocess.len()),
            heat: room(HEAT_MAPS * cells),
            fields: room(FIELDS * cells),
            mask: room(cells),
            count: 0,
        }
    }

    fn add(&self, batch: &mut PoseBatch, sample: Sample) -> Result<()> {
        let (Some(Value::Image(image)), Some(Value::PoseList(poses))) = (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input(
                "the sample is not an image with poses; give a data set of keypoints, or a teacher",
            ));
        };
        let PoseBatch { pictures, heat, fields, mask, count } = batch;
        let cells = self.grid.cells();
        let geometry =
            self.preprocess.run_into(image.view(), last(pictures, *count, self.preprocess.len()))?;
        let joints = |pose: &Pose| -> [Keypoint; JOINTS] {
            opendr_joints_from_pose(pose).map(|joint| match joint.is_detected() {
                true => {
                    let [x, y] = geometry.input_from_image([joint.x, joint.y]);
                    Keypoint { x, y, ..joint }
                }
                false => joint,
            })
        };
        let persons: Vec<_> = poses.poses.iter().map(joints).collect();
        let (heat, fields) = (last(heat, *count, HEAT_MAPS * cells), last(fields, *count, FIELDS * cells));
        self.painter.encode(self.grid, &persons, heat, fields);
        let mask = last(mask, *count, cells);
        mask.fill(1.0);
        self.paint_mask(poses, &geometry, mask);
        *count += 1;
        Ok(())
    }
}

/// Returns room for one more of `size` values after `count`, also after a sample that was refused.
fn last(values: &mut Vec<f32>, count: usize, size: usize) -> &mut [f32] {
    values.resize((count + 1) * size, 0.0);
    &mut values[count * size..]
}
