//! CPU kernels for small networks: matrix products, layers with gradients, optimisers, FFT.
//!
//! Contents:
//! * [`Compute`]: an instruction set, chosen at run time, and a thread pool; every kernel runs on one. Begin here.
//! * [`Product`]: single-precision matrix products with bias and activation, over [`Matrix`] and [`MatrixMut`].
//! * [`Network`], with [`Dense`], [`Conv2d`] and [`LayerNorm`], [`Gru`], and [`MultiHeadAttention`], [`Embedding`] and
//!   [`Gelu`] of transformers: layers with explicit gradients on flat parameters.
//! * [`ByteConvolution`], [`ByteDepthwise`]: layers of quantised networks, with exact sums of products of bytes.
//! * [`Limits`]: arithmetic and bandwidth of the machine, measured; [`LayerCost`]: those of a layer.
//! * [`Adam`], [`Momentum`], [`clip_gradient_norm`]: optimisers. [`RealFourier`]: the Fourier transform for audio.
//!
//! The number of threads never changes a result; the instruction set changes the last bits.
//!
//! The policies of `opendr-rl` train on these kernels. Larger networks train in `opendr-training` (Burn) and run in
//! `opendr-inference` (ONNX).
//!
//! ```
//! use opendr_kernels::{Compute, Matrix, MatrixMut, Product};
//!
//! let compute = Compute::single();
//! let (a, b) = ([1.0, 2.0, 3.0, 4.0], [1.0, 1.0]);
//! let mut c = [0.0; 2];
//! Product::new().run(&compute, Matrix::new(&a, 2, 2), Matrix::new(&b, 2, 1), MatrixMut::new(&mut c, 2, 1));
//! assert_eq!(c, [3.0, 7.0]);
//! ```
//!
//! Shapes that do not match are programming errors and panic; sizes that a user chooses are checked when a layer is
//! created and return an error.

mod activation;
mod aligned;
mod arena;
mod batch_norm;
mod binary;
mod column_sums;
mod compute;
mod conv;
mod cost;
mod elementary;
mod fourier;
mod gaussian;
mod initialise;
mod isa;
mod lanes;
mod layer;
mod limits;
mod matrix;
mod network;
mod optimizer;
mod pool;
mod pooling;
mod product;
mod quantized;
#[cfg(test)]
mod reference;
mod softmax;
mod unary;
mod unary_gradient;

pub use activation::Activation;
pub use arena::{ALIGNMENT, Arena, Number, Region, Rest, Written};
pub use batch_norm::{BatchNormalization, BatchStatistics};
pub use binary::{Binary, Operand};
pub use column_sums::add_column_sums;
pub use compute::Compute;
pub use conv::{
    Convolution, DepthwiseConvolution, DepthwiseFilters, DepthwisePointwise, Filters, Finish, Phase, Strides,
    TrainingConvolution, Window, Winograd, WinogradFilters, phases, window_of_phase,
};
pub use cost::LayerCost;
pub use elementary::{exp_in_place, sigmoid_in_place, tanh_in_place};
pub use fourier::{FOURIER_FRAMES, FourierScratch, RealFourier, Spectrum};
pub use gaussian::{gaussian_backward, gaussian_entropy, gaussian_log_density};
pub use initialise::Initialisation;
pub use isa::Isa;
pub use layer::{
    AttentionTape, Conv2d, Dense, Embedding, Gelu, Gru, GruTape, LayerNorm, MultiHeadAttention, Sequences,
};
pub use limits::Limits;
pub use matrix::{Matrix, MatrixMut};
pub use network::{Layer, Network, Tape};
pub use optimizer::{
    Adam, AdamOptions, Momentum, WeightDecay, clip_gradient_norm, gradient_norm, polyak_update,
};
pub use pool::WorkerPool;
pub use pooling::Pooling;
pub use product::{Bias, Product};
pub use quantized::{
    ByteConvolution, ByteDepthwise, ByteDepthwiseFilters, ByteFilters, ByteOutput, ByteResize, ByteSum,
    ByteWeights, ByteZero, add_byte_rows, dequantize, quantize,
};
pub use softmax::{categorical_backward, cross_entropy, entropy, log_softmax, log_softmax_backward};
pub use unary::Unary;
pub use unary_gradient::add_activated;
