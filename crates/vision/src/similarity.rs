//! Position of a rotated crop in its image.

use crate::Warp;

/// A similarity transform between an image and a crop of it: scale, rotation and translation, without reflection.
///
/// Positions are continuous, as in [`crate::InputGeometry`]: the left-top corner of the first pixel is (0, 0), its
/// centre (0.5, 0.5). Angles are in radians and turn from x to y: clockwise in a displayed image.
/// [`crate::Preprocess::warp_into`] writes the crop as a network's input.
///
/// ```
/// use opendr_vision::Similarity;
///
/// // A square of 100 pixels, turned by 90 degrees, as a crop of 50 pixels.
/// let crop = Similarity::rotated_square([320.0, 240.0], 100.0, std::f32::consts::FRAC_PI_2, 50);
/// let [x, y] = crop.image_from_crop([50.0, 25.0]);
/// assert!((x - 320.0).abs() < 1e-3 && (y - 290.0).abs() < 1e-3);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// Scale times cosine and sine of the angle.
    turn: [f64; 2],
    /// Image position of the crop's (0, 0).
    origin: [f64; 2],
}

impl Similarity {
    /// The identity: the crop is the image.
    pub const IDENTITY: Self = Self { turn: [1.0, 0.0], origin: [0.0, 0.0] };

    /// Creates a crop whose pixels are `scale` image pixels wide, whose x axis points along `angle` in the image and
    /// whose left-top corner is at `origin`.
    pub fn new(scale: f32, angle: f32, origin: [f32; 2]) -> Self {
        let (sine, cosine) = f64::from(angle).sin_cos();
        let scale = f64::from(scale);
        Self { turn: [scale * cosine, scale * sine], origin: origin.map(f64::from) }
    }

    /// Creates the square crop of `side` image pixels around `centre` whose x axis points along `angle`; the crop has
    /// `crop_side` pixels per side.
    pub fn rotated_square(centre: [f32; 2], side: f32, angle: f32, crop_side: usize) -> Self {
        let centred = Self::new(side / crop_side as f32, angle, [0.0, 0.0]);
        let middle = centred.forward([crop_side as f64 / 2.0; 2]);
        Self { origin: std::array::from_fn(|axis| f64::from(centre[axis]) - middle[axis]), ..centred }
    }

    /// Fits the similarity that maps image points to crop points with the least sum of squared distances, measured in
    /// the crop (Umeyama, "Least-squares estimation of transformation parameters between two point patterns", 1991),
    /// as in the alignment of faces to a template. The result is never a reflection.
    ///
    /// Returns `None` for fewer than two points, different numbers of points, values that are not finite, or points
    /// that all coincide.
    pub fn from_points(image: &[[f32; 2]], crop: &[[f32; 2]]) -> Option<Self> {
        if image.len() != crop.len() || image.len() < 2 {
            return None;
        }
        let (from, to) = (mean(image), mean(crop));
        let centred =
            |point: &[f32; 2], mean: [f64; 2]| [f64::from(point[0]) - mean[0], f64::from(point[1]) - mean[1]];
        let (mut along, mut across, mut spread) = (0.0, 0.0, 0.0);
        for (image, crop) in image.iter().zip(crop) {
            let ([x, y], [u, v]) = (centred(image, from), centred(crop, to));
            along += x * u + y * v;
            across += x * v - y * u;
            spread += x * x + y * y;
        }
        // crop = (a, b) * image + shift, as complex numbers.
        let [a, b] = [along / spread, across / spread];
        let shift = [to[0] - (a * from[0] - b * from[1]), to[1] - (b * from[0] + a * from[1])];
        let norm = a * a + b * b;
        let inverse = Self { turn: [a / norm, -b / norm], origin: [0.0, 0.0] };
        let [x, y] = inverse.forward(shift);
        let found = Self { origin: [-x, -y], ..inverse };
        found.is_regular().then_some(found)
    }

    /// Maps a point of the crop to pixels of the image; the result may be outside the image.
    pub fn image_from_crop(&self, point: [f32; 2]) -> [f32; 2] {
        self.forward(point.map(f64::from)).map(|value| value as f32)
    }

    /// Maps a point of the image to pixels of the crop; the result may be outside the crop.
    pub fn crop_from_image(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let (x, y) = (f64::from(x) - self.origin[0], f64::from(y) - self.origin[1]);
        let [a, b] = self.turn;
        let norm = a * a + b * b;
        [((a * x + b * y) / norm) as f32, ((a * y - b * x) / norm) as f32]
    }

    /// Returns the image pixels per crop pixel.
    pub fn scale(&self) -> f32 {
        self.turn[0].hypot(self.turn[1]) as f32
    }

    /// Returns the direction of the crop's x axis in the image, in radians, -pi..=pi.
    pub fn angle(&self) -> f32 {
        self.turn[1].atan2(self.turn[0]) as f32
    }

    /// Returns whether all numbers are finite and the scale is not 0.
    pub fn is_regular(&self) -> bool {
        let [a, b] = self.turn;
        (a * a + b * b).is_normal() && self.origin.iter().all(|value| value.is_finite())
    }

    fn forward(&self, point: [f64; 2]) -> [f64; 2] {
        Warp::from(self).image_from_crop(point)
    }
}

impl From<&Similarity> for Warp {
    fn from(Similarity { turn: [a, b], origin }: &Similarity) -> Self {
        Self { origin: *origin, right: [*a, *b], down: [-b, *a] }
    }
}

fn mean(points: &[[f32; 2]]) -> [f64; 2] {
    let sum = |axis: usize| points.iter().map(|point| f64::from(point[axis])).sum::<f64>();
    [sum(0), sum(1)].map(|sum| sum / points.len() as f64)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn close(a: [f32; 2], b: [f32; 2], within: f32) -> bool {
        (a[0] - b[0]).abs() <= within && (a[1] - b[1]).abs() <= within
    }

    #[test]
    fn reflected_points_are_not_reflected() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 1.0]];
        let mirrored = square.map(|[x, y]| [-x, y]);
        let found = Similarity::from_points(&square, &mirrored).unwrap();
        let [a, b] = found.turn;
        assert!(a * a + b * b > 0.0);
        // A reflection maps every point exactly.
        assert!(square.iter().zip(&mirrored).any(|(a, b)| !close(found.crop_from_image(*a), *b, 0.1)));
    }

    #[test]
    fn least_squares_of_umeyama() {
        // NumPy 2.4: the singular value decomposition of the paper, on ArcFace's template.
        let image = [[100.0, 120.0], [160.0, 118.0], [131.0, 160.0], [105.0, 190.0], [158.0, 188.0]];
        let crop = [
            [38.2946, 51.6963],
            [73.5318, 51.5014],
            [56.0252, 71.7366],
            [41.5493, 92.3655],
            [70.7299, 92.2041],
        ];
        let found = Similarity::from_points(&image, &crop).unwrap();
        assert!((1.0 / found.scale() - 0.574_866_8).abs() < 1e-5);
        assert!((-found.angle() - 0.021_253).abs() < 1e-5);
        assert!(close(found.crop_from_image([0.0, 0.0]), [-17.253_397, -18.896_346], 1e-3));
    }

    #[test]
    fn degenerate_points_return_none() {
        assert!(Similarity::from_points(&[[1.0, 2.0]], &[[1.0, 2.0]]).is_none());
        assert!(Similarity::from_points(&[[1.0, 2.0]; 3], &[[1.0, 2.0]; 2]).is_none());
        assert!(Similarity::from_points(&[[1.0, 2.0]; 3], &[[1.0, 2.0], [2.0, 2.0], [3.0, 3.0]]).is_none());
        assert!(Similarity::from_points(&[[1.0, 2.0], [3.0, 2.0]], &[[4.0, 4.0]; 2]).is_none());
        assert!(Similarity::from_points(&[[f32::NAN, 2.0], [3.0, 2.0]], &[[1.0, 4.0], [2.0, 4.0]]).is_none());
        assert!(!Similarity::new(0.0, 0.0, [0.0; 2]).is_regular());
        assert!(Warp::from(&Similarity::new(f32::NAN, 0.0, [0.0; 2])).fixed_point([2, 2]).is_err());
        assert!(Warp::from(&Similarity::new(1.0, f32::INFINITY, [0.0; 2])).fixed_point([2, 2]).is_err());
        assert!(Warp::from(&Similarity::new(1.0, 0.0, [0.0, f32::NAN])).fixed_point([2, 2]).is_err());
        assert!(Warp::from(&Similarity::new(1e9, 0.0, [0.0; 2])).fixed_point([2, 2]).is_err());
    }

    proptest! {
        #[test]
        fn similarity_is_recovered_from_points(
            scale in 0.05f32..20.0, angle in -3.1f32..3.1, origin in [-2e3f32..2e3, -2e3f32..2e3],
            points in prop::collection::vec([0.0f32..200.0, 0.0f32..200.0], 2..9),
        ) {
            let made = Similarity::new(scale, angle, origin);
            prop_assert!((made.scale() / scale - 1.0).abs() < 1e-5 && (made.angle() - angle).abs() < 1e-5);
            let image: Vec<_> = points.iter().map(|point| made.image_from_crop(*point)).collect();
            for (there, back) in image.iter().zip(&points) {
                prop_assert!(close(made.crop_from_image(*there), *back, 0.05));
            }
            prop_assume!(points.iter().any(|point| !close(*point, points[0], 30.0)));
            let found = Similarity::from_points(&image, &points).unwrap();
            for (there, back) in image.iter().zip(&points) {
                prop_assert!(close(found.crop_from_image(*there), *back, 0.1));
            }
        }

        #[test]
        fn squares_have_their_centre_and_side(
            centre in [-50.0f32..700.0, -50.0f32..500.0], side in 1.0f32..900.0, angle in -4.0f32..4.0,
        ) {
            let crop = Similarity::rotated_square(centre, side, angle, 224);
            prop_assert!(close(crop.image_from_crop([112.0, 112.0]), centre, 1e-3));
            let [x, y] = crop.image_from_crop([224.0, 112.0]);
            let right = [centre[0] + side / 2.0 * angle.cos(), centre[1] + side / 2.0 * angle.sin()];
            prop_assert!(close([x, y], right, 2e-3));
        }
    }
}
