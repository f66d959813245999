//! Matrix products and small network layers for policies: packed single-precision products with run-time dispatch, layers with
//! explicit gradients on flat parameters, optimisers; and the Fourier transform for sound.
//!
//! Everything runs on a [`Compute`]: an instruction set, chosen once, and a pool of threads. The number of threads
//! never changes a result, not by a bit; the instruction set does, in the last places.
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
//! Shapes that do not fit are mistakes of the program, and panic as an index out of range would; sizes that a user may
//! choose are checked where a layer is made, and give an error.

mod activation;
mod aligned;
mod column_sums;
mod compute;
mod elementary;
mod fourier;
mod gaussian;
mod initialise;
mod isa;
mod lanes;
mod layer;
mod matrix;
mod network;
mod optimizer;
mod pool;
mod product;
mod softmax;

pub use activation::Activation;
pub use column_sums::add_column_sums;
pub use compute::Compute;
pub use elementary::{exp_in_place, sigmoid_in_place, tanh_in_place};
pub use fourier::{FOURIER_FRAMES, FourierWork, RealFourier, Spectrum};
pub use gaussian::{gaussian_backward, gaussian_entropy, gaussian_log_density};
pub use initialise::Initialisation;
pub use isa::Isa;
pub use layer::{Conv2d, Dense, Gru, GruTape, LayerNorm};
pub use matrix::{Matrix, MatrixMut};
pub use network::{Layer, Network, Tape};
pub use optimizer::{
    Adam, AdamOptions, Momentum, WeightDecay, clip_gradient_norm, gradient_norm, move_towards,
};
pub use pool::WorkerPool;
pub use product::{Bias, Product};
pub use softmax::{categorical_backward, cross_entropy, entropy, log_softmax, log_softmax_backward};
