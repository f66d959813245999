//! Interpolation of a map to the pixels of an image.

/// Constant of the cubic convolution (Keys, 1981), that of PyTorch and OpenCV.
const CUBIC: f32 = -0.75;

/// The places along an axis of the map from which a pixel is interpolated, and their weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Taps {
    places: [usize; 4],
    weights: [f32; 4],
}

impl Taps {
    /// Returns the cubic interpolation at a position in pixels of the map, whose first centre is 0; pixels outside are those of the edge.
    pub fn cubic(position: f32, count: usize) -> Self {
        let last = count.saturating_sub(1);
        let whole = position.floor().clamp(-2.0, count as f32);
        let near = |x: f32| ((CUBIC + 2.0) * x - (CUBIC + 3.0)) * x * x + 1.0;
        let far = |x: f32| ((CUBIC * x - 5.0 * CUBIC) * x + 8.0 * CUBIC) * x - 4.0 * CUBIC;
        let share = position - whole;
        let places = [-1.0, 0.0, 1.0, 2.0].map(|step| ((whole + step).max(0.0) as usize).min(last));
        let weights = [far(share + 1.0), near(share), near(1.0 - share), far(2.0 - share)];
        Self { places, weights }
    }

    /// Returns the linear interpolation at such a position; positions outside are those of the edge.
    pub fn linear(position: f32, count: usize) -> Self {
        let last = count.saturating_sub(1);
        let position = position.clamp(0.0, last as f32);
        let first = position as usize;
        let share = position - first as f32;
        Self { places: [first, (first + 1).min(last), 0, 0], weights: [1.0 - share, share, 0.0, 0.0] }
    }

    /// Returns places and weights other than 0, so that infinite depths stay where they are.
    fn used(&self) -> impl Iterator<Item = (usize, f32)> {
        self.places.into_iter().zip(self.weights).filter(|(_, weight)| *weight != 0.0)
    }
}

/// Work memory of [`Interpolation::run`]; the taps are those of the columns and rows of the image.
#[derive(Default)]
pub(super) struct Interpolation {
    pub columns: Vec<Taps>,
    pub rows: Vec<Taps>,
    /// The map with the columns of the image, row by row.
    widened: Vec<f32>,
}

impl Interpolation {
    /// Writes the interpolated map, times `factor`, row by row. `width` is the number of columns of the map; the taps lie inside of it.
    pub fn run(&mut self, map: &[f32], width: usize, factor: f32, pixels: &mut [f32]) {
        let Self { columns, rows, widened } = self;
        widened.clear();
        widened.reserve(map.len() / width.max(1) * columns.len());
        for line in map.chunks_exact(width.max(1)) {
            let interpolate =
                |taps: &Taps| taps.used().map(|(place, weight)| line[place] * weight).sum::<f32>();
            widened.extend(columns.iter().map(interpolate));
        }
        let count = columns.len().max(1);
        for (line, taps) in pixels.chunks_exact_mut(count).zip(rows.iter()) {
            line.fill(0.0);
            for (place, weight) in taps.used() {
                let weight = weight * factor;
                let row = &widened[place * count..][..count];
                line.iter_mut().zip(row).for_each(|(pixel, value)| *pixel += value * weight);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Interpolates a map with the columns and rows of `image` by `taps`, which returns those of a pixel, of the sides of image and map.
    fn interpolated(
        map: &[f32],
        [width, height]: [usize; 2],
        image: [usize; 2],
        taps: fn(usize, usize, usize) -> Taps,
    ) -> Vec<f32> {
        let axis = |pixels: usize, count: usize| (0..pixels).map(|at| taps(at, pixels, count)).collect();
        let mut interpolation = Interpolation {
            columns: axis(image[0], width),
            rows: axis(image[1], height),
            ..Interpolation::default()
        };
        let mut pixels = vec![f32::NAN; image[0] * image[1]];
        interpolation.run(map, width, 1.0, &mut pixels);
        pixels
    }

    fn bicubic(at: usize, pixels: usize, count: usize) -> Taps {
        Taps::cubic((at as f32 + 0.5) * count as f32 / pixels as f32 - 0.5, count)
    }

    fn corners(at: usize, pixels: usize, count: usize) -> Taps {
        Taps::linear(at as f32 * (count - 1) as f32 / (pixels - 1) as f32, count)
    }

    fn assert_close(found: &[f32], wanted: &[f32]) {
        assert_eq!(found.len(), wanted.len());
        assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-5), "{found:?}");
    }

    #[test]
    fn bicubic_is_that_of_pytorch() {
        // torch.nn.functional.interpolate(map, size=(3, 5), mode="bicubic", align_corners=False) of PyTorch 2.15.0.
        let map = [1.0, 4.0, 2.0, 0.0, 8.0, 3.0];
        let wanted = [
            [0.840473, 2.207653, 3.652779, 2.772903, 1.746195],
            [-0.028, 2.886001, 6.0, 4.253999, 2.164001],
            [-0.896472, 3.564348, 8.347222, 5.735096, 2.581807],
        ];
        assert_close(&interpolated(&map, [3, 2], [5, 3], bicubic), wanted.as_flattened());
        assert_eq!(interpolated(&map, [3, 2], [3, 2], bicubic), map);
    }

    #[test]
    fn bilinear_corners_are_those_of_pytorch() {
        // The same with mode="bilinear", align_corners=True.
        let map = [1.0, 4.0, 2.0, 0.0, 8.0, 3.0];
        let wanted = [[1.0, 2.5, 4.0, 3.0, 2.0], [0.5, 3.25, 6.0, 4.25, 2.5], [0.0, 4.0, 8.0, 5.5, 3.0]];
        assert_close(&interpolated(&map, [3, 2], [5, 3], corners), wanted.as_flattened());
    }

    #[test]
    fn infinite_depths_stay_where_they_are() {
        let map = [f32::INFINITY, 1.0, 2.0];
        assert_eq!(interpolated(&map, [3, 1], [3, 1], bicubic), map);
        assert_eq!(
            interpolated(&map, [3, 1], [5, 1], |at, pixels, count| match count {
                1 => Taps::linear(0.0, 1),
                _ => corners(at, pixels, count),
            })[2..],
            [1.0, 1.5, 2.0]
        );
    }

    #[test]
    fn positions_that_are_not_finite_take_the_edge() {
        for position in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1e9, 1e9] {
            for taps in [Taps::cubic(position, 3), Taps::linear(position, 3)] {
                assert!(taps.places.iter().all(|place| *place < 3), "{position}");
            }
        }
        assert_eq!(Taps::linear(0.5, 1).places, [0; 4]);
    }
}
