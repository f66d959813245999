//! Positions of keypoints in heatmaps.

/// Deviation of the Gaussian that smooths a heatmap, in cells, and its radius: those of transformers.
const DEVIATION: f64 = 0.8;
const RADIUS: i64 = 5;
/// Range of the scores whose logarithms are a paraboloid.
const SCORES: [f64; 2] = [0.001, 50.0];

/// The scores of a keypoint in each cell.
#[derive(Debug, Clone, Copy)]
pub struct Heatmap<'a> {
    pub values: &'a [f32],
    /// Width and height in cells, at least 1 each.
    pub size: [usize; 2],
}

/// Returns the first of the largest numbers and its index; numbers that are not comparable are never the largest.
pub fn largest(values: &[f32]) -> (usize, f32) {
    let first = (0, f32::NEG_INFINITY);
    values
        .iter()
        .enumerate()
        .fold(first, |best, (at, value)| if *value > best.1 { (at, *value) } else { best })
}

impl Heatmap<'_> {
    /// Returns the cell with the highest score, x and y, and the score.
    pub fn peak(&self) -> ([usize; 2], f32) {
        let (at, score) = largest(self.values);
        ([at % self.size[0], at / self.size[0]], score)
    }

    /// Returns the position a quarter of a cell from `peak` towards the higher neighbour on each axis (Newell et al., 2016, with the
    /// borders of MMPose).
    pub fn quarter(&self, peak: [usize; 2]) -> [f64; 2] {
        let [width, height] = self.size;
        let [x, y] = peak;
        let shift = |is_inside: bool, step: usize| {
            let at = y * width + x;
            if !is_inside {
                return 0.0;
            }
            let rise = self.values[at + step] - self.values[at - step];
            if rise == 0.0 || rise.is_nan() { 0.0 } else { 0.25 * f64::from(rise.signum()) }
        };
        let dx = shift(x > 1 && x + 1 < width && y > 0, 1);
        let dy = shift(y > 1 && y + 1 < height && x > 0, width);
        [x as f64 + dx, y as f64 + dy]
    }

    /// Returns the maximum of the paraboloid through the logarithms of the smoothed scores around `peak` (Zhang et al., 2020); the peak
    /// where they have none.
    pub fn paraboloid(&self, peak: [usize; 2]) -> [f64; 2] {
        let [x, y] = peak.map(|at| at as i64);
        let kernel = kernel();
        let log =
            |dx: i64, dy: i64| self.smoothed(&kernel, [x + dx, y + dy]).clamp(SCORES[0], SCORES[1]).ln();
        let (middle, right, left) = (log(0, 0), log(1, 0), log(-1, 0));
        let (below, above) = (log(0, 1), log(0, -1));
        let (dx, dy) = (0.5 * (right - left), 0.5 * (below - above));
        let epsilon = f64::from(f32::EPSILON);
        let dxx = right - 2.0 * middle + left + epsilon;
        let dyy = below - 2.0 * middle + above + epsilon;
        let dxy = 0.5 * (log(1, 1) - right - below + 2.0 * middle - left - above + log(-1, -1));
        let determinant = dxx * dyy - dxy * dxy;
        let moved =
            [x as f64 - (dyy * dx - dxy * dy) / determinant, y as f64 - (dxx * dy - dxy * dx) / determinant];
        if moved.iter().all(|at| at.is_finite()) { moved } else { peak.map(|at| at as f64) }
    }

    /// Returns the smoothed score of a cell; cells outside have that of the border.
    fn smoothed(&self, kernel: &Kernel, at: [i64; 2]) -> f64 {
        let size = self.size.map(|side| side as i64);
        let [x, y] = [0, 1].map(|axis| at[axis].clamp(0, size[axis] - 1));
        let row = |y: i64| {
            let cell = |x: i64| f64::from(self.values[(y * size[0] + reflected(x, size[0])) as usize]);
            (x - RADIUS..).zip(kernel).map(|(x, weight)| weight * cell(x)).sum::<f64>()
        };
        (y - RADIUS..).zip(kernel).map(|(y, weight)| weight * row(reflected(y, size[1]))).sum()
    }
}

/// Weights of the Gaussian along an axis, whose sum is 1.
type Kernel = [f64; 2 * RADIUS as usize + 1];

fn kernel() -> Kernel {
    let weights: Kernel =
        std::array::from_fn(|at| (-0.5 * ((at as f64 - RADIUS as f64) / DEVIATION).powi(2)).exp());
    let total: f64 = weights.iter().sum();
    weights.map(|weight| weight / total)
}

/// Returns the cell within `0..side` that a reflection at the borders shows at `at`.
fn reflected(at: i64, side: i64) -> i64 {
    let at = at.rem_euclid(2 * side);
    at.min(2 * side - 1 - at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gaussian(size: [usize; 2], centre: [f64; 2]) -> Vec<f32> {
        let score = |x: usize, y: usize| {
            let square = (x as f64 - centre[0]).powi(2) + (y as f64 - centre[1]).powi(2);
            (-square / 8.0).exp() as f32
        };
        (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| score(x, y))).collect()
    }

    #[test]
    fn the_centre_of_a_gaussian_is_found() {
        let (size, centre) = ([24, 32], [10.3, 17.8]);
        let values = gaussian(size, centre);
        let heatmap = Heatmap { values: &values, size };
        let (peak, score) = heatmap.peak();
        assert_eq!((peak, heatmap.quarter(peak)), ([10, 18], [10.25, 17.75]));
        assert!(score > 0.95 && score < 1.0);
        let found = heatmap.paraboloid(peak);
        assert!(found.iter().zip(centre).all(|(found, centre)| (found - centre).abs() < 1e-3), "{found:?}");
    }

    #[test]
    fn borders_and_flat_maps_keep_the_peak() {
        let flat = Heatmap { values: &[0.5; 12], size: [4, 3] };
        assert_eq!((flat.peak(), flat.quarter([0, 0])), (([0, 0], 0.5), [0.0, 0.0]));
        assert_eq!(flat.paraboloid([0, 0]), [0.0, 0.0]);
        let none = Heatmap { values: &[f32::NAN; 12], size: [4, 3] };
        assert_eq!(none.peak(), ([0, 0], f32::NEG_INFINITY));
        assert_eq!(none.paraboloid([3, 2]), [3.0, 2.0]);
    }

    #[test]
    fn cells_are_reflected_with_the_border_itself() {
        let found: Vec<i64> = (-4..7).map(|at| reflected(at, 3)).collect();
        assert_eq!(found, [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(reflected(-5, 1), 0);
    }
}
