//! Grasp detection.

mod gr_conv_net;

pub use gr_conv_net::{GrConvNet, GrConvNetInputs, GrConvNetParams};
