//! The canvas: the pixels of an image, with anti-aliased lines, discs and rectangles.
//!
//! Coordinates are pixels from the left-top corner; pixel `(x, y)` covers `x..x + 1`, its centre is at `x + 0.5`.
//! Shapes are clipped at the border; shapes with values that are not finite are not drawn.

use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};

use crate::draw::palette::Colour;

/// A position in an image, in pixels.
pub type Point = [f32; 2];

/// `[left, top, right, bottom]` in an image, in pixels.
pub type Corners = [f32; 4];

/// A drawing surface over the RGB pixels of an [`Image`].
#[derive(Debug)]
pub struct Canvas<'a> {
    pixels: &'a mut [u8],
    width: usize,
    height: usize,
}

impl<'a> Canvas<'a> {
    /// Creates a canvas over `image`.
    ///
    /// An RGB `u8` image that owns its pixels alone is drawn on in place; otherwise `image` is first replaced by an
    /// RGB `u8` copy.
    pub fn over(image: &'a mut Image) -> Self {
        let ready = image.format() == PixelFormat::Rgb
            && image.layout() == Layout::Hwc
            && matches!(image.pixels(), Pixels::U8(_));
        if !ready {
            let rgb = image.hwc_u8(PixelFormat::Rgb);
            if let Ok(converted) = Image::from_rgb8(rgb, image.width(), image.height()) {
                *image = converted.with_header(image.header.clone());
            }
        }
        let (width, height) = (image.width(), image.height());
        Self { pixels: image.bytes_mut().unwrap_or_default(), width, height }
    }

    /// Returns the width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Blends `colour` into a pixel; opacity 0..=1. Positions outside the image are ignored.
    #[inline]
    pub fn blend(&mut self, x: usize, y: usize, colour: Colour, opacity: f32) {
        if x < self.width && y < self.height {
            self.blend_span(y, x, x + 1, colour, opacity);
        }
    }

    /// Fills a rectangle; its edges are anti-aliased.
    pub fn fill(&mut self, corners: Corners, colour: Colour, opacity: f32) {
        let Some([x0, y0, x1, y1]) = self.clip_corners(corners) else { return };
        for y in y0 as usize..self.rows_end(y1) {
            let rows = (y1.min(y as f32 + 1.0) - y0.max(y as f32)).max(0.0) * opacity;
            let (first, last) = (x0 as usize, self.columns_end(x1));
            let (inner_first, inner_last) = (x0.ceil() as usize, x1 as usize);
            if inner_first > inner_last {
                self.blend_span(y, first, last, colour, rows * (x1 - x0));
                continue;
            }
            self.blend_span(y, first, inner_first, colour, rows * (inner_first as f32 - x0));
            self.blend_span(y, inner_first, inner_last, colour, rows);
            self.blend_span(y, inner_last, last, colour, rows * (x1 - inner_last as f32));
        }
    }

    /// Fills a rectangle with round corners.
    pub fn fill_rounded(&mut self, corners: Corners, radius: f32, colour: Colour, opacity: f32) {
        let [left, top, right, bottom] = corners;
        let Some([x0, y0, x1, y1]) = self.clip_corners(corners) else { return };
        let radius = radius.min((right - left) / 2.0).min((bottom - top) / 2.0);
        for y in y0 as usize..self.rows_end(y1) {
            let centre = y as f32 + 0.5;
            let dy = (top + radius - centre).max(centre - (bottom - radius)).max(0.0);
            // Away from the corners the whole row is inside.
            if dy == 0.0 && centre > top + 0.5 && centre < bottom - 0.5 {
                self.fill([x0, y as f32, x1, y as f32 + 1.0], colour, opacity);
                continue;
            }
            for x in x0 as usize..self.columns_end(x1) {
                let middle = x as f32 + 0.5;
                let dx = (left + radius - middle).max(middle - (right - radius)).max(0.0);
                let inside = radius + 0.5 - dx.hypot(dy);
                self.blend(x, y, colour, inside.clamp(0.0, 1.0) * opacity);
            }
        }
    }

    /// Outlines a rectangle with a line of `thickness`, centred on the edge.
    pub fn outline(&mut self, corners: Corners, thickness: f32, colour: Colour, opacity: f32) {
        let [left, top, right, bottom] = corners;
        let half = thickness / 2.0;
        let (x0, y0, x1, y1) = (left - half, top - half, right + half, bottom + half);
        if right - left <= thickness || bottom - top <= thickness {
            return self.fill([x0, y0, x1, y1], colour, opacity);
        }
        self.fill([x0, y0, x1, y0 + thickness], colour, opacity);
        self.fill([x0, y1 - thickness, x1, y1], colour, opacity);
        self.fill([x0, y0 + thickness, x0 + thickness, y1 - thickness], colour, opacity);
        self.fill([x1 - thickness, y0 + thickness, x1, y1 - thickness], colour, opacity);
    }

    /// Draws a straight line with round ends.
    pub fn line(&mut self, from: Point, to: Point, thickness: f32, colour: Colour, opacity: f32) {
        let radius = thickness / 2.0;
        let reach = radius + 1.0;
        let Some((from, to)) = self.clip_line(from, to, reach) else { return };
        let along = [to[0] - from[0], to[1] - from[1]];
        let length_squared = along[0] * along[0] + along[1] * along[1];
        let (y0, y1) = (from[1].min(to[1]) - reach, from[1].max(to[1]) + reach);
        for y in y0.max(0.0) as usize..self.rows_end(y1) {
            let centre = y as f32 + 0.5;
            // Only this part of the line can be within reach of a pixel of this row.
            let [a, b] = [centre - reach, centre + reach].map(|edge| {
                let part = if along[1] == 0.0 { 0.0 } else { (edge - from[1]) / along[1] };
                from[0] + part.clamp(0.0, 1.0) * along[0]
            });
            let (a, b) = if along[1] == 0.0 { (from[0], to[0]) } else { (a, b) };
            let (x0, x1) = (a.min(b) - reach, a.max(b) + reach);
            for x in x0.max(0.0) as usize..self.columns_end(x1) {
                let away = [x as f32 + 0.5 - from[0], centre - from[1]];
                let part = if length_squared > 0.0 {
                    ((away[0] * along[0] + away[1] * along[1]) / length_squared).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let distance = (away[0] - part * along[0]).hypot(away[1] - part * along[1]);
                let coverage = (radius + 0.5 - distance).clamp(0.0, 1.0);
                self.blend(x, y, colour, coverage * opacity);
            }
        }
    }

    /// Draws a filled disc.
    pub fn disc(&mut self, centre: Point, radius: f32, colour: Colour, opacity: f32) {
        self.line(centre, centre, radius * 2.0, colour, opacity);
    }

    /// Blends `colour` into part of a row; opacity 0..=1. The caller keeps `x0..x1` and `y` inside the image.
    pub(super) fn blend_span(&mut self, y: usize, x0: usize, x1: usize, colour: Colour, opacity: f32) {
        let start = y * self.width * 3;
        let Some(span) = self.pixels.get_mut(start + x0 * 3..start + x1 * 3) else { return };
        let weight = (opacity.clamp(0.0, 1.0) * 256.0 + 0.5) as u32;
        for pixel in span.chunks_exact_mut(3) {
            for (sample, colour) in pixel.iter_mut().zip(colour) {
                *sample =
                    ((u32::from(*sample) * (256 - weight) + u32::from(colour) * weight + 128) >> 8) as u8;
            }
        }
    }

    fn rows_end(&self, y: f32) -> usize {
        (y.ceil().max(0.0) as usize).min(self.height)
    }

    fn columns_end(&self, x: f32) -> usize {
        (x.ceil().max(0.0) as usize).min(self.width)
    }

    /// Returns the part of a rectangle inside the image; `None` when it is empty or not finite.
    pub(super) fn clip_corners(&self, [x0, y0, x1, y1]: Corners) -> Option<Corners> {
        let (width, height) = (self.width as f32, self.height as f32);
        let clipped =
            [x0.clamp(0.0, width), y0.clamp(0.0, height), x1.clamp(0.0, width), y1.clamp(0.0, height)];
        (clipped[0] < clipped[2] && clipped[1] < clipped[3]).then_some(clipped)
    }

    /// Returns the part of a line within `reach` of the image (Liang and Barsky, 1984).
    fn clip_line(&self, from: Point, to: Point, reach: f32) -> Option<(Point, Point)> {
        if ![from, to].as_flattened().iter().all(|part| part.is_finite()) || !reach.is_finite() {
            return None;
        }
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        let [from, to] = [from, to].map(|point| point.map(f64::from));
        let limits = [self.width as f64, self.height as f64];
        for axis in 0..2 {
            let along = to[axis] - from[axis];
            let (low, high) = (f64::from(-reach), limits[axis] + f64::from(reach));
            if along == 0.0 {
                if from[axis] < low || from[axis] > high {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low - from[axis]) / along, (high - from[axis]) / along);
            first = first.max(a.min(b));
            last = last.min(a.max(b));
        }
        let at = |part: f64| [0, 1].map(|axis| (from[axis] + part * (to[axis] - from[axis])) as f32);
        (first <= last).then(|| (at(first), at(last)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Colour = [255; 3];

    fn black(width: usize, height: usize) -> Image {
        Image::from_rgb8(vec![0; width * height * 3], width, height).unwrap()
    }

    fn lit(image: &Image) -> f32 {
        image.hwc_u8(PixelFormat::Grey).iter().map(|sample| f32::from(*sample) / 255.0).sum()
    }

    #[test]
    fn areas_are_exact() {
        let mut image = black(40, 40);
        Canvas::over(&mut image).fill([3.25, 4.5, 13.5, 9.0], WHITE, 1.0);
        assert!((lit(&image) - 10.25 * 4.5).abs() < 0.2, "{}", lit(&image));
        let mut image = black(40, 40);
        Canvas::over(&mut image).disc([20.0, 20.0], 10.0, WHITE, 1.0);
        assert!((lit(&image) - std::f32::consts::PI * 100.0).abs() < 2.0, "{}", lit(&image));
        let mut image = black(40, 40);
        Canvas::over(&mut image).line([5.0, 7.0], [30.0, 33.0], 3.0, WHITE, 1.0);
        let wanted = 3.0 * 25.0_f32.hypot(26.0) + std::f32::consts::PI * 2.25;
        assert!((lit(&image) - wanted).abs() < 2.0, "{} {wanted}", lit(&image));
        let mut image = black(40, 40);
        Canvas::over(&mut image).fill_rounded([5.0, 5.0, 25.0, 17.0], 4.0, WHITE, 1.0);
        let wanted = 240.0 - (4.0 - std::f32::consts::PI) * 16.0;
        assert!((lit(&image) - wanted).abs() < 2.0, "{} {wanted}", lit(&image));
    }

    #[test]
    fn other_pictures_become_rgb_and_shared_pixels_stay() {
        let mut grey = Image::new(vec![7u8, 8], 2, 1, PixelFormat::Grey, Layout::Chw).unwrap();
        grey.header.stamp_ns = Some(5);
        Canvas::over(&mut grey).blend(0, 0, [1, 2, 3], 1.0);
        assert_eq!(grey.hwc_u8(PixelFormat::Rgb), [1, 2, 3, 8, 8, 8]);
        assert_eq!((grey.format(), grey.header.stamp_ns), (PixelFormat::Rgb, Some(5)));
        let kept = grey.clone();
        Canvas::over(&mut grey).blend(1, 0, WHITE, 1.0);
        assert_eq!(kept.hwc_u8(PixelFormat::Rgb), [1, 2, 3, 8, 8, 8]);
    }

    #[test]
    fn unique_pixels_are_drawn_in_place() {
        let mut image = black(4, 4);
        let before = image.bytes_mut().unwrap().as_ptr();
        Canvas::over(&mut image).fill([0.0, 0.0, 4.0, 4.0], WHITE, 1.0);
        assert_eq!(image.bytes_mut().unwrap().as_ptr(), before);
    }

    #[test]
    fn wild_coordinates_are_cut() {
        let wild = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, -1.0, 0.0, 3.5, 1e9];
        let mut image = black(8, 6);
        let mut canvas = Canvas::over(&mut image);
        for a in wild {
            for b in wild {
                for c in wild {
                    canvas.fill([a, b, c, a], WHITE, 0.5);
                    canvas.fill([a, b, c, 4.0], WHITE, f32::NAN);
                    canvas.fill_rounded([a, b, c, 3.0], 2.0, WHITE, 0.5);
                    canvas.outline([a, b, 3.0, c], 2.0, WHITE, 0.5);
                    canvas.line([a, b], [c, a], 2.0, WHITE, 0.5);
                    canvas.disc([a, b], c.clamp(-4.0, 4.0), WHITE, 0.5);
                }
            }
        }
        canvas.blend(8, 0, WHITE, 1.0);
        canvas.blend(0, usize::MAX, WHITE, 1.0);
    }

    #[test]
    fn a_line_through_the_picture_from_far_away_passes_where_it_should() {
        let mut image = black(9, 9);
        Canvas::over(&mut image).line([-1e7, 4.5], [1e7, 4.5], 1.0, WHITE, 1.0);
        let grey = image.hwc_u8(PixelFormat::Grey);
        assert!(grey[4 * 9..5 * 9].iter().all(|sample| *sample == 255));
        assert!((lit(&image) - 9.0).abs() < 0.1);
    }
}
