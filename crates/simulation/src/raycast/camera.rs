//! A pinhole camera.

use opendr_engine::{Error, Result};

use super::{LANES, Pose, Vector, dot, length, minus};

/// A camera with square pixels and the optical axis through the image centre.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    width: usize,
    height: usize,
    /// Half of a pixel's side, at one metre ahead.
    scale: f32,
    /// Slope to the left of each column, padded to whole packets.
    pub(super) columns: Vec<[f32; LANES]>,
    /// Slope upwards of each row.
    pub(super) rows: Vec<f32>,
}

/// Depth and body of each pixel.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DepthBuffer {
    pub(super) width: usize,
    pub(super) packets: Vec<[f32; LANES]>,
    pub(super) bodies: Vec<[u32; LANES]>,
}

/// Pixels that may show a body: rows, and packets of columns.
pub(super) struct Patch {
    pub rows: std::ops::Range<usize>,
    pub packets: std::ops::Range<usize>,
}

impl Camera {
    /// Creates a camera; `half_width` is the tangent of half its horizontal field of view.
    ///
    /// # Errors
    /// `InvalidParam` for no pixels or more than 2^24, and for a half width outside 1e-3..=1e3.
    pub fn new(width: usize, height: usize, half_width: f32) -> Result<Self> {
        let fits = width.checked_mul(height).is_some_and(|pixels| (1..=1 << 24).contains(&pixels));
        if !fits || !(1e-3..=1e3).contains(&half_width) {
            return Err(Error::invalid_param(format!(
                "the camera has {width} x {height} pixels and a half width of {half_width}; give 1 to 2^24 pixels and 0.001 to 1000"
            )));
        }
        let scale = half_width / width as f32;
        let columns = (0..width.div_ceil(LANES)).map(|packet| {
            std::array::from_fn(|lane| {
                let column = (packet * LANES + lane).min(width - 1);
                scale * (width as f32 - 1.0 - 2.0 * column as f32)
            })
        });
        let rows = (0..height).map(|row| scale * (height as f32 - 1.0 - 2.0 * row as f32));
        Ok(Self { width, height, scale, columns: columns.collect(), rows: rows.collect() })
    }

    /// Returns the width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns the direction of a pixel's centre: ahead, left and up, at one metre ahead.
    pub fn direction(&self, column: usize, row: usize) -> Vector {
        let left = self.columns.get(column / LANES).map_or(0.0, |packet| packet[column % LANES]);
        [1.0, left, self.rows.get(row).copied().unwrap_or(0.0)]
    }

    /// Projects a world point to pixel coordinates from the upper left corner; `None` for a point that is not ahead of
    /// the camera.
    pub fn project(&self, pose: &Pose, point: Vector) -> Option<[f32; 2]> {
        let aside = minus(point, pose.position);
        let [ahead, left, up] = pose.axes.map(|axis| dot(axis, aside));
        let place = |pixels: usize, aside: f32| pixels as f32 / 2.0 - aside / (ahead * self.scale * 2.0);
        (ahead > 0.0).then(|| [place(self.width, left), place(self.height, up)])
    }

    /// Returns the pixels that a ball may cover.
    pub(super) fn patch(&self, pose: &Pose, centre: Vector, radius: f32, range: f32) -> Option<Patch> {
        let aside = minus(centre, pose.position);
        let [ahead, left, up] = pose.axes.map(|axis| dot(axis, aside));
        let all = Patch { rows: 0..self.height, packets: 0..self.columns.len() };
        if radius.is_infinite() {
            return Some(all);
        }
        // Slightly enlarged, against rounding.
        let radius = radius * 1.0001 + 1e-4;
        if ahead < -radius || ahead - radius > range {
            return None;
        }
        let slope = |middle: f32| slopes(ahead, middle, radius, length([ahead, middle, 0.0]));
        let (rows, columns) = (slope(up), slope(left));
        let pick = |slopes: Option<(f32, f32)>, count: usize, at: &dyn Fn(usize) -> (f32, f32)| {
            let Some((low, high)) = slopes else { return 0..count };
            let is_seen = |index: &usize| {
                let (first, last) = at(*index);
                last <= high && first >= low
            };
            let begin = (0..count).find(is_seen).unwrap_or(count);
            begin..(begin..count).rfind(is_seen).map_or(begin, |last| last + 1)
        };
        let rows = pick(rows, self.height, &|row| (self.rows[row], self.rows[row]));
        let packets = pick(columns, self.columns.len(), &|packet| {
            (self.columns[packet][0], self.columns[packet][LANES - 1])
        });
        (!rows.is_empty() && !packets.is_empty()).then_some(Patch { rows, packets })
    }
}

/// Returns the slopes of the tangents from the origin to a circle; `None` if one points backwards.
fn slopes(ahead: f32, aside: f32, radius: f32, distance: f32) -> Option<(f32, f32)> {
    if ahead <= radius {
        return None;
    }
    let (product, below) = (ahead * aside, ahead * ahead - radius * radius);
    let half = radius * (distance * distance - radius * radius).max(0.0).sqrt();
    Some(((product - half) / below, (product + half) / below))
}

impl DepthBuffer {
    /// Returns the depth of the pixels in metres, row by row.
    pub fn depths(&self) -> impl Iterator<Item = f32> + '_ {
        self.in_rows(&self.packets)
    }

    /// Returns the index of the body in each pixel, row by row; `None` if nothing is in range.
    pub fn bodies(&self) -> impl Iterator<Item = Option<usize>> + '_ {
        self.in_rows(&self.bodies).map(|number| (number != u32::MAX).then_some(number as usize))
    }

    fn in_rows<'a, T: Copy>(&self, packets: &'a [[T; LANES]]) -> impl Iterator<Item = T> + use<'a, T> {
        let width = self.width;
        let rows = packets.chunks(width.div_ceil(LANES).max(1));
        rows.flat_map(move |row| row.as_flattened().iter().take(width).copied())
    }
}
