//! Patches of an image as a matrix (im2col): each column contains the values under the kernel at one position.

/// An image `[channels, height, width]` and the geometry of a kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Patches {
    pub(super) channels: usize,
    pub(super) size: [usize; 2],
    pub(super) kernel: [usize; 2],
    pub(super) stride: [usize; 2],
    pub(super) padding: [usize; 2],
    /// Number of kernel positions, vertical and horizontal.
    pub(super) places: [usize; 2],
}

impl Patches {
    /// Returns the number of values of an image.
    pub(super) fn picture(&self) -> usize {
        self.channels * self.size[0] * self.size[1]
    }

    /// Returns the rows of the matrix: the values under the kernel.
    pub(super) fn rows(&self) -> usize {
        self.channels * self.kernel[0] * self.kernel[1]
    }

    /// Returns the columns of the matrix: the kernel positions.
    pub(super) fn columns(&self) -> usize {
        self.places[0] * self.places[1]
    }

    /// Fills the matrix from the image; zeros in the padding.
    pub(super) fn gather(&self, picture: &[f32], matrix: &mut [f32]) {
        let [height, width] = self.size;
        for (row, line) in matrix.chunks_exact_mut(self.columns()).enumerate() {
            let (channel, offset) = self.under_kernel(row);
            let plane = &picture[channel * height * width..][..height * width];
            let (first, end) = self.inside(1, offset[1]);
            for (i, line) in line.chunks_exact_mut(self.places[1]).enumerate() {
                line.fill(0.0);
                let Some(y) = self.position(0, i, offset[0]) else { continue };
                let from = &plane[y * width..][..width];
                // Not negative, by the choice of `first`.
                let start = (first * self.stride[1] + offset[1]).saturating_sub(self.padding[1]);
                let spots = from.get(start..).unwrap_or_default().iter().step_by(self.stride[1]);
                for (to, &value) in line[first..end].iter_mut().zip(spots) {
                    *to = value;
                }
            }
        }
    }

    /// Adds the matrix to the image (col2im): the transpose of [`Patches::gather`].
    pub(super) fn scatter(&self, matrix: &[f32], picture: &mut [f32]) {
        let [height, width] = self.size;
        for (row, line) in matrix.chunks_exact(self.columns()).enumerate() {
            let (channel, offset) = self.under_kernel(row);
            let plane = &mut picture[channel * height * width..][..height * width];
            let (first, end) = self.inside(1, offset[1]);
            for (i, line) in line.chunks_exact(self.places[1]).enumerate() {
                let Some(y) = self.position(0, i, offset[0]) else { continue };
                let to = &mut plane[y * width..][..width];
                let start = (first * self.stride[1] + offset[1]).saturating_sub(self.padding[1]);
                let spots = to.get_mut(start..).unwrap_or_default().iter_mut().step_by(self.stride[1]);
                for (to, &value) in spots.zip(&line[first..end]) {
                    *to += value;
                }
            }
        }
    }

    /// Returns the channel and the offset in the kernel of a row of the matrix.
    fn under_kernel(&self, row: usize) -> (usize, [usize; 2]) {
        let area = self.kernel[0] * self.kernel[1];
        (row / area, [row % area / self.kernel[1], row % self.kernel[1]])
    }

    /// Returns the image coordinate of the kernel's `offset` at a position; `None` in the padding.
    fn position(&self, axis: usize, place: usize, offset: usize) -> Option<usize> {
        let position = (place * self.stride[axis] + offset).checked_sub(self.padding[axis])?;
        (position < self.size[axis]).then_some(position)
    }

    /// Returns the range of positions at which the kernel's `offset` lies in the image.
    fn inside(&self, axis: usize, offset: usize) -> (usize, usize) {
        let (stride, padding) = (self.stride[axis], self.padding[axis]);
        let first = padding.saturating_sub(offset).div_ceil(stride).min(self.places[axis]);
        let end = (self.size[axis] + padding).saturating_sub(offset).div_ceil(stride);
        (first, end.clamp(first, self.places[axis]))
    }
}
