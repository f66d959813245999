//! Grey image pyramids.

/// Number of levels, each half the size of the one before.
pub(super) const LEVELS: usize = 4;

/// One level of the pyramid, row by row.
#[derive(Debug, Default)]
pub(super) struct Plane {
    pub size: [usize; 2],
    pub levels: Vec<f32>,
}

impl Plane {
    /// Halves an image `source`: each pixel is the mean of four. An odd last row or column is dropped.
    fn halve(&mut self, source: &[f32], [width, height]: [usize; 2]) {
        self.size = [width / 2, height / 2];
        self.levels.clear();
        for rows in source.chunks_exact(2 * width.max(1)).take(height / 2) {
            let (upper, lower) = rows.split_at(width);
            let pairs = upper.chunks_exact(2).zip(lower.chunks_exact(2));
            self.levels.extend(pairs.map(|(a, b)| (a[0] + a[1] + b[0] + b[1]) * 0.25));
        }
    }

    /// Returns the interpolated level at a position; pixel centres are whole numbers. `None` outside.
    pub fn at(&self, x: f32, y: f32) -> Option<f32> {
        let [width, height] = self.size;
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let (left, top) = (x as usize, y as usize);
        if left + 1 >= width || top + 1 >= height {
            return None;
        }
        let (across, down) = (x - left as f32, y - top as f32);
        let row = |top: usize| {
            let pair = self.levels.get(top * width + left..)?.get(..2)?;
            Some(pair[0] + across * (pair[1] - pair[0]))
        };
        let (upper, lower) = (row(top)?, row(top + 1)?);
        Some(upper + down * (lower - upper))
    }
}

/// An image at [`LEVELS`] sizes, the largest first, which is half of the source. Halving reduces the aliasing of a scaling
/// without antialiasing.
#[derive(Debug, Default)]
pub(super) struct Pyramid {
    pub planes: [Plane; LEVELS],
}

impl Pyramid {
    pub fn fill(&mut self, grey: &[f32], size: [usize; 2]) {
        let mut rest = &mut self.planes[..];
        let mut source = (grey, size);
        while let Some((plane, smaller)) = rest.split_first_mut() {
            plane.halve(source.0, source.1);
            source = (&plane.levels, plane.size);
            rest = smaller;
        }
    }

    /// Returns width and height of the largest level.
    pub fn size(&self) -> [usize; 2] {
        self.planes[0].size
    }
}
