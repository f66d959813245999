//! Grasps from a single demonstration (OpenDR's `SingleDemoGraspLearner`).
//!
//! OpenDR trains a Keypoint R-CNN on augmentations of one image. Here a small convolutional network predicts, on a grid of cells, how
//! likely each jaw is in a cell and where in it (as one-stage key-point detectors do: Papandreou et al., PersonLab, 2018), and is
//! trained on the demonstrated object cut out of its image: turned, moved, scaled, lit anew, before other backgrounds, partly covered.

mod augmentation;
mod container;
mod cutout;
mod example;
mod fit;
mod learner;
mod network;
mod objective;
mod params;
mod training;

pub use example::GraspExample;
pub use learner::SingleDemoGrasp;
pub use network::GraspNetwork;
pub use params::{SingleDemoGraspFitParams, SingleDemoGraspParams};
pub use training::{GraspTraining, train_from_demonstration};
