//! GR-ConvNet: quality, angle and width of a parallel-jaw grasp at every pixel.
//!
//! Kumra, Joshi and Sahin, Antipodal Robotic Grasping using Generative Residual Convolutional Neural Network, IROS 2020 (arXiv
//! 1909.04810). The network takes the central square of the images. Its maps are smoothed as in the authors' code; the peaks of
//! the quality, at a minimum distance, are the grasps: a pose of two keypoints, the jaws.

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

/// Parameters of [`GrConvNet`].
#[derive(Debug, Clone, Params)]
pub struct GrConvNetParams {
    /// Minimum quality of a grasp.
    #[param(default = 0.2, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Maximum number of grasps per image.
    #[param(default = 5, range = 1..=100, live)]
    pub max_grasps: usize,
    /// Minimum distance between two grasps, in pixels of the network's map of 224.
    #[param(default = 20, range = 1..=224, unit = "px", live)]
    pub distance: usize,
}

/// A colour image and its depth.
#[derive(Inputs)]
pub struct GrConvNetInputs<'a> {
    /// The colour image.
    pub image: &'a Image,
    /// Depth of the same view and size: one channel, 16 bits in millimetres or floats in metres; 0 for unknown.
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

/// Side of the network's input in pixels.
const SIDE: usize = 224;
const PIXELS: usize = SIDE * SIDE;
/// Width in pixels of the network's input that an output of 1 stands for.
const WIDTH: f32 = 150.0;

impl Learner for GrConvNet {
    const SPEC: Spec = Spec::new("gr_conv_net", Task::GraspDetection)
        .class("GrConvNetLearner")
        .about("GR-ConvNet detects grasps of a parallel-jaw gripper in colour and depth.");
    type Params = GrConvNetParams;
    type Input<'a> = GrConvNetInputs<'a>;
    type Target = PoseList;
    type State = ();

    fn load(model: &Model, params: GrConvNetParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file("model.onnx")?, device)?;
        let fits = matches!(session.inputs(), [input] if input.dims[..] == [Some(1), Some(4), Some(SIDE), Some(SIDE)]);
        if !fits {
            return Err(Error::format(format!(
                "the network does not take depth, red, green and blue of {SIDE}x{SIDE} pixels, so it is not GR-ConvNet"
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
                "the image has {}x{} pixels and the depth {}x{}; both must have the same size",
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
