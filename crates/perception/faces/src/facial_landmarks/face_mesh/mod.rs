//! Face mesh: 468 points of a face and five of each iris, from whole images.
//!
//! MediaPipe's networks (Kartynnik et al., Real-time Facial Surface Geometry from Monocular Video on Mobile GPUs, 2019;
//! Ablavatski et al., Real-time Pupil Tracking from Monocular Video, 2020; Google, Apache-2.0). The detector detects a face
//! once; then its crop follows from the points of the last frame, as in MediaPipe.

mod crop;

use opendr_engine::data::{Image, Layout};
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Keypoint, Pose, PoseList, Skeleton};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_face_detection::face_detector::FaceDetector;
use opendr_inference::{TensorInfo, default_threads, with_threads};
use opendr_kernels::WorkerPool;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_vision::{Preprocess, Similarity};

use crop::EYES;

/// Parameters of [`FaceMesh`].
#[derive(Debug, Clone, Params)]
pub struct FaceMeshParams {
    /// Score of the mesh below which faces are dropped.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Score of the detector below which faces are dropped.
    #[param(default = 0.6, range = 0.0..=1.0)]
    pub face_threshold: f32,
    /// Maximum number of faces per image; the detector runs on frames with fewer.
    #[param(default = 1, range = 1..=50, live)]
    pub max_faces: usize,
    /// Whether faces are tracked from frame to frame; otherwise the detector runs on each frame.
    #[param(default = true, live)]
    pub track: bool,
}

/// The loaded networks of mesh, irises and detector.
///
/// Its predictions are a pose of [`Skeleton::Face478`] for every face, those tracked longest first, with their identities;
/// the confidence of a point is that of its face.
pub struct FaceMesh {
    params: FaceMeshParams,
    finder: FaceDetector,
    mesh: ImageNetwork,
    /// Networks of the irises, one per eye and thread: the network is too small to run on several threads.
    irises: [ImageNetwork; 2],
    eyes: WorkerPool,
    outputs: MeshOutputs,
    iris_at: IrisAt,
    scratch: Pool<Scratch>,
}

/// The tracked faces of one stream.
#[derive(Debug, Default)]
pub struct FaceTracks {
    tracks: Vec<Track>,
    next: i64,
}

#[derive(Debug, Clone, Copy)]
struct Track {
    id: i64,
    crop: Similarity,
}

#[derive(Default)]
struct Scratch {
    faces: BoundingBoxList,
    tracks: Vec<Track>,
}

/// Indices of the mesh's outputs: points and score.
#[derive(Debug, Clone, Copy)]
struct MeshOutputs {
    points: usize,
    presence: usize,
}

/// Index of the output with the points of the iris, and their offset in it.
#[derive(Debug, Clone, Copy)]
struct IrisAt {
    output: usize,
    offset: usize,
}

/// File names of the networks in a container.
const FILES: [&str; 2] = ["model.onnx", "iris.onnx"];
/// Sides of the networks' inputs, in pixels.
const SIDE: usize = 192;
const EYE_SIDE: usize = 64;
/// Numbers of points of the mesh and of an iris.
const MESH: usize = 468;
const IRIS: usize = 5;
/// Number of values before those of the iris in a common output: 71 points of the eye's outline.
const EYE_OUTLINE: usize = 71 * 3;

/// Returns the pre-processing to values 0..=1, in the layout of the network.
fn preprocess(input: &TensorInfo, side: usize) -> Preprocess {
    let layout = if input.dims.last() == Some(&Some(3)) { Layout::Hwc } else { Layout::Chw };
    Preprocess::new(side, side).normalise([0.0; 3], [255.0; 3]).layout(layout)
}

/// Returns the index of the output with `numbers` values.
fn output_of(network: &ImageNetwork, numbers: usize) -> Option<usize> {
    let size =
        |output: &TensorInfo| output.dims.iter().skip(1).try_fold(1, |size, side| Some(size * (*side)?));
    network.outputs().iter().position(|output| size(output) == Some(numbers))
}

impl Learner for FaceMesh {
    const SPEC: Spec = Spec::new("face_mesh", Task::FacialLandmarks)
        .class("FaceMeshLearner")
        .about("MediaPipe's face mesh: 468 points of a face and its irises, tracked from frame to frame.");
    type Params = FaceMeshParams;
    type Input<'a> = &'a Image;
    type Target = PoseList;
    type State = FaceTracks;

    fn load(model: &Model, params: FaceMeshParams, device: Device) -> Result<Self> {
        let mesh = ImageNetwork::open_file(model, FILES[0], device, |input| Ok(preprocess(input, SIDE)))?;
        let open_iris =
            || ImageNetwork::open_file(model, FILES[1], device, |input| Ok(preprocess(input, EYE_SIDE)));
        let irises = with_threads(1, || Ok::<_, Error>([open_iris()?, open_iris()?]))?;
        let [iris, _] = &irises;
        let (Some(points), Some(presence)) = (output_of(&mesh, 3 * MESH), output_of(&mesh, 1)) else {
            return Err(Error::format(format!(
                "{} has no outputs of {MESH} points and a score; load another model",
                FILES[0]
            )));
        };
        let alone = output_of(iris, 3 * IRIS).map(|output| IrisAt { output, offset: 0 });
        let both = || {
            let output = output_of(iris, EYE_OUTLINE + 3 * IRIS)?;
            Some(IrisAt { output, offset: EYE_OUTLINE })
        };
        let Some(iris_at) = alone.or_else(both) else {
            return Err(Error::format(format!(
                "{} has no output of {IRIS} points of an iris; load another model",
                FILES[1]
            )));
        };
        Ok(Self {
            finder: FaceDetector::open(model, params.face_threshold, device)?,
            outputs: MeshOutputs { points, presence },
            scratch: Pool::default(),
            mesh,
            irises,
            eyes: WorkerPool::new(default_threads()?.min(2)),
            iris_at,
            params,
        })
    }

    fn params(&self) -> &FaceMeshParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut FaceMeshParams {
        &mut self.params
    }

    fn infer_into(&self, state: &mut FaceTracks, image: &Image, poses: &mut PoseList) -> Result<()> {
        let Scratch { faces, tracks } = &mut *self.scratch.take();
        let most = self.params.max_faces;
        tracks.clear();
        if self.params.track {
            tracks.append(&mut state.tracks);
        }
        tracks.truncate(most);
        state.tracks.clear();
        let mut found = 0;
        for track in tracks.drain(..) {
            found += self.predict(track, found, image, state, poses)?;
        }
        if found < most {
            self.finder.detect(image, faces)?;
            for face in &faces.boxes {
                let crop = crop::of_found(face, SIDE);
                let is_known = state.tracks.iter().any(|track| crop::is_same(&track.crop, &crop, SIDE));
                if found < most && !is_known && crop.is_regular() {
                    let count = self.predict(Track { id: state.next, crop }, found, image, state, poses)?;
                    state.next += count as i64;
                    found += count;
                }
            }
        }
        poses.poses.truncate(found);
        Ok(())
    }
}

impl FaceMesh {
    /// Fills the pose at index `at` with the face in the crop of `track` and tracks it further. Returns 1, or 0 without a
    /// face.
    fn predict(
        &self,
        track: Track,
        at: usize,
        image: &Image,
        state: &mut FaceTracks,
        poses: &mut PoseList,
    ) -> Result<usize> {
        if poses.poses.len() <= at {
            poses.poses.push(Pose::default());
        }
        let Some(pose) = poses.poses.get_mut(at) else { return Ok(0) };
        self.fill_mesh(image, &track.crop, pose)?;
        let next = crop::of_mesh(&pose.keypoints, SIDE);
        let (Some(crop), true) = (next, pose.confidence >= self.params.threshold) else { return Ok(0) };
        self.add_irises(image, pose)?;
        (pose.id, pose.skeleton, pose.region) = (Some(track.id), Skeleton::Face478, None);
        state.tracks.push(Track { crop, ..track });
        Ok(1)
    }

    fn fill_mesh(&self, image: &Image, crop: &Similarity, pose: &mut Pose) -> Result<()> {
        self.mesh.run_warped(
            image,
            crop,
            |_| {},
            |outputs| {
                let presence = outputs[self.outputs.presence].values::<f32>()?;
                // TensorFlow.js's form of the network has a probability as output; MediaPipe's own has its logit, far
                // beyond 0..=1.
                let confidence = presence.first().copied().unwrap_or(0.0).clamp(0.0, 1.0);
                let points = outputs[self.outputs.points].values::<f32>()?;
                pose.confidence = confidence;
                pose.keypoints.clear();
                pose.keypoints.extend(points.chunks_exact(3).take(MESH).map(|point| {
                    let [x, y] = crop.image_from_crop([point[0], point[1]]);
                    Keypoint { x, y, confidence }
                }));
                Ok(())
            },
        )
    }

    fn add_irises(&self, image: &Image, pose: &mut Pose) -> Result<()> {
        let (mut first, mut second) = (Ok([Keypoint::MISSING; IRIS]), Ok([Keypoint::MISSING; IRIS]));
        let ([one, other], [network, mirrored]) = (EYES, &self.irises);
        self.eyes.join(
            || first = self.iris(network, image, one, false, pose),
            || second = self.iris(mirrored, image, other, true, pose),
        );
        let (first, second) = (first?, second?);
        pose.keypoints.extend(first.into_iter().chain(second));
        Ok(())
    }

    /// Returns the points of an iris. The network is for one eye, so the crop of the other is flipped. The points are
    /// missing when there is no valid crop.
    fn iris(
        &self,
        network: &ImageNetwork,
        image: &Image,
        corners: [usize; 2],
        is_mirrored: bool,
        pose: &Pose,
    ) -> Result<[Keypoint; IRIS]> {
        let mut iris = [Keypoint::MISSING; IRIS];
        let Some(crop) = crop::of_eye(&pose.keypoints, corners, EYE_SIDE) else { return Ok(iris) };
        let confidence = pose.confidence;
        let mirror = |input: &mut [f32]| {
            if is_mirrored {
                network.mirror(input);
            }
        };
        network.run_warped(image, &crop, mirror, |outputs| {
            let numbers = outputs[self.iris_at.output].values::<f32>()?;
            let points = numbers.get(self.iris_at.offset..).unwrap_or_default().chunks_exact(3);
            for (keypoint, point) in iris.iter_mut().zip(points) {
                let x = if is_mirrored { EYE_SIDE as f32 - point[0] } else { point[0] };
                let [x, y] = crop.image_from_crop([x, point[1]]);
                *keypoint = Keypoint { x, y, confidence };
            }
            Ok(())
        })?;
        Ok(iris)
    }
}
