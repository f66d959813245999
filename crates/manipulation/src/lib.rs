//! Learners of manipulation on the toolkit's own kernels.
//!
//! [`SingleDemoGrasp`] learns to grasp an object from one image and the places of the jaws in it. [`grasp_success`] measures it in the
//! physics of `PlanarGrasp-v1`.
//!
//! Not here: the worlds and their scripted teachers (`opendr-simulation`), grasps of any object (`opendr-grasping`).

mod grasp_success;
mod regrasp;
mod single_demo_grasp;

pub use grasp_success::{GraspSuccess, GraspTolerance, View, grasp_success};
pub use regrasp::held_within;
pub use single_demo_grasp::{
    GraspExample, GraspNetwork, GraspTraining, SingleDemoGrasp, SingleDemoGraspFitParams,
    SingleDemoGraspParams, train_from_demonstration,
};
