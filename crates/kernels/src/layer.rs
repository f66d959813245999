//! Layers: what stands between numbers in and numbers out, with the gradients written out.
//!
//! A layer knows shapes; its parameters are a slice of the caller's. Batches are rows. Gradients of parameters are
//! added to what is there, so that a caller who wants those of one batch starts from zeros.

mod conv2d;
mod dense;
mod gru;
mod layer_norm;
mod patches;
#[cfg(test)]
mod tests;

pub use conv2d::Conv2d;
pub use dense::Dense;
pub use gru::{Gru, GruTape};
pub use layer_norm::LayerNorm;

use opendr_engine::{Error, Result};

/// No layer has more numbers in a sample, or parameters, than this.
const LARGEST: usize = 1 << 28;

/// The product of sizes that a user may have chosen: each at least one, all together at most 2^28.
fn checked_size(what: &str, sizes: &[usize]) -> Result<usize> {
    let product = sizes.iter().try_fold(1usize, |product, &size| product.checked_mul(size));
    product.filter(|&product| (1..=LARGEST).contains(&product)).ok_or_else(|| {
        Error::invalid_param(format!(
            "{what} of sizes {sizes:?}: each must be at least 1 and their product at most {LARGEST}"
        ))
    })
}
