//! GR-ConvNet: for every pixel, how well a gripper with two jaws would hold there, turned how far and opened how wide.
//!
//! Kumra, Joshi and Sahin, Antipodal Robotic Grasping using Generative Residual Convolutional Neural Network, IROS 2020
//! (arXiv 1909.04810). The network sees the middle square of the pictures. Its maps are smoothed as the authors do, and
//! the highest places of the first, far enough from each other, are the grasps: a pose of two joints, the jaws.

mod depth;
mod maps;

use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Keypoint, Pose, PoseList, Skeleton};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_vision::{Preprocess, Similarity};

use depth::depth_square;
use maps::{Maps, Peak};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct GrConvNetParams {
    /// Least quality of a grasp.
    #[param(default = 0.2, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Most grasps of a picture.
    #[param(default = 5, range = 1..=100, live)]
    pub max_grasps: usize,
    /// Least distance between two grasps, pixels of the network's map of 224.
    #[param(default = 20, range = 1..=224, unit = "px", live)]
    pub distance: usize,
}

/// A colour picture and the depth of each of its pixels.
#[derive(Inputs)]
pub struct GrConvNetInputs<'a> {
    /// In colour.
    pub image: &'a Image,
    /// Of the same size and place: one channel, 16 bits in millimetres or floats in metres; 0 where nothing is known.
    pub depth: &'a Image,
}

/// A loaded GR-ConvNet.
pub struct GrConvNet {
    params: GrConvNetParams,
    session: Session,
    preprocess: Preprocess,
    outputs: [usize; 4],
    work: Pool<Work>,
}

#[derive(Default)]
struct Work {
    input: Vec<f32>,
    maps: Maps,
    peaks: Vec<Peak>,
}

/// Side of what the network sees, pixels.
const SIDE: usize = 224;
const PIXELS: usize = SIDE * SIDE;
/// The network's width of 1 are as many of its pixels.
const WIDTH: f32 = 150.0;

impl Learner for GrConvNet {
    const SPEC: Spec = Spec::new("gr_conv_net", Task::GraspDetection)
        .class("GrConvNetLearner")
        .about("GR-ConvNet finds where a gripper can take hold, in colour and depth.");
    type Params = GrConvNetParams;
    type Input<'a> = GrConvNetInputs<'a>;
    type Target = PoseList;
    type State = ();

    fn load(model: &Model, params: GrConvNetParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file("model.onnx")?, device)?;
        let fits = matches!(session.inputs(), [input] if input.dims[..] == [Some(1), Some(4), Some(SIDE), Some(SIDE)]);
        if !fits {
            return Err(Error::format(format!(
                "GR-ConvNet takes depth, red, green and blue of {SIDE}x{SIDE} pixels; this network does not"
            )));
        }
        let outputs = ["pos", "cos", "sin", "width"].map(|name| session.output_index(name));
        let [quality, cosine, sine, width] = outputs;
        let outputs = [quality?, cosine?, sine?, width?];
        let preprocess = Preprocess::new(SIDE, SIDE).normalise([0.0; 3], [255.0; 3]);
        Ok(Self { params, session, preprocess, outputs, work: Pool::default() })
    }

    fn params(&self) -> &GrConvNetParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut GrConvNetParams {
        &mut self.params
    }

    fn infer_into(&self, _: &mut (), input: GrConvNetInputs<'_>, grasps: &mut PoseList) -> Result<()> {
        let (image, depth) = (input.image, input.depth);
        let size = [image.width(), image.height()];
        if [depth.width(), depth.height()] != size {
            return Err(Error::invalid_input(format!(
                "a picture of {}x{} pixels and a depth of {}x{}; both are of one size and place",
                size[0],
                size[1],
                depth.width(),
                depth.height()
            )));
        }
        let side = size[0].min(size[1]) as f32;
        let crop = Similarity::rotated_square(size.map(|length| length as f32 / 2.0), side, 0.0, SIDE);
        let Work { input, maps, peaks } = &mut *self.work.take();
        input.resize(4 * PIXELS, 0.0);
        let (depths, colours) = input.split_at_mut(PIXELS);
        depth_square(depth, &crop, SIDE, depths)?;
        self.preprocess.warp_into(image.view(), &crop, colours)?;
        let mean = colours.iter().sum::<f32>() / colours.len() as f32;
        colours.iter_mut().for_each(|level| *level -= mean);
        let input = TensorView::new(&[1, 4, SIDE, SIDE], &input[..])?;
        self.session.run(&[input], |outputs| {
            let [quality, cosine, sine, width] = self.outputs.map(|output| outputs[output].values::<f32>());
            maps.read([quality?, cosine?, sine?, width?], SIDE)
        })?;
        let GrConvNetParams { threshold, max_grasps, distance } = self.params;
        maps.peaks(SIDE, threshold, distance, max_grasps, peaks);
        grasps.poses.resize_with(peaks.len(), Pose::default);
        for (grasp, peak) in grasps.poses.iter_mut().zip(&*peaks) {
            let middle = [peak.x, peak.y].map(|at| at as f32 + 0.5);
            let reach = 0.5 * WIDTH * peak.width.max(0.0);
            let (sine, cosine) = peak.angle.sin_cos();
            let jaw = |side: f32| {
                let [x, y] = crop
                    .image_from_crop([middle[0] + side * reach * cosine, middle[1] - side * reach * sine]);
                Keypoint { x, y, confidence: peak.quality.clamp(0.0, 1.0) }
            };
            grasp.skeleton = Skeleton::Grasp2;
            grasp.confidence = peak.quality.clamp(0.0, 1.0);
            grasp.keypoints.clear();
            grasp.keypoints.extend([jaw(-1.0), jaw(1.0)]);
        }
        Ok(())
    }
}
