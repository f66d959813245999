//! Layers with explicit gradients.
//!
//! A layer stores shapes only; its parameters are a slice of the caller's. Batches are rows. Parameter gradients are
//! added to the existing values, so that the caller starts a batch with zeros.

mod attention;
mod conv2d;
mod dense;
mod embedding;
mod gelu;
mod gru;
mod layer_norm;
mod patches;
#[cfg(test)]
mod tests;

pub use attention::{AttentionTape, MultiHeadAttention, Sequences};
pub use conv2d::Conv2d;
pub use dense::Dense;
pub use embedding::Embedding;
pub use gelu::Gelu;
pub use gru::{Gru, GruTape};
pub use layer_norm::LayerNorm;

use opendr_engine::{Error, Result};

/// Maximum number of values per sample, and of parameters, of a layer.
const LARGEST: usize = 1 << 28;

/// Returns the product of sizes from the user: each must be at least one, their product at most 2^28.
fn checked_size(what: &str, sizes: &[usize]) -> Result<usize> {
    let product = sizes.iter().try_fold(1usize, |product, &size| product.checked_mul(size));
    product.filter(|&product| (1..=LARGEST).contains(&product)).ok_or_else(|| {
        Error::invalid_param(format!(
            "{what} of sizes {sizes:?}: each must be at least 1 and their product at most {LARGEST}"
        ))
    })
}
