//! Matrix products and small network layers for policies: packed single-precision products with run-time dispatch, layers with
//! explicit gradients on flat parameters, optimisers.
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
mod compute;
mod elementary;
mod isa;
mod lanes;
mod matrix;
mod pool;
mod product;

pub use activation::Activation;
pub use compute::Compute;
pub use elementary::{exp_in_place, sigmoid_in_place, tanh_in_place};
pub use isa::Isa;
pub use matrix::{Matrix, MatrixMut};
pub use pool::WorkerPool;
pub use product::{Bias, Product};
