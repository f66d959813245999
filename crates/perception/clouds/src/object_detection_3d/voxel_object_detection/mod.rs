//! PointPillars: 3D object detection in lidar scans.
//!
//! A. H. Lang, S. Vora, H. Caesar, L. Zhou, J. Yang, O. Beijbom, "PointPillars: Fast encoders for object detection from point
//! clouds", CVPR 2019; implemented from the paper, with a network that is small enough for a CPU. Points are sorted into
//! pillars ([`crate::pillars`]) and one layer computes their features; the features of a pillar are the maximum over all of its
//! points, where the paper uses at most a hundred. Reflectance is not used, so point clouds of x, y and z suffice.

pub mod anchors;
pub mod coding;
pub mod decode;
#[cfg(feature = "training")]
mod fit;
mod layout;
#[cfg(feature = "training")]
mod loss;
#[cfg(feature = "training")]
pub mod matching;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
mod point_features;
mod scan;
#[cfg(feature = "training")]
mod targets;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox3DList, Classes, Name};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::suppression::{BevCandidate, suppress_bev};

use crate::pillars::{Voxeliser, scatter};
use decode::{DecodedBox, PillarMaps};
#[cfg(feature = "training")]
pub use fit::VoxelObjectDetection3dFitParams;
pub use layout::PillarLayout;
#[cfg(feature = "training")]
pub use objective::PillarObjective;
use point_features::PointFeatures;
pub use scan::Scan;

/// Parameters of [`VoxelObjectDetection3d`].
#[derive(Debug, Clone, Params)]
pub struct VoxelObjectDetection3dParams {
    /// Minimum score of a box. OpenDR's default is 0.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU on the ground above which boxes of one class are suppressed.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of boxes before non-maximum suppression, those with the highest scores.
    #[param(default = 400, range = 1..=10_000, live)]
    pub max_candidates: usize,
    /// Maximum number of boxes per scan.
    #[param(default = 100, range = 1..=1000, live)]
    pub max_detections: usize,
}

/// A loaded PointPillars.
pub struct VoxelObjectDetection3d {
    params: VoxelObjectDetection3dParams,
    classes: Classes,
    layout: PillarLayout,
    names: Vec<Name>,
    points: PointFeatures,
    pillars: Session,
    channels: usize,
    outputs: [usize; 3],
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    voxeliser: Voxeliser,
    /// Points that are not yet processed.
    chunk: point_features::Chunk,
    /// `[pillars, channels]`.
    features: Vec<f32>,
    canvas: Vec<f32>,
    found: Vec<DecodedBox>,
    candidates: Vec<BevCandidate>,
    dropped: Vec<bool>,
}

/// File of the network over pillars in every container.
const PILLAR_FILE: &str = "rpn.onnx";
/// Maximum number of channels of the canvas.
const MOST_CHANNELS: usize = 1024;
/// Outputs of the network over pillars.
const OUTPUTS: [&str; 3] = ["scores", "offsets", "backs"];

impl Learner for VoxelObjectDetection3d {
    const SPEC: Spec = Spec::new("voxel_object_detection_3d", Task::ObjectDetection3d)
        .class("VoxelObjectDetection3DLearner")
        .about("PointPillars detects 3D boxes in lidar scans; trainable on your own classes.")
        .without_effect(&[
            ("model_config_path", "the model contains its configuration"),
            ("tanet_config_path", "PointPillars is the only network"),
            ("backbone", "PointPillars is the only network"),
            ("network_head", "the network has a single head"),
            ("scale", "the model contains the range of its point clouds"),
            ("temp_path", "fit writes into its output folder"),
            ("checkpoint_load_iter", "fit resumes from the last checkpoint in its output folder"),
        ]);
    type Params = VoxelObjectDetection3dParams;
    type Input<'a> = Scan<'a>;
    type Target = BoundingBox3DList;
    type State = ();

    fn load(model: &Model, params: VoxelObjectDetection3dParams, device: Device) -> Result<Self> {
        let layout = PillarLayout::from_manifest(model.manifest())?;
        let classes = model.manifest().classes.clone();
        let names = classes.iter().map(Name::from).collect();
        let pillars = Session::open(&model.file(PILLAR_FILE)?, device)?;
        let [rows, columns] = [layout.grid.rows(), layout.grid.columns()].map(Some);
        let channels = match pillars.inputs() {
            [input] if input.dims.len() == 4 && input.dims[2..] == [rows, columns] => {
                input.dims[1].unwrap_or(0)
            }
            _ => 0,
        };
        if !(Voxeliser::STATISTICS + 1..=MOST_CHANNELS).contains(&channels) {
            return Err(Error::format(format!(
                "{PILLAR_FILE} does not take a canvas of {rows:?} x {columns:?} pillars, the model's grid; train or download \
                 it again"
            )));
        }
        let points = PointFeatures::open(model, device, channels - Voxeliser::STATISTICS)?;
        let [scores, offsets, backs] = OUTPUTS.map(|name| pillars.output_index(name));
        let outputs = [scores?, offsets?, backs?];
        Ok(Self {
            params,
            classes,
            layout,
            names,
            points,
            pillars,
            channels,
            outputs,
            scratch: Pool::default(),
        })
    }

    fn params(&self) -> &VoxelObjectDetection3dParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut VoxelObjectDetection3dParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    /// Skips points that are not finite or outside of the grid; without points there are no boxes.
    fn infer_into(&self, _: &mut (), scan: Scan<'_>, boxes: &mut BoundingBox3DList) -> Result<()> {
        let scratch = &mut *self.scratch.take();
        boxes.boxes.clear();
        boxes.classes.clone_from(&self.classes);
        boxes.action = None;
        self.points.run(
            scan.cloud(),
            &self.layout.grid,
            &mut scratch.voxeliser,
            &mut scratch.chunk,
            &mut scratch.features,
        )?;
        if scratch.voxeliser.cells().is_empty() {
            return Ok(());
        }
        let grid = &self.layout.grid;
        scratch.canvas.resize(self.channels * grid.cells(), 0.0);
        scatter(&scratch.features, self.channels, scratch.voxeliser.cells(), &mut scratch.canvas);
        scratch.found.clear();
        let shape = [1, self.channels, grid.rows(), grid.columns()];
        let input = TensorView::new(&shape, &scratch.canvas[..])?;
        self.pillars.run(&[input], |outputs| {
            let maps = self.maps(outputs)?;
            maps.decode(&self.layout, self.params.threshold, &mut scratch.found);
            Ok(())
        })?;
        self.suppress(scratch);
        for candidate in &scratch.candidates {
            let Some(DecodedBox { place, score, class }) = scratch.found.get(candidate.index as usize) else {
                continue;
            };
            let mut found = place.to_camera(scan.calibration(), scan.image_shape());
            // As in KITTI, boxes outside of the camera image are dropped.
            if scan.image_shape().is_some() && found.truncated >= 1.0 {
                continue;
            }
            found.name = self.names.get(*class as usize).cloned().unwrap_or_default();
            found.confidence = *score;
            boxes.boxes.push(found);
        }
        Ok(())
    }
}

impl VoxelObjectDetection3d {
    fn maps<'a>(&self, outputs: &[TensorView<'a>]) -> Result<PillarMaps<'a>> {
        let ([columns, rows], kinds) = (self.layout.maps(), self.layout.anchors.len());
        let values = |output: usize, maps: usize| {
            let output = &outputs[self.outputs[output]];
            if *output.shape() != [1, maps, rows, columns] {
                return Err(Error::format(format!(
                    "an output of the model is {:?}, but its grid and anchors require {:?}; train or download it again",
                    output.shape(),
                    [1, maps, rows, columns]
                )));
            }
            output.values::<f32>()
        };
        let offsets = values(1, kinds * coding::NUMBERS)?;
        Ok(PillarMaps { scores: values(0, kinds)?, offsets, directions: values(2, kinds)? })
    }

    /// Non-maximum suppression; boxes are sorted by score.
    fn suppress(&self, scratch: &mut Scratch) {
        let Scratch { found, candidates, dropped, .. } = scratch;
        let VoxelObjectDetection3dParams { iou_threshold, max_candidates, max_detections, .. } = self.params;
        if found.len() > max_candidates {
            found.select_nth_unstable_by(max_candidates - 1, |a, b| b.score.total_cmp(&a.score));
            found.truncate(max_candidates);
        }
        candidates.clear();
        candidates.extend((0..).zip(found.iter()).map(|(index, found)| {
            let floor = found.place.upright_box().base;
            BevCandidate { footprint: floor, score: found.score, class: found.class, index }
        }));
        suppress_bev(candidates, dropped, iou_threshold, max_detections);
    }
}
