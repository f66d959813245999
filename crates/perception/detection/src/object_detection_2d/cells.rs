//! Outputs of the levels of a pyramid as rows of cells.

use burn::tensor::Tensor;

/// Returns one row per cell of a level, row by row: `[images, cells, channels]` of `[images, channels, height, width]`.
pub fn cells(level: Tensor<4>) -> Tensor<3> {
    let [images, channels, height, width] = level.dims();
    level.reshape([images, channels, height * width]).swap_dims(1, 2)
}
