//! The learner.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{Keypoint, Pose, PoseList, Skeleton};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_kernels::Compute;

use super::container;
use super::network::{GraspNetwork, SeenJaw, Work};
use super::params::SingleDemoGraspParams;

/// Grasps of one object, learned from a single demonstration: a pose of two key points, the jaws.
pub struct SingleDemoGrasp {
    params: SingleDemoGraspParams,
    network: GraspNetwork,
    work: Pool<Work>,
}

impl SingleDemoGrasp {
    /// Creates a learner with a trained network.
    pub fn new(network: GraspNetwork, params: SingleDemoGraspParams) -> Self {
        Self { params, network, work: Pool::default() }
    }
}

impl Learner for SingleDemoGrasp {
    const SPEC: Spec = Spec::new("single_demo_grasp", Task::GraspDetection)
        .class("SingleDemoGraspLearner")
        .about("Learns to grasp an object from one image with the places of the jaws, and predicts them in other images.");
    type Params = SingleDemoGraspParams;
    type Input<'a> = &'a Image;
    type Target = PoseList;
    type State = ();

    fn load(model: &Model, params: SingleDemoGraspParams, device: Device) -> Result<Self> {
        if !matches!(device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "{} runs on the CPU, not on {device}; set the device to \"cpu\" or \"auto\"",
                Self::SPEC.class
            )));
        }
        Ok(Self::new(container::read(model)?, params))
    }

    fn params(&self) -> &SingleDemoGraspParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut SingleDemoGraspParams {
        &mut self.params
    }

    fn infer_into(&self, _: &mut (), image: &Image, grasps: &mut PoseList) -> Result<()> {
        let jaws = self.network.see(&Compute::single(), image, &mut self.work.take())?;
        let confidence = jaws.iter().map(|jaw| jaw.confidence).fold(1.0, f32::min);
        let seen = confidence >= self.params.threshold;
        grasps.poses.resize_with(usize::from(seen), Pose::default);
        for grasp in &mut grasps.poses {
            (grasp.skeleton, grasp.confidence) = (Skeleton::Grasp2, confidence);
            grasp.keypoints.clear();
            let keypoint = |SeenJaw { place: [x, y], confidence }: SeenJaw| Keypoint { x, y, confidence };
            grasp.keypoints.extend(jaws.map(keypoint));
        }
        Ok(())
    }
}
