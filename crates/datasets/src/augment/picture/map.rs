//! Affine maps of images.

/// Affine map from an image to one of another size; pixels outside of the output are dropped.
///
/// Positions are continuous: the left-top corner of the first pixel is (0, 0), its centre (0.5, 0.5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AffineMap {
    matrix: [[f64; 3]; 2],
    input_size: [usize; 2],
    output_size: [usize; 2],
}

impl AffineMap {
    /// Creates the map by `matrix` (x' = m00 x + m01 y + m02, y' = m10 x + m11 y + m12) from an image of
    /// `input_size` (width and height) to one of `output_size`.
    pub fn new(matrix: [[f64; 3]; 2], input_size: [usize; 2], output_size: [usize; 2]) -> Self {
        Self { matrix, input_size, output_size }
    }

    /// Returns the map that swaps left and right.
    pub fn flip_horizontal(size: [usize; 2]) -> Self {
        Self::new([[-1.0, 0.0, size[0] as f64], [0.0, 1.0, 0.0]], size, size)
    }

    /// Returns the map that swaps top and bottom.
    pub fn flip_vertical(size: [usize; 2]) -> Self {
        Self::new([[1.0, 0.0, 0.0], [0.0, -1.0, size[1] as f64]], size, size)
    }

    /// Returns the map to the window of `output_size` with the left-top corner `corner`, which may lie outside of
    /// the image.
    pub fn crop(input_size: [usize; 2], corner: [i64; 2], output_size: [usize; 2]) -> Self {
        let [left, top] = corner.map(|edge| edge as f64);
        Self::new([[1.0, 0.0, -left], [0.0, 1.0, -top]], input_size, output_size)
    }

    /// Returns the map from the window `[left, top, width, height]` of the image to the rectangle
    /// `[left, top, width, height]` of the output. The surroundings of the window are mapped to those of the
    /// rectangle.
    pub fn window(
        input_size: [usize; 2],
        window: [usize; 4],
        rectangle: [usize; 4],
        output_size: [usize; 2],
    ) -> Self {
        let scale = |axis: usize| rectangle[axis + 2] as f64 / window[axis + 2].max(1) as f64;
        let shift = |axis: usize| rectangle[axis] as f64 - window[axis] as f64 * scale(axis);
        Self::new([[scale(0), 0.0, shift(0)], [0.0, scale(1), shift(1)]], input_size, output_size)
    }

    /// Returns the map that resizes the whole image, without keeping its aspect ratio.
    pub fn stretch(input_size: [usize; 2], output_size: [usize; 2]) -> Self {
        let [[width, height], [columns, rows]] = [input_size, output_size];
        Self::window(input_size, [0, 0, width, height], [0, 0, columns, rows], output_size)
    }

    /// Returns the map by the linear part `[[a, b], [c, d]]` about the centre of the image, then a shift in pixels.
    pub fn about_centre(size: [usize; 2], [[a, b], [c, d]]: [[f64; 2]; 2], shift: [f64; 2]) -> Self {
        let [x, y] = size.map(|side| side as f64 / 2.0);
        let matrix = [[a, b, x - a * x - b * y + shift[0]], [c, d, y - c * x - d * y + shift[1]]];
        Self::new(matrix, size, size)
    }

    /// Returns the width and height of the input image.
    pub fn input_size(&self) -> [usize; 2] {
        self.input_size
    }

    /// Returns the width and height of the output image.
    pub fn output_size(&self) -> [usize; 2] {
        self.output_size
    }

    /// Maps a point of the image; the result may lie outside of the output.
    pub fn output_from_input(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        self.matrix.map(|[a, b, c]| a * x + b * y + c)
    }

    /// Returns the determinant: output pixels per input pixel, negative for a mirror image.
    pub fn determinant(&self) -> f64 {
        let [[a, b, _], [c, d, _]] = self.matrix;
        a * d - b * c
    }

    /// Returns whether the map mirrors, which swaps left and right hands.
    pub fn mirrors(&self) -> bool {
        self.determinant() < 0.0
    }

    /// Returns scale and shift along x and along y; `None` if the map rotates or shears.
    pub(super) fn along_axes(&self) -> Option<[[f64; 2]; 2]> {
        let [[a, b, x], [c, d, y]] = self.matrix;
        (b == 0.0 && c == 0.0 && a != 0.0 && d != 0.0).then_some([[a, x], [d, y]])
    }

    /// Returns the inverse as a matrix; `None` for a map onto a line or a point.
    pub(super) fn input_from_output(&self) -> Option<[[f64; 3]; 2]> {
        let [[a, b, x], [c, d, y]] = self.matrix;
        let determinant = self.determinant();
        (determinant.abs() > 1e-12 && determinant.is_finite()).then(|| {
            let [a, b, c, d] = [a, b, c, d].map(|part| part / determinant);
            [[d, -b, b * y - d * x], [-c, a, c * x - a * y]]
        })
    }

    /// Returns the map for another resolution of the same scene, such as a coarser label map.
    pub(super) fn for_size(&self, input_size: [usize; 2]) -> Self {
        if input_size == self.input_size {
            return *self;
        }
        let [x, y] = [0, 1].map(|axis| input_size[axis] as f64 / self.input_size[axis] as f64);
        let [[a, b, c], [d, e, f]] = self.matrix;
        let size =
            [0, 1].map(|axis| (self.output_size[axis] as f64 * [x, y][axis]).round().max(1.0) as usize);
        Self::new([[a, b * x / y, c * x], [d * y / x, e, f * y]], input_size, size)
    }
}
