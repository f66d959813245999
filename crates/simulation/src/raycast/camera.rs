//! A pinhole camera.

use opendr_engine::{Error, Result};

use super::paint::paint;
use super::{LANES, Pose, Scene, Vector, dot, length, minus};

/// A camera with square pixels, the optical axis through the middle of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    width: usize,
    height: usize,
    /// Half of a pixel's side, one metre ahead.
    scale: f32,
    /// How far to the left each column looks, over how far ahead; filled up to whole packets.
    pub(super) columns: Vec<[f32; LANES]>,
    /// How far up each row looks, over how far ahead.
    pub(super) rows: Vec<f32>,
}

/// How far ahead each pixel sees, and what.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DepthBuffer {
    width: usize,
    pub(super) packets: Vec<[f32; LANES]>,
    pub(super) bodies: Vec<[u32; LANES]>,
}

/// Pixels that a body may cover: rows, and packets of columns.
pub(super) struct Patch {
    pub rows: std::ops::Range<usize>,
    pub packets: std::ops::Range<usize>,
}

impl Camera {
    /// A camera that sees `half_width` metres to either side, one metre ahead: the tangent of half its angle of view.
    ///
    /// # Errors
    /// `InvalidParam` for no pixel or more than 2^24, and for a half width that is not in 1e-3..=1e3.
    pub fn new(width: usize, height: usize, half_width: f32) -> Result<Self> {
        let fits = width.checked_mul(height).is_some_and(|pixels| (1..=1 << 24).contains(&pixels));
        if !fits || !(1e-3..=1e3).contains(&half_width) {
            return Err(Error::invalid_param(format!(
                "a camera of {width} x {height} pixels with a half width of {half_width}; give 1 to 2^24 pixels and 0.001 to 1000"
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

    /// Pixels a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The direction of a pixel's middle, ahead, left and up; one metre ahead.
    pub fn direction(&self, column: usize, row: usize) -> Vector {
        let left = self.columns.get(column / LANES).map_or(0.0, |packet| packet[column % LANES]);
        [1.0, left, self.rows.get(row).copied().unwrap_or(0.0)]
    }

    /// Where a point of the world is in the picture, pixels from its upper left corner; `None` for a point that is not
    /// ahead.
    pub fn project(&self, pose: &Pose, point: Vector) -> Option<[f32; 2]> {
        let aside = minus(point, pose.position);
        let [ahead, left, up] = pose.axes.map(|axis| dot(axis, aside));
        let place = |pixels: usize, aside: f32| pixels as f32 / 2.0 - aside / (ahead * self.scale * 2.0);
        (ahead > 0.0).then(|| [place(self.width, left), place(self.height, up)])
    }

    /// Looks at a scene, at most `range` metres ahead (along the optical axis, as depth cameras measure).
    ///
    /// Bodies are painted one after the other into the pixels that they may cover; the nearest stays.
    pub fn look(&self, scene: &Scene, pose: &Pose, range: f32, seen: &mut DepthBuffer) {
        let packets = self.columns.len() * self.height;
        seen.width = self.width;
        seen.packets.clear();
        seen.packets.resize(packets, [range; LANES]);
        seen.bodies.clear();
        seen.bodies.resize(packets, [u32::MAX; LANES]);
        for (body, number) in scene.bodies().iter().zip(0..) {
            if let Some(patch) = self.patch(pose, body.position(), body.shape().reach(), range) {
                paint(self, pose, body, number, patch, seen);
            }
        }
    }

    /// The pixels that a ball may cover.
    fn patch(&self, pose: &Pose, centre: Vector, radius: f32, range: f32) -> Option<Patch> {
        let aside = minus(centre, pose.position);
        let [ahead, left, up] = pose.axes.map(|axis| dot(axis, aside));
        let all = Patch { rows: 0..self.height, packets: 0..self.columns.len() };
        if radius.is_infinite() {
            return Some(all);
        }
        // A hair larger than it is, for what is rounded.
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

/// Smallest and largest slope of the tangents from the origin to a circle; `None` where one of them points backwards.
fn slopes(ahead: f32, aside: f32, radius: f32, distance: f32) -> Option<(f32, f32)> {
    if ahead <= radius {
        return None;
    }
    let (product, below) = (ahead * aside, ahead * ahead - radius * radius);
    let half = radius * (distance * distance - radius * radius).max(0.0).sqrt();
    Some(((product - half) / below, (product + half) / below))
}

impl DepthBuffer {
    /// How far ahead the pixels see, row after row.
    pub fn depths(&self) -> impl Iterator<Item = f32> + '_ {
        self.in_rows(&self.packets)
    }

    /// The numbers of the bodies that the pixels see, row after row; `None` for nothing within the range.
    pub fn bodies(&self) -> impl Iterator<Item = Option<usize>> + '_ {
        self.in_rows(&self.bodies).map(|number| (number != u32::MAX).then_some(number as usize))
    }

    fn in_rows<'a, T: Copy>(&self, packets: &'a [[T; LANES]]) -> impl Iterator<Item = T> + use<'a, T> {
        let width = self.width;
        let rows = packets.chunks(width.div_ceil(LANES).max(1));
        rows.flat_map(move |row| row.as_flattened().iter().take(width).copied())
    }
}
