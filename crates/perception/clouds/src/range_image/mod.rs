//! Range images: the scan of a spinning lidar as an image with a row per ring.
//!
//! A. Milioto, I. Vizzo, J. Behley, C. Stachniss, "RangeNet++: Fast and accurate LiDAR semantic segmentation", IROS 2019:
//! points are sorted into pixels by their angles; a pixel shows its nearest point. Points behind it take the pixel of a
//! neighbour at the same range. Buffers are reused for the next scan.

mod view;

pub use view::RangeView;

/// Value of a missing pixel or point.
pub const NONE: u32 = u32::MAX;
/// Radius in pixels in which a hidden point looks up a neighbour.
const REACH: usize = 2;
/// Maximum difference of ranges in metres between a point and its pixel.
const SAME: f32 = 1.0;

/// Projection of the points of a scan to pixels.
#[derive(Debug, Clone, Default)]
pub struct RangeImage {
    size: [usize; 2],
    /// Point of each pixel, and its range.
    points: Vec<u32>,
    ranges: Vec<f32>,
    /// Pixel of each point, and its distance.
    pixels: Vec<u32>,
    distances: Vec<f32>,
}

impl RangeImage {
    /// Projects a scan: x, y, z of each point in metres, in the lidar's frame (x ahead, y left, z up). Points that are not
    /// finite or outside of the view have no pixel.
    pub fn project(&mut self, view: &RangeView, points: impl Iterator<Item = [f32; 3]>) {
        self.size = [view.columns, view.rows];
        self.points.clear();
        self.points.resize(view.columns * view.rows, NONE);
        self.ranges.clear();
        self.ranges.resize(view.columns * view.rows, 0.0);
        self.pixels.clear();
        self.distances.clear();
        for (point, place @ [x, y, z]) in (0..NONE).zip(points) {
            let distance = (x * x + y * y + z * z).sqrt();
            let pixel = view.pixel(place, distance);
            self.pixels.push(pixel.map_or(NONE, |pixel| pixel as u32));
            self.distances.push(distance);
            let Some(pixel) = pixel else { continue };
            if self.points[pixel] == NONE || distance < self.ranges[pixel] {
                (self.points[pixel], self.ranges[pixel]) = (point, distance);
            }
        }
    }

    /// Returns the point of each pixel, row-major from the upper left; [`NONE`] where there is none.
    pub fn points(&self) -> &[u32] {
        &self.points
    }

    /// Returns the range of each pixel in metres; 0 where there is no point.
    pub fn ranges(&self) -> &[f32] {
        &self.ranges
    }

    /// Returns the pixel of each point; [`NONE`] outside of the view.
    pub fn pixels(&self) -> &[u32] {
        &self.pixels
    }

    /// Returns the pixel whose prediction applies to a point: its own, or, where that shows a nearer point, the neighbour at
    /// the same range. `None` outside of the view.
    pub fn pixel_for(&self, point: usize) -> Option<usize> {
        let (own, distance) = (*self.pixels.get(point)?, *self.distances.get(point)?);
        let own = Some(own as usize).filter(|_| own != NONE)?;
        let off = |pixel: usize| (self.ranges[pixel] - distance).abs();
        if off(own) <= SAME {
            return Some(own);
        }
        let [columns, rows] = self.size;
        let (column, row) = (own % columns, own / columns);
        let around = (row.saturating_sub(REACH)..(row + REACH + 1).min(rows)).flat_map(|row| {
            (column.saturating_sub(REACH)..(column + REACH + 1).min(columns))
                .map(move |at| row * columns + at)
        });
        let best = around.min_by(|one, other| off(*one).total_cmp(&off(*other)))?;
        Some(if off(best) <= SAME { best } else { own })
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::FRAC_PI_2;

    use super::*;

    const VIEW: RangeView = RangeView { rows: 4, columns: 8, top: 0.2, bottom: -0.2, half_view: FRAC_PI_2 };

    #[test]
    fn pixels_show_the_nearest_point_and_hidden_points_take_a_neighbour() {
        let points = [
            [10.0, 0.1, 0.1],
            // Behind the first, and beside one at the same range.
            [20.0, 0.2, 0.2],
            [20.0, 9.0, 0.2],
            [f32::NAN, 0.0, 0.0],
            [-5.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
        ];
        let mut image = RangeImage::default();
        for _ in 0..2 {
            image.project(&VIEW, points.into_iter());
            let pixels = image.pixels();
            assert_eq!((pixels[0], pixels[1], pixels[2]), (11, 11, 10));
            assert_eq!(pixels[3..], [NONE; 3]);
            assert_eq!((image.points()[11], image.points()[10]), (0, 2));
            assert!((image.ranges()[11] - 10.001).abs() < 1e-3 && image.ranges()[0] == 0.0);
            let speakers: Vec<_> = (0..7).map(|point| image.pixel_for(point)).collect();
            assert_eq!(speakers[..2], [Some(11), Some(11)]);
            assert_eq!(speakers[2..], [Some(10), None, None, None, None]);
        }
        // At the range of its neighbour to within a metre.
        image.project(&VIEW, [[10.0, 0.1, 0.1], [20.9, 0.2, 0.2], [19.0, 9.0, 0.2]].into_iter());
        assert_eq!(image.pixel_for(1), Some(10));
        image.project(&VIEW, std::iter::empty());
        assert!(image.pixels().is_empty() && image.points().iter().all(|point| *point == NONE));
    }
}
