//! Filled shapes on an image, with y upwards.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_vision::draw::{Canvas, Colour, Point};

/// A white canvas.
pub(crate) struct Drawing {
    image: Image,
    height: f32,
}

pub(crate) const BLACK: Colour = [0; 3];

impl Drawing {
    /// Creates a white canvas of a size in pixels.
    pub fn new(width: usize, height: usize) -> Result<Self> {
        let image = Image::from_rgb8(vec![255; 3 * width * height], width, height)?;
        Ok(Self { image, height: height as f32 })
    }

    /// Draws over an image of three bytes per pixel.
    pub fn over(image: Image) -> Self {
        let height = image.height() as f32;
        Self { image, height }
    }

    pub fn finish(self) -> Image {
        self.image
    }

    /// Draws a disc.
    pub fn disc(&mut self, centre: Point, radius: f32, colour: Colour) {
        let centre = self.flipped(centre);
        Canvas::over(&mut self.image).disc(centre, radius, colour, 1.0);
    }

    /// Draws a line with round ends.
    pub fn line(&mut self, from: Point, to: Point, thickness: f32, colour: Colour) {
        let (from, to) = (self.flipped(from), self.flipped(to));
        Canvas::over(&mut self.image).line(from, to, thickness, colour, 1.0);
    }

    /// Draws a filled convex polygon; its corners may be in either orientation.
    pub fn polygon(&mut self, corners: &[Point], colour: Colour) {
        let corners: Vec<_> = corners.iter().map(|corner| self.flipped(*corner)).collect();
        let edges = corners.iter().zip(corners.iter().cycle().skip(1));
        let edges: Vec<_> = edges.map(|(from, to)| (*from, [to[0] - from[0], to[1] - from[1]])).collect();
        let twice_area: f32 =
            corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        let span = |axis: usize, limit: usize| {
            let low = corners.iter().map(|corner| corner[axis]).fold(f32::INFINITY, f32::min);
            let high = corners.iter().map(|corner| corner[axis]).fold(f32::NEG_INFINITY, f32::max);
            (low - 1.0).max(0.0) as usize..((high + 1.0).max(0.0) as usize).min(limit)
        };
        let (columns, rows) = (span(0, self.image.width()), span(1, self.image.height()));
        let mut canvas = Canvas::over(&mut self.image);
        for y in rows {
            for x in columns.clone() {
                let inside = |(from, along): &(Point, Point)| {
                    let aside = [x as f32 + 0.5 - from[0], y as f32 + 0.5 - from[1]];
                    (along[0] * aside[1] - along[1] * aside[0]) * twice_area.signum()
                        / along[0].hypot(along[1])
                };
                let depth = edges.iter().map(inside).fold(f32::INFINITY, f32::min);
                canvas.blend(x, y, colour, (depth + 0.5).clamp(0.0, 1.0));
            }
        }
    }

    /// Draws a rectangle around `centre`, rotated counter-clockwise by an angle with this sine and cosine.
    pub fn turned_box(&mut self, centre: Point, half: Point, (sine, cosine): (f32, f32), colour: Colour) {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]: [f32; 2]| {
            let (x, y) = (x * half[0], y * half[1]);
            [centre[0] + cosine * x - sine * y, centre[1] + sine * x + cosine * y]
        });
        self.polygon(&corners, colour);
    }

    fn flipped(&self, [x, y]: Point) -> Point {
        [x, self.height - y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_have_their_areas() {
        let mut drawing = Drawing::new(60, 40).unwrap();
        drawing.turned_box([30.0, 20.0], [12.0, 5.0], (0.6, 0.8), BLACK);
        drawing.polygon(&[[2.0, 2.0], [8.0, 2.0], [2.0, 10.0]], BLACK);
        let bytes = drawing.finish().hwc_u8(opendr_engine::data::PixelFormat::Grey);
        let dark: f32 = bytes.iter().map(|sample| 1.0 - f32::from(*sample) / 255.0).sum();
        assert!((dark - 240.0 - 24.0).abs() < 3.0, "{dark}");
        assert!(bytes[60 * 36 + 3] < 20 && bytes[60 * 3 + 3] == 255);
    }
}
