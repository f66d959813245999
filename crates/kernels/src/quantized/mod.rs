//! Convolutions and products of bytes: the layers of quantised networks, forward only.
//!
//! Sums are 32-bit integers and exact, and become bytes with one rounding, so that all instruction sets give the same
//! bits. Tensors have channels last.

mod conv;
#[expect(
    clippy::needless_range_loop,
    reason = "functions of iterators are not always inlined where more instructions are enabled"
)]
mod depthwise;
mod dots;
mod elementwise;
mod filters;
mod instructions;
mod output;
mod resize;
#[cfg(test)]
mod tests;
#[expect(
    clippy::needless_range_loop,
    reason = "functions of iterators are not always inlined where more instructions are enabled"
)]
mod tile;

pub use conv::ByteConvolution;
pub use depthwise::{ByteDepthwise, ByteDepthwiseFilters};
pub use elementwise::{ByteSum, add_byte_rows, dequantize, quantize};
pub use filters::{ByteFilters, ByteWeights};
pub use output::{ByteOutput, ByteZero};
pub use resize::ByteResize;
