//! Pictures as matrices: each column holds the numbers under the kernel at one place.

/// A picture `[channels, height, width]` and how a kernel goes over it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Patches {
    pub(super) channels: usize,
    pub(super) size: [usize; 2],
    pub(super) kernel: [usize; 2],
    pub(super) stride: [usize; 2],
    pub(super) padding: [usize; 2],
    /// Places, downwards and to the right.
    pub(super) places: [usize; 2],
}

impl Patches {
    /// Numbers of a picture.
    pub(super) fn picture(&self) -> usize {
        self.channels * self.size[0] * self.size[1]
    }

    /// Rows of the matrix: numbers under the kernel.
    pub(super) fn rows(&self) -> usize {
        self.channels * self.kernel[0] * self.kernel[1]
    }

    /// Columns of the matrix: places of the kernel.
    pub(super) fn columns(&self) -> usize {
        self.places[0] * self.places[1]
    }

    /// Fills the matrix from the picture; zeros where the kernel stands out.
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
                // Not below zero, by the choice of `first`.
                let start = (first * self.stride[1] + offset[1]).saturating_sub(self.padding[1]);
                let spots = from.get(start..).unwrap_or_default().iter().step_by(self.stride[1]);
                for (to, &value) in line[first..end].iter_mut().zip(spots) {
                    *to = value;
                }
            }
        }
    }

    /// Adds the matrix to the picture: the transpose of [`Patches::gather`].
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

    /// The channel, and the place under the kernel, that a row of the matrix stands for.
    fn under_kernel(&self, row: usize) -> (usize, [usize; 2]) {
        let area = self.kernel[0] * self.kernel[1];
        (row / area, [row % area / self.kernel[1], row % self.kernel[1]])
    }

    /// Where in the picture the kernel's `offset` lies at a place, unless beside it.
    fn position(&self, axis: usize, place: usize, offset: usize) -> Option<usize> {
        let position = (place * self.stride[axis] + offset).checked_sub(self.padding[axis])?;
        (position < self.size[axis]).then_some(position)
    }

    /// The places, from the first to the one after the last, at which the kernel's `offset` lies in the picture.
    fn inside(&self, axis: usize, offset: usize) -> (usize, usize) {
        let (stride, padding) = (self.stride[axis], self.padding[axis]);
        let first = padding.saturating_sub(offset).div_ceil(stride).min(self.places[axis]);
        let end = (self.size[axis] + padding).saturating_sub(offset).div_ceil(stride);
        (first, end.clamp(first, self.places[axis]))
    }
}
