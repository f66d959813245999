//! Layers and backbones shared by learners.

mod activation;
mod bilinear;
mod conv_norm_act;
mod gru;
mod inverted_residual;
mod mobilenet_v1;
mod resnet18;
mod separable_conv;

pub use activation::Activation;
pub use bilinear::bilinear;
pub use conv_norm_act::{ConvNormAct, ConvNormActConfig};
pub use gru::{Gru, GruConfig};
pub use inverted_residual::{InvertedResidual, InvertedResidualConfig};
pub use mobilenet_v1::{MobileNetV1, MobileNetV1Config};
pub use resnet18::{BasicBlock, ResNet18, ResNet18Config};
pub use separable_conv::{SeparableConv, SeparableConvConfig};
