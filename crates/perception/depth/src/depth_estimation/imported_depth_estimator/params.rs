//! Parameters of [`super::ImportedDepthEstimator`].

use opendr_engine::params::Params;
use opendr_perception_common::exported_network::InputParams;

opendr_engine::choices! {
    /// Quantity in the output of a depth estimator.
    pub enum DepthKind {
        /// Recognised from the network.
        Auto = "auto",
        /// Inverse depth up to an unknown scale and shift; near is large (MiDaS, Depth Anything).
        InverseRelative = "inverse_relative",
        /// Depth up to an unknown scale and shift; far is large.
        Relative = "relative",
        /// Distance from the plane of the camera in metres.
        Metric = "metric",
    }
}

opendr_engine::choices! {
    /// How a map is interpolated to the size of the image.
    pub enum MapInterpolation {
        /// As the package that the network is from does; bicubic for others.
        Auto = "auto",
        /// Bicubic, with aligned edges of images (PyTorch's `bicubic` with `align_corners=False`).
        Bicubic = "bicubic",
        /// Bilinear, with aligned centres of the corner pixels (PyTorch's `bilinear` with `align_corners=True`).
        BilinearCorners = "bilinear_corners",
    }
}

/// Parameters of [`super::ImportedDepthEstimator`].
#[derive(Debug, Clone, Params)]
pub struct ImportedDepthEstimatorParams {
    /// Whether the map has the size of the image, to which it is interpolated; else it has that of the network's output.
    #[param(default = true, live)]
    pub full_size: bool,
    /// Quantity in the output.
    pub kind: DepthKind,
    /// Metres per unit of the output of a metric network: 0.001 for millimetres, the largest depth for fractions of it, the focal
    /// length of the network's input divided by 1000 pixels for Metric3D.
    #[param(default = 1.0, range = 1e-6..=1e6, unit = "m")]
    pub scale: f32,
    /// How the map is interpolated to the size of the image.
    pub interpolation: MapInterpolation,
    /// Whether an input of dynamic size has the aspect ratio of the image, scaled as little as possible until one side is `size`; else
    /// it is a square.
    #[param(default = true)]
    pub keep_aspect: bool,
    /// Number of which the sides of an input of dynamic size are multiples; recognised from the network if absent.
    #[param(range = 1..=256, unit = "px")]
    pub multiple: Option<usize>,
    /// Name of the output; recognised from the network if absent.
    pub depth_output: Option<String>,
    /// The network's input.
    #[param(flatten)]
    pub input: InputParams,
}
