//! Upright crops of text as inputs of a network.

use super::homography::Homography;

/// Text with a height of at least 3 / 2 of its width is turned.
const TURN_ABOVE: [usize; 2] = [3, 2];
/// Up to how many pixels of the image per pixel of the crop one sample suffices.
const SINGLE_SAMPLE: f64 = 2.0;
/// The most samples per pixel of the crop, along each direction.
const MAX_SAMPLES: f64 = 8.0;
/// The largest coordinate of a corner.
const MAX_COORDINATE: f32 = 1e7;

/// An image of 8-bit RGB pixels.
#[derive(Debug, Clone, Copy)]
pub struct RgbPixels<'a> {
    /// Three bytes per pixel, row by row.
    pub data: &'a [u8],
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Bytes from the start of a row to that of the next.
    pub stride: usize,
}

/// The shape of an input: planes of blue, green and red, as PaddleOCR's networks expect, of `height` rows of `width` values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputShape {
    /// Rows.
    pub height: usize,
    /// Values per row.
    pub width: usize,
    /// Factor on the width of the text; 1 keeps its aspect ratio.
    pub condense: f64,
}

/// A quadrilateral with text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadrilateral {
    /// The corners, clockwise from the top left of the text. The image begins at (0, 0) and ends at (width, height), so that the centre
    /// of the first pixel is (0.5, 0.5).
    pub corners: [[f32; 2]; 4],
    /// Whether the text is upside down, so that the crop is to be turned by 180 degrees.
    pub upside_down: bool,
}

impl Quadrilateral {
    /// Returns the width and height of its text in pixels of the image: its longest horizontal and vertical edges, rounded down, and swapped if
    /// it is turned.
    pub fn text_size(&self) -> Option<[usize; 2]> {
        self.upright().map(|(_, size)| size)
    }

    /// Returns the width of its text scaled to a height and condensed, rounded up. An input of a batch is as wide as the widest of its texts.
    pub fn scaled_width(&self, height: usize, condense: f64) -> Option<usize> {
        self.text_size().map(|size| scaled_width(size, height, condense))
    }

    /// Returns the corners from the top left of the text as it is read; those of a quadrilateral without text as they are.
    pub fn reading_corners(&self) -> [[f32; 2]; 4] {
        self.upright()
            .map_or(self.corners, |(corners, _)| corners.map(|corner| corner.map(|value| value as f32)))
    }

    /// Returns the quadrilateral with each edge moved outwards by `margin` times its shorter edge.
    pub fn grown(&self, margin: f32) -> Self {
        let [a, b, c, d] = self.corners;
        let length = |from: [f32; 2], to: [f32; 2]| (to[0] - from[0]).hypot(to[1] - from[1]);
        let distance = margin * length(a, b).max(length(d, c)).min(length(a, d).max(length(b, c)));
        // A step of `distance` from one point away from another.
        let away = |from: [f32; 2], other: [f32; 2]| {
            let scale = distance / length(from, other).max(f32::MIN_POSITIVE);
            [0, 1].map(|axis| (from[axis] - other[axis]) * scale)
        };
        let moved = |corner: [f32; 2], along: [f32; 2], across: [f32; 2]| {
            let (along, across) = (away(corner, along), away(corner, across));
            [0, 1].map(|axis| corner[axis] + along[axis] + across[axis])
        };
        Self { corners: [moved(a, b, d), moved(b, a, c), moved(c, d, b), moved(d, c, a)], ..*self }
    }

    /// The corners from the top left of the upright text on, and its size. Text that is much higher than wide is turned by 90 degrees
    /// counterclockwise.
    fn upright(&self) -> Option<([[f64; 2]; 4], [usize; 2])> {
        if !self.corners.as_flattened().iter().all(|value| value.abs() <= MAX_COORDINATE) {
            return None;
        }
        let mut corners = self.corners.map(|corner| corner.map(f64::from));
        let edge = |a: usize, b: usize| (corners[a][0] - corners[b][0]).hypot(corners[a][1] - corners[b][1]);
        let mut size = [edge(0, 1).max(edge(2, 3)), edge(0, 3).max(edge(1, 2))].map(|length| length as usize);
        if size.contains(&0) {
            return None;
        }
        if size[1] * TURN_ABOVE[1] >= size[0] * TURN_ABOVE[0] {
            corners.rotate_left(1);
            size.reverse();
        }
        if self.upside_down {
            corners.rotate_left(2);
        }
        Some((corners, size))
    }
}

/// Writes the text in a quadrilateral of an image to the input of a network: upright, scaled to the height of the input with its aspect
/// ratio kept, but at most to its width, values from -1 to 1, and 0 to the right of the text. Returns the width of the text in the input.
///
/// Each pixel is sampled once from the image, bilinearly, or several times and averaged if the text shrinks by more than 2. Outside of
/// the image are the pixels of its border. `None` for a quadrilateral without a convex area of a pixel or
/// more, one outside the image, and for an image or input of another size than stated; the input is as before then.
pub fn rectify(
    image: &RgbPixels<'_>,
    quadrilateral: &Quadrilateral,
    shape: InputShape,
    input: &mut [f32],
) -> Option<usize> {
    image.check()?;
    let plane = shape.height.checked_mul(shape.width).filter(|&plane| plane > 0)?;
    if plane.checked_mul(3) != Some(input.len()) {
        return None;
    }
    let (corners, size) = quadrilateral.upright()?;
    let map = Homography::from_unit_square(&corners)?;
    image.check_touched(&corners)?;
    let width = scaled_width(size, shape.height, shape.condense).clamp(1, shape.width);
    let grid = Grid {
        map,
        size: [width, shape.height],
        samples: [samples(size[0], width), samples(size[1], shape.height)],
    };
    input.chunks_exact_mut(shape.width).for_each(|row| row[width..].fill(0.0));
    grid.write(image, shape, input);
    Some(width)
}

fn scaled_width([width, text_height]: [usize; 2], height: usize, condense: f64) -> usize {
    (height as f64 * width as f64 * condense / text_height as f64).ceil() as usize
}

/// How many samples per pixel average a length in the image that is scaled to another.
fn samples(image: usize, crop: usize) -> usize {
    let shrinking = image as f64 / crop as f64;
    if shrinking <= SINGLE_SAMPLE { 1 } else { shrinking.min(MAX_SAMPLES) as usize }
}

/// The points of the image that are sampled.
struct Grid {
    /// From the unit square to the image.
    map: Homography,
    /// Columns and rows of the crop.
    size: [usize; 2],
    /// Samples per column and per row.
    samples: [usize; 2],
}

impl Grid {
    fn write(&self, image: &RgbPixels<'_>, shape: InputShape, input: &mut [f32]) {
        let plane = shape.height * shape.width;
        let (blue, rest) = input.split_at_mut(plane);
        let (green, red) = rest.split_at_mut(plane);
        let scale = 1.0 / (127.5 * (self.samples[0] * self.samples[1]) as f32);
        for row in 0..self.size[1] {
            for column in 0..self.size[0] {
                let [r, g, b] = self.sum(image, column, row).map(|sum| sum * scale - 1.0);
                let index = row * shape.width + column;
                (red[index], green[index], blue[index]) = (r, g, b);
            }
        }
    }

    /// The sum of the samples of a pixel of the crop.
    fn sum(&self, image: &RgbPixels<'_>, column: usize, row: usize) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for across in 0..self.samples[1] {
            let v = self.position(1, row, across);
            for along in 0..self.samples[0] {
                let color = image.sample(self.map.apply([self.position(0, column, along), v]));
                sum = [sum[0] + color[0], sum[1] + color[1], sum[2] + color[2]];
            }
        }
        sum
    }

    /// A sample of a pixel in the unit square, in one direction.
    fn position(&self, direction: usize, pixel: usize, sample: usize) -> f64 {
        let samples = self.samples[direction];
        ((pixel * samples + sample) as f64 + 0.5) / (self.size[direction] * samples) as f64
    }
}

impl RgbPixels<'_> {
    fn check(&self) -> Option<()> {
        let row = self.width.checked_mul(3).filter(|&row| row > 0 && row <= self.stride);
        let rows = self.height.checked_sub(1).and_then(|rows| rows.checked_mul(self.stride));
        let needed = row.zip(rows).and_then(|(row, rows)| rows.checked_add(row));
        needed.filter(|&needed| needed <= self.data.len()).map(|_| ())
    }

    /// Whether the bounding rectangle of corners touches the image.
    fn check_touched(&self, corners: &[[f64; 2]; 4]) -> Option<()> {
        let touched = [self.width, self.height].into_iter().enumerate().all(|(direction, size)| {
            let least = corners.iter().map(|corner| corner[direction]).fold(f64::INFINITY, f64::min);
            let most = corners.iter().map(|corner| corner[direction]).fold(f64::NEG_INFINITY, f64::max);
            most > 0.0 && least < size as f64
        });
        touched.then_some(())
    }

    /// The bilinear colour at a point.
    fn sample(&self, [x, y]: [f64; 2]) -> [f32; 3] {
        let (left, right, across) = neighbours(x, self.width);
        let (top, bottom, down) = neighbours(y, self.height);
        let (upper, lower) = (top * self.stride, bottom * self.stride);
        let [a, b] = [left, right].map(|column| self.pixel(upper + 3 * column));
        let [c, d] = [left, right].map(|column| self.pixel(lower + 3 * column));
        let mix = |a: f32, b: f32, share: f32| a + (b - a) * share;
        [0, 1, 2].map(|channel| {
            mix(mix(a[channel], b[channel], across), mix(c[channel], d[channel], across), down)
        })
    }

    fn pixel(&self, start: usize) -> [f32; 3] {
        match self.data.get(start..start + 3) {
            Some(&[red, green, blue]) => [red, green, blue].map(f32::from),
            _ => [0.0; 3],
        }
    }
}

/// The pixels before and after a coordinate, and the share of the one after. Outside they are the outermost pixel.
fn neighbours(coordinate: f64, size: usize) -> (usize, usize, f32) {
    let last = size - 1;
    let position = (coordinate - 0.5).clamp(0.0, last as f64);
    let before = position as usize;
    (before, (before + 1).min(last), (position - before as f64) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Red rises by 1 per column, green by 1 per row, blue is 7. Rows have padding of 255.
    fn gradient(width: usize, height: usize) -> (Vec<u8>, usize) {
        let stride = width * 3 + 5;
        let mut data = vec![255; stride * height];
        for (y, row) in data.chunks_exact_mut(stride).enumerate() {
            for (x, pixel) in row[..width * 3].chunks_exact_mut(3).enumerate() {
                pixel.copy_from_slice(&[x as u8, y as u8, 7]);
            }
        }
        (data, stride)
    }

    fn crop(
        corners: [[f32; 2]; 4],
        upside_down: bool,
        height: usize,
        width: usize,
    ) -> Option<(usize, Vec<f32>)> {
        let (data, stride) = gradient(200, 100);
        let image = RgbPixels { data: &data, width: 200, height: 100, stride };
        let mut input = vec![f32::NAN; 3 * height * width];
        let shape = InputShape { height, width, condense: 1.0 };
        let text = rectify(&image, &Quadrilateral { corners, upside_down }, shape, &mut input)?;
        // Planes of red, green and blue.
        let plane = height * width;
        (0..plane).for_each(|at| input.swap(at, 2 * plane + at));
        Some((text, input.iter().map(|value| (value + 1.0) * 127.5).collect()))
    }

    fn rectangle(left: f32, top: f32, right: f32, bottom: f32) -> [[f32; 2]; 4] {
        [[left, top], [right, top], [right, bottom], [left, bottom]]
    }

    fn assert_near(value: f32, expected: f32) {
        assert!((value - expected).abs() < 1e-3, "{value} instead of {expected}");
    }

    #[test]
    fn whole_pixels_are_copied() {
        let (text, values) = crop(rectangle(10.0, 20.0, 20.0, 28.0), false, 8, 12).unwrap();
        assert_eq!(text, 10);
        for row in 0..8 {
            for column in 0..10 {
                assert_near(values[row * 12 + column], (10 + column) as f32);
                assert_near(values[96 + row * 12 + column], (20 + row) as f32);
                assert_near(values[192 + row * 12 + column], 7.0);
            }
            assert_near(values[row * 12 + 10], 127.5);
            assert_near(values[row * 12 + 11], 127.5);
        }
    }

    #[test]
    fn upside_down_text_is_turned() {
        let (_, values) = crop(rectangle(10.0, 20.0, 20.0, 28.0), true, 8, 10).unwrap();
        assert_near(values[0], 19.0);
        assert_near(values[80], 27.0);
        assert_near(values[79], 10.0);
        assert_near(values[159], 20.0);
    }

    #[test]
    fn high_text_is_turned_counterclockwise() {
        let quadrilateral = Quadrilateral { corners: rectangle(10.0, 20.0, 18.0, 32.0), upside_down: false };
        assert_eq!(quadrilateral.text_size(), Some([12, 8]));
        assert_eq!(quadrilateral.reading_corners(), [[18.0, 20.0], [18.0, 32.0], [10.0, 32.0], [10.0, 20.0]]);
        assert_eq!(quadrilateral.scaled_width(48, 1.0), Some(72));
        assert_eq!(quadrilateral.scaled_width(48, 0.5), Some(36));
        let (text, values) = crop(quadrilateral.corners, false, 8, 12).unwrap();
        assert_eq!(text, 12);
        assert_near(values[0], 17.0);
        assert_near(values[96], 20.0);
        assert_near(values[11], 17.0);
        assert_near(values[96 + 11], 31.0);
        assert_near(values[84], 10.0);
        assert_near(values[96 + 84], 20.0);
        let lower = Quadrilateral { corners: rectangle(10.0, 20.0, 18.0, 31.0), upside_down: false };
        assert_eq!(lower.text_size(), Some([8, 11]));
    }

    #[test]
    fn quadrilaterals_grow_by_their_shorter_edge() {
        let grown = |corners| Quadrilateral { corners, upside_down: false }.grown(0.25).corners;
        assert_eq!(grown(rectangle(10.0, 20.0, 50.0, 28.0)), rectangle(8.0, 18.0, 52.0, 30.0));
        assert_eq!(grown(rectangle(10.0, 20.0, 14.0, 60.0)), rectangle(9.0, 19.0, 15.0, 61.0));
        let [a, ..] = grown([[50.0, 20.0], [82.0, 44.0], [76.0, 52.0], [44.0, 28.0]]);
        assert_near(a[0], 50.0 - 2.5 * 0.8 + 2.5 * 0.6);
        assert_near(a[1], 20.0 - 2.5 * 0.6 - 2.5 * 0.8);
        assert!(grown([[f32::NAN; 2]; 4])[0][0].is_nan() && grown([[1.0; 2]; 4]) == [[1.0; 2]; 4]);
    }

    #[test]
    fn tilted_text_is_sampled_along_its_sides() {
        let (text, values) =
            crop([[50.0, 20.0], [82.0, 44.0], [76.0, 52.0], [44.0, 28.0]], false, 10, 40).unwrap();
        assert_eq!(text, 40);
        // The centre of the pixel at column 10 and row 5, from (50, 20) on along (0.8, 0.6) and (-0.6, 0.8).
        assert_near(values[5 * 40 + 10], 50.0 + 10.5 * 0.8 - 5.5 * 0.6 - 0.5);
        assert_near(values[400 + 5 * 40 + 10], 20.0 + 10.5 * 0.6 + 5.5 * 0.8 - 0.5);
    }

    #[test]
    fn border_is_repeated() {
        let (_, values) = crop(rectangle(-4.0, -4.0, 4.0, 4.0), false, 8, 8).unwrap();
        assert_near(values[0], 0.0);
        assert_near(values[7], 3.0);
        let (_, values) = crop(rectangle(196.0, 96.0, 204.0, 104.0), false, 8, 8).unwrap();
        assert_near(values[63], 199.0);
        assert_near(values[64 + 63], 99.0);
    }

    #[test]
    fn shrinking_averages_stripes() {
        let (width, height) = (160, 40);
        let data: Vec<u8> =
            (0..width * height * 3).map(|index| if index / 3 % 2 == 0 { 0 } else { 255 }).collect();
        let image = RgbPixels { data: &data, width, height, stride: width * 3 };
        let quadrilateral = Quadrilateral { corners: rectangle(0.0, 0.0, 160.0, 40.0), upside_down: false };
        let shape = InputShape { height: 8, width: 32, condense: 1.0 };
        let mut input = vec![f32::NAN; 3 * 8 * 32];
        assert_eq!(rectify(&image, &quadrilateral, shape, &mut input), Some(32));
        // An odd number of stripes per pixel: a fifth remains.
        assert!(input.iter().all(|value| value.abs() <= 0.21), "{input:?}");
    }

    #[test]
    fn planes_are_blue_green_and_red_and_the_width_is_limited() {
        let (data, stride) = gradient(200, 100);
        let image = RgbPixels { data: &data, width: 200, height: 100, stride };
        let quadrilateral = Quadrilateral { corners: rectangle(0.0, 0.0, 100.0, 10.0), upside_down: false };
        let shape = InputShape { height: 4, width: 5, condense: 1.0 };
        let mut input = vec![f32::NAN; 60];
        assert_eq!(rectify(&image, &quadrilateral, shape, &mut input), Some(5));
        assert_near(input[0], 7.0 / 127.5 - 1.0);
        assert!(input[44] > input[40]);
    }

    #[test]
    fn degenerate_quadrilaterals_are_errors() {
        for corners in [
            [[5.0, 5.0]; 4],
            rectangle(5.0, 5.0, 50.0, 5.5),
            [[0.0, 0.0], [50.0, 0.0], [0.0, 0.0], [50.0, 0.0]],
            [[0.0, 0.0], [50.0, 50.0], [50.0, 0.0], [0.0, 50.0]],
            rectangle(f32::NAN, 5.0, 50.0, 20.0),
            rectangle(5.0, 5.0, f32::INFINITY, 20.0),
            rectangle(f32::MIN, f32::MIN, f32::MAX, f32::MAX),
        ] {
            assert_eq!(crop(corners, false, 8, 16), None, "{corners:?}");
        }
        assert_eq!(crop(rectangle(500.0, 5.0, 550.0, 20.0), false, 8, 16), None);
        assert_eq!(crop(rectangle(5.0, -50.0, 50.0, -20.0), false, 8, 16), None);
        assert!(crop(rectangle(-1e6, -1e5, 1e6, 1e5), false, 8, 16).is_some());
    }

    #[test]
    fn wrong_sizes_are_errors() {
        let quadrilateral = Quadrilateral { corners: rectangle(0.0, 0.0, 9.0, 9.0), upside_down: false };
        let shape = InputShape { height: 4, width: 4, condense: 1.0 };
        let data = [0; 300];
        for (width, height, stride) in
            [(0, 10, 30), (10, 0, 30), (10, 10, 29), (10, 11, 30), (usize::MAX, 2, usize::MAX)]
        {
            let image = RgbPixels { data: &data, width, height, stride };
            assert_eq!(rectify(&image, &quadrilateral, shape, &mut [0.0; 48]), None);
        }
        let image = RgbPixels { data: &data, width: 10, height: 10, stride: 30 };
        assert_eq!(rectify(&image, &quadrilateral, shape, &mut [0.0; 47]), None);
        for (height, width) in [(0, 4), (4, 0), (usize::MAX, usize::MAX), (usize::MAX, 1)] {
            let shape = InputShape { height, width, ..shape };
            assert_eq!(rectify(&image, &quadrilateral, shape, &mut []), None);
        }
    }
}
