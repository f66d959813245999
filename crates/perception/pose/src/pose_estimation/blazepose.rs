//! BlazePose: 33 keypoints of one person, tracked from frame to frame.
//!
//! Bazarevsky et al., "BlazePose: On-device Real-time Body Pose Tracking", 2020, Apache-2.0. The input of the network is a
//! rotated square around the person; two of its keypoints define the square of the next frame. A person who is not tracked
//! yet is searched in the whole image, then in the square of that result, so the person should be the largest one, and
//! alone. For several persons use MoveNet MultiPose or Lightweight OpenPose.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Keypoint, Pose, PoseList, Skeleton};
use opendr_engine::{Device, Error, Result, Task};
use opendr_perception_common::image_network::{ImageNetwork, preprocess_from_input};
use opendr_perception_common::rotated_square::{RotatedSquare, angle_upwards};
use opendr_vision::Border;

/// Parameters of [`BlazePose`].
#[derive(Debug, Clone, Params)]
pub struct BlazePoseParams {
    /// Score below which the person is dropped and not tracked further.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Probability of visibility below which keypoints are missing.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub keypoint_threshold: f32,
    /// Number of passes for a person who is not tracked yet; each pass starts from the square of the previous one.
    #[param(default = 2, range = 1..=4, live, former = "looks")]
    pub passes: usize,
    /// Whether the person is tracked from frame to frame; switch it off for single images.
    #[param(default = true, live)]
    pub track: bool,
}

/// A loaded BlazePose.
pub struct BlazePose {
    params: BlazePoseParams,
    network: ImageNetwork,
    side: usize,
    outputs: [usize; 2],
}

/// State of a stream: the last square of the person.
#[derive(Default)]
pub struct BlazePoseState {
    size: [usize; 2],
    square: Option<RotatedSquare>,
}

/// Names of the outputs: 39 points, each x, y, z, visibility and presence; the score of the person.
const OUTPUTS: [&str; 2] = ["Identity", "Identity_1"];
const POINT: usize = 5;
/// Number of keypoints of the skeleton, and number of all points with those that define the square.
const JOINTS: usize = 33;
const POINTS: usize = 39;
/// Indices of the centre of the hips, and of a point above it on the circle around the person.
const HIPS: usize = 33;
const ABOVE: usize = 34;
/// Side of the square in diameters of that circle (MediaPipe).
const ROOM: f32 = 1.25;

impl Learner for BlazePose {
    const SPEC: Spec = Spec::new("blazepose", Task::PoseEstimation)
        .class("BlazePoseLearner")
        .about("BlazePose detects and tracks 33 keypoints of one person, including hands, feet and face.");
    type Params = BlazePoseParams;
    type Input<'a> = &'a Image;
    type Target = PoseList;
    type State = BlazePoseState;

    fn load(model: &Model, params: BlazePoseParams, device: Device) -> Result<Self> {
        let mut side = 0;
        let network = ImageNetwork::open_file(model, "model.onnx", device, |input| {
            let preprocess =
                preprocess_from_input(input)?.border(Border::Constant(0.0)).normalise([0.0; 3], [255.0; 3]);
            let [width, height] = preprocess.size();
            side = width;
            match width == height {
                true => Ok(preprocess),
                false => Err(Error::format(format!(
                    "the network's input is {width}x{height}; BlazePose needs a square one"
                ))),
            }
        })?;
        let [points, score] = OUTPUTS;
        let outputs = [network.output(points)?, network.output(score)?];
        Ok(Self { params, network, side, outputs })
    }

    fn params(&self) -> &BlazePoseParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut BlazePoseParams {
        &mut self.params
    }

    fn infer_into(&self, state: &mut BlazePoseState, image: &Image, poses: &mut PoseList) -> Result<()> {
        let size = [image.width(), image.height()];
        let known = state.square.take().filter(|_| self.params.track && state.size == size);
        state.size = size;
        poses.poses.resize_with(1, Pose::default);
        let looks = if known.is_some() { 1 } else { self.params.passes };
        let mut square = Some(known.unwrap_or_else(|| whole(size)));
        for _ in 0..looks {
            let Some(at) = square.filter(|square| square.is_in(size)) else { break };
            square = self.predict(image, &at, &mut poses.poses[0])?;
            if square.is_none() {
                break;
            }
        }
        if square.is_none_or(|square| !square.is_in(size)) {
            poses.poses.clear();
        } else if self.params.track {
            state.square = square;
        }
        Ok(())
    }
}

impl BlazePose {
    /// Writes the person in a square into `pose` and returns the next square; `None` without a person.
    fn predict(
        &self,
        image: &Image,
        square: &RotatedSquare,
        pose: &mut Pose,
    ) -> Result<Option<RotatedSquare>> {
        let crop = square.crop(self.side);
        let mut next = None;
        self.network.run_crop(image, &crop, |outputs| {
            let [points, score] = self.outputs.map(|output| outputs[output].values::<f32>());
            let (points, score) = (points?, score?);
            let (true, &[score]) = (points.len() == POINTS * POINT, score) else {
                return Err(Error::format(format!(
                    "BlazePose needs outputs of {} values and 1 score, not {} and {}",
                    POINTS * POINT,
                    points.len(),
                    score.len()
                )));
            };
            let place =
                |point: usize| crop.image_from_crop([points[point * POINT], points[point * POINT + 1]]);
            let finite = points.iter().all(|number| number.is_finite());
            if !finite || score.is_nan() || score < self.params.threshold {
                return Ok(());
            }
            let keypoint = |point: usize| {
                let ([x, y], logit) = (place(point), points[point * POINT + 3]);
                let confidence = 1.0 / (1.0 + (-logit).exp());
                match confidence < self.params.keypoint_threshold {
                    true => Keypoint::MISSING,
                    false => Keypoint { x, y, confidence },
                }
            };
            pose.keypoints.clear();
            pose.keypoints.extend((0..JOINTS).map(keypoint));
            (pose.confidence, pose.skeleton) = (score, Skeleton::Blazepose33);
            (pose.id, pose.region) = (None, None);
            let [hips, above] = [HIPS, ABOVE].map(place);
            let radius = (above[0] - hips[0]).hypot(above[1] - hips[1]);
            next = Some(RotatedSquare {
                centre: hips,
                side: 2.0 * radius * ROOM,
                angle: angle_upwards(hips, above),
            });
            Ok(())
        })?;
        Ok(next)
    }
}

/// Returns the whole image, upright.
fn whole([width, height]: [usize; 2]) -> RotatedSquare {
    let [width, height] = [width as f32, height as f32];
    RotatedSquare { centre: [width / 2.0, height / 2.0], side: width.max(height), angle: 0.0 }
}

#[cfg(test)]
mod tests {
    use std::env;
    use std::path::PathBuf;

    use opendr_engine::learner::Handle;
    use opendr_engine::model::{Manifest, ModelWriter};

    use super::*;

    /// BlazePose's indices of COCO's 17 joints.
    const COCO: [usize; 17] = [0, 2, 5, 7, 8, 11, 12, 13, 14, 15, 16, 23, 24, 25, 26, 27, 28];

    fn handle(shared: &std::path::Path) -> Handle<BlazePose> {
        let network = std::fs::read(shared.join("models/pose/blazepose_landmark_full_256.onnx")).unwrap();
        let folder = env::temp_dir().join(format!(
            "opendr-blazepose-{}-{:?}",
            std::process::id(),
            std::thread::current().id()
        ));
        let mut writer = ModelWriter::new(&folder, Manifest::new("blazepose", "full")).unwrap();
        writer.add("model.onnx", &network).unwrap();
        let mut handle = Handle::new(BlazePoseParams::default(), Device::Cpu).unwrap();
        handle.load_model(writer.finish().unwrap()).unwrap();
        std::fs::remove_dir_all(folder).unwrap();
        handle
    }

    #[test]
    fn points_lie_where_coco_has_them() {
        let Some(shared) = env::var_os("OPENDR_TEST_DATA").map(PathBuf::from) else {
            println!("skipped: no OPENDR_TEST_DATA");
            return;
        };
        let folder = shared.join("data/mmpose_samples/coco");
        let text = std::fs::read_to_string(folder.join("test_coco.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        let annotations = json["annotations"].as_array().unwrap();
        let of_picture = |annotation: &&serde_json::Value| annotation["image_id"] == 785;
        let person = annotations.iter().find(of_picture).unwrap();
        let numbers: Vec<f32> =
            person["keypoints"].as_array().unwrap().iter().map(|n| n.as_f64().unwrap() as f32).collect();
        let image = opendr_vision::open(folder.join("000000000785.jpg")).unwrap();
        let mut handle = handle(&shared);
        let first = handle.infer(&image).unwrap();
        let again = handle.infer(&image).unwrap();
        for poses in [&first, &again] {
            let [pose] = &poses.poses[..] else { panic!("{poses:#}") };
            assert_eq!((pose.skeleton, pose.keypoints.len()), (Skeleton::Blazepose33, JOINTS));
            let near = COCO.iter().zip(numbers.chunks_exact(3)).filter(|(_, joint)| joint[2] > 0.0);
            let distances: Vec<f32> = near
                .map(|(at, joint)| (pose.keypoints[*at].x - joint[0]).hypot(pose.keypoints[*at].y - joint[1]))
                .collect();
            let mean = distances.iter().sum::<f32>() / distances.len() as f32;
            println!("{mean:.1} pixels off on average, the person is 347 high");
            assert!(mean < 0.05 * 347.0, "{distances:?}");
        }
        handle.reset();
        assert_eq!(handle.infer(&image).unwrap(), first);
        for (width, height) in [(1, 1), (300, 2), (640, 480)] {
            let black = Image::from_rgb8(vec![0; width * height * 3], width, height).unwrap();
            assert_eq!(handle.infer(&black).unwrap().poses, [], "{width}x{height}");
        }
    }
}
