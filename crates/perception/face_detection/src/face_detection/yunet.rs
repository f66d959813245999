//! YuNet: a face detector of 75 thousand parameters with five landmarks.
//!
//! Wu et al., YuNet: A Tiny Millisecond-level Face Detector, Machine Intelligence Research 2023. It detects faces from
//! about 10 pixels in the network's input; the variant `dynamic` with a larger `size` suits crowds. A container may contain
//! a network as its part `mask` that classifies faces with and without a mask, as OpenDR's RetinaFace does.

use std::array;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind};
use opendr_vision::{ChannelOrder, InputGeometry, LetterboxAlign, Preprocess};

use super::masked_face::MaskNetwork;

/// Parameters of [`Yunet`].
#[derive(Debug, Clone, Params)]
pub struct YunetParams {
    /// Score below which faces are dropped.
    #[param(default = 0.6, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU above which boxes count as one face.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of faces per image.
    #[param(default = 200, range = 1..=1000, live)]
    pub max_detections: usize,
    /// Side of the network's input, for models of dynamic size; a multiple of 32.
    #[param(default = 640, range = 32..=4096, unit = "px")]
    pub size: usize,
    /// Method of non-maximum suppression.
    #[param(live)]
    pub suppression: SuppressionKind,
}

/// A loaded YuNet.
pub struct Yunet {
    params: YunetParams,
    classes: Classes,
    network: ImageNetwork,
    side: usize,
    levels: [Level; 3],
    masks: Option<MaskNetwork>,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    candidates: Vec<Candidate>,
    landmarks: Vec<[[f32; 2]; 5]>,
    marks: Vec<bool>,
}

/// One level of the feature pyramid and the indices of its outputs.
#[derive(Clone, Copy)]
struct Level {
    stride: usize,
    class: usize,
    object: usize,
    corners: usize,
    landmarks: usize,
}

impl Learner for Yunet {
    const SPEC: Spec = Spec::new("yunet", Task::FaceDetection)
        .class("YunetLearner")
        .about("YuNet detects faces with eyes, nose and corners of the mouth; tiny and fast.");
    type Params = YunetParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, mut params: YunetParams, device: Device) -> Result<Self> {
        let mut side = params.size.next_multiple_of(32);
        let network = ImageNetwork::open(model, device, |input| {
            side = input.dims.get(2).copied().flatten().unwrap_or(side);
            Preprocess::new(side, side).letterbox(LetterboxAlign::TopLeft, 0.0).order(ChannelOrder::Bgr)
        })?;
        params.size = side;
        let level = |stride: usize| -> Result<Level> {
            let output = |name: &str| network.output(&format!("{name}_{stride}"));
            let (class, object) = (output("cls")?, output("obj")?);
            Ok(Level { stride, class, object, corners: output("bbox")?, landmarks: output("kps")? })
        };
        let classes = model.manifest().classes.clone();
        Ok(Self {
            levels: [level(8)?, level(16)?, level(32)?],
            masks: MaskNetwork::open(model, &classes, device)?,
            classes,
            scratch: Pool::default(),
            network,
            side,
            params,
        })
    }

    fn params(&self) -> &YunetParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut YunetParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, faces: &mut BoundingBoxList) -> Result<()> {
        let Scratch { candidates, landmarks, marks } = &mut *self.scratch.take();
        let YunetParams { threshold, iou_threshold, max_detections, suppression, .. } = self.params;
        let suppression =
            Suppression { kind: suppression, iou_threshold, threshold, max_boxes: max_detections };
        candidates.clear();
        landmarks.clear();
        faces.classes.clone_from(&self.classes);
        faces.boxes.clear();
        self.network.run(image, |outputs, geometry| {
            for level in &self.levels {
                let at = |output: usize| outputs[output].values::<f32>();
                let fields = [at(level.class)?, at(level.object)?, at(level.corners)?, at(level.landmarks)?];
                level.decode(self.side / level.stride, fields, threshold, candidates, landmarks);
            }
            suppression.run(candidates, marks);
            faces.boxes.extend(candidates.iter().map(|candidate| face(candidate, landmarks, geometry)));
            Ok(())
        })?;
        self.masks.as_ref().map_or(Ok(()), |masks| masks.name(image, &mut faces.boxes))
    }
}

/// Converts a candidate to a face. Its box is not clipped to the image, as alignment needs all of it.
fn face(candidate: &Candidate, landmarks: &[[[f32; 2]; 5]], geometry: &InputGeometry) -> BoundingBox {
    let [x0, y0, x1, y1] = candidate.corners;
    let ([left, top], [right, bottom]) =
        (geometry.image_from_input([x0, y0]), geometry.image_from_input([x1, y1]));
    let mut found = BoundingBox::from_corners(0, [left, top, right, bottom], candidate.score);
    let points = landmarks.get(candidate.index as usize).into_iter().flatten();
    found.landmarks.extend(points.map(|point| geometry.image_from_input(*point)));
    found
}

impl Level {
    /// Decodes `[cells]` class and object scores, `[cells, 4]` boxes and `[cells, 10]` landmarks, all relative to the
    /// cell's left-top corner, in strides.
    fn decode(
        &self,
        columns: usize,
        [class, object, corners, points]: [&[f32]; 4],
        threshold: f32,
        candidates: &mut Vec<Candidate>,
        landmarks: &mut Vec<[[f32; 2]; 5]>,
    ) {
        let stride = self.stride as f32;
        let rows = class.iter().zip(object).zip(corners.chunks_exact(4)).zip(points.chunks_exact(10));
        for (cell, (((class, object), corners), points)) in rows.enumerate() {
            let score = (class.clamp(0.0, 1.0) * object.clamp(0.0, 1.0)).sqrt();
            if score.is_nan() || score < threshold {
                continue;
            }
            let (column, row) = ((cell % columns) as f32, (cell / columns) as f32);
            let (x, y) = ((column + corners[0]) * stride, (row + corners[1]) * stride);
            let (width, height) = (corners[2].exp() * stride, corners[3].exp() * stride);
            let corners = [x - width / 2.0, y - height / 2.0, x + width / 2.0, y + height / 2.0];
            candidates.push(Candidate { corners, score, class: 0, index: landmarks.len() as u32 });
            landmarks.push(array::from_fn(|point| {
                [(column + points[2 * point]) * stride, (row + points[2 * point + 1]) * stride]
            }));
        }
    }
}
