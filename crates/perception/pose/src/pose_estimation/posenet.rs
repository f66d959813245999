//! PoseNet: poses of several persons by heatmaps and part displacements.
//!
//! Papandreou et al., PersonLab, ECCV 2018; MobileNetV1, Google, Apache-2.0. Its graph has convolutions only, so it runs
//! with any runtime; MoveNet is more precise for few persons.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Keypoint, Pose, PoseList};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::TensorView;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::part_tree::{PartMaps, PartTree, Peak, Person};
use opendr_vision::{InputGeometry, LetterboxAlign, Preprocess};

use crate::pose_estimation::opendr_from_coco;

/// Parameters of [`Posenet`].
#[derive(Debug, Clone, Params)]
pub struct PosenetParams {
    /// Score below which persons are dropped.
    #[param(default = 0.25, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Score below which joints are missing.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub keypoint_threshold: f32,
    /// Score below which joints start no person.
    #[param(default = 0.5, range = 0.01..=0.99, live)]
    pub peak_threshold: f32,
    /// Distance below which joints of one kind belong to one person, in pixels of the network's input.
    #[param(default = 20.0, range = 0.0..=200.0, unit = "px", live)]
    pub nms_radius: f32,
    /// Maximum number of persons per image.
    #[param(default = 20, range = 1..=100, live)]
    pub max_detections: usize,
}

/// A loaded PoseNet.
pub struct Posenet {
    params: PosenetParams,
    network: ImageNetwork,
    heatmap: usize,
    offsets: usize,
    forward: usize,
    backward: usize,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    peaks: Vec<Peak>,
    persons: Vec<Person>,
}

/// Side of the network's input and stride of its cells, in pixels.
const SIDE: usize = 385;
const STRIDE: f32 = 16.0;

impl Learner for Posenet {
    const SPEC: Spec = Spec::new("posenet", Task::PoseEstimation)
        .class("PosenetLearner")
        .about("PoseNet detects 18 joints of several persons; convolutions only.");
    type Params = PosenetParams;
    type Input<'a> = &'a Image;
    type Target = PoseList;
    type State = ();

    fn load(model: &Model, params: PosenetParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open(model, device, |_| {
            Preprocess::new(SIDE, SIDE)
                .letterbox(LetterboxAlign::Centre, 0.0)
                .normalise([127.5; 3], [127.5; 3])
        })?;
        let output = |name: &str| network.output(&format!("MobilenetV1/{name}_2/BiasAdd"));
        Ok(Self {
            heatmap: output("heatmap")?,
            offsets: output("offset")?,
            forward: output("displacement_fwd")?,
            backward: output("displacement_bwd")?,
            scratch: Pool::default(),
            network,
            params,
        })
    }

    fn params(&self) -> &PosenetParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut PosenetParams {
        &mut self.params
    }

    fn infer_into(&self, _: &mut (), image: &Image, poses: &mut PoseList) -> Result<()> {
        let Scratch { peaks, persons } = &mut *self.scratch.take();
        let PosenetParams { peak_threshold, nms_radius, max_detections, .. } = self.params;
        let tree = PartTree { peak_threshold, radius: nms_radius, max_persons: max_detections };
        poses.poses.clear();
        self.network.run(image, |outputs, geometry| {
            tree.decode(&self.maps(outputs)?, peaks, persons);
            poses.poses.extend(persons.iter().filter_map(|person| self.pose(person, geometry)));
            Ok(())
        })?;
        poses.poses.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
        Ok(())
    }
}

impl Posenet {
    fn maps<'a>(&self, outputs: &[TensorView<'a>]) -> Result<PartMaps<'a>> {
        let [1, 17, rows, columns] = *outputs[self.heatmap].shape() else {
            let shape = outputs[self.heatmap].shape();
            return Err(Error::format(format!(
                "the heatmaps need the shape [1, 17, rows, columns], not {shape:?}; load another model"
            )));
        };
        let values = |output: usize, channels: usize| match outputs[output].values::<f32>() {
            Ok(values) if values.len() == rows * columns * channels => Ok(values),
            Ok(values) => Err(Error::format(format!(
                "an output has {} values, which is not {channels} maps; load another model",
                values.len()
            ))),
            Err(error) => Err(error),
        };
        Ok(PartMaps {
            rows,
            columns,
            stride: STRIDE,
            heatmap: values(self.heatmap, 17)?,
            offsets: values(self.offsets, 34)?,
            forward: values(self.forward, 32)?,
            backward: values(self.backward, 32)?,
        })
    }

    fn pose(&self, person: &Person, geometry: &InputGeometry) -> Option<Pose> {
        if person.score.is_nan() || person.score < self.params.threshold {
            return None;
        }
        let joints = person.joints.map(|joint| {
            let [x, y] = geometry.image_from_input([joint.x, joint.y]);
            Keypoint { x, y, ..joint }
        });
        let mut pose = Pose { confidence: person.score, ..Pose::default() };
        opendr_from_coco(&mut pose, &joints, self.params.keypoint_threshold);
        Some(pose)
    }
}
