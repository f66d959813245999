//! FMoD: descriptors of regions by frequency moments of their edges.
//!
//! Nikitidis et al.'s frame moments descriptor as Symeonidis et al. use it: a pyramid of patches, each with the statistics
//! of the means of its rows, of the means of its columns, and of all its cells.

use super::edge_map::EdgeMap;

/// Number of statistics of a patch: mean, deviation, skewness, kurtosis and power of rows, columns and cells.
const PATCH_STATISTICS: usize = 15;

/// Descriptor of boxes in an image.
#[derive(Debug, Clone, Copy)]
pub struct Moments {
    /// Number of cells along each side of a box.
    pub side: usize,
    /// Number of levels of the pyramid: 1, 4, 16 patches, and so on.
    pub levels: u32,
}

/// Work memory of [`Moments::describe`].
#[derive(Debug, Clone, Default)]
pub struct MomentsScratch {
    corner_sums: Vec<f32>,
    cells: Vec<f32>,
    patch: Vec<f32>,
    rows: Vec<f32>,
    columns: Vec<f32>,
}

impl Moments {
    /// Returns the number of values per box.
    pub fn len(&self) -> usize {
        (0..self.levels).map(|level| PATCH_STATISTICS << (2 * level)).sum()
    }

    /// Appends [`len`](Self::len) values for the box `[x0, y0, x1, y1]`, in image pixels. Skewness and kurtosis are 0
    /// without variance; their inverse hyperbolic sine is stored, which limits outliers.
    pub fn describe(
        &self,
        map: &EdgeMap,
        corners: [f32; 4],
        scratch: &mut MomentsScratch,
        description: &mut Vec<f32>,
    ) {
        let MomentsScratch { corner_sums, cells, patch, rows, columns } = scratch;
        map.cells_into(corners, self.side, corner_sums, cells);
        for level in 0..self.levels {
            let patches = 1 << level;
            let side = self.side / patches;
            for (down, across) in (0..patches).flat_map(|down| (0..patches).map(move |across| (down, across)))
            {
                patch.clear();
                for row in 0..side {
                    let begin = (down * side + row) * self.side + across * side;
                    patch.extend_from_slice(&cells[begin..begin + side]);
                }
                rows.clear();
                rows.extend(patch.chunks_exact(side).map(|row| row.iter().sum::<f32>() / side as f32));
                columns.clear();
                columns.resize(side, 0.0);
                for row in patch.chunks_exact(side) {
                    columns.iter_mut().zip(row).for_each(|(column, cell)| *column += cell / side as f32);
                }
                for values in [&*rows, &*columns, &*patch] {
                    description.extend(statistics(values));
                }
            }
        }
    }
}

/// Returns mean, standard deviation, skewness, excess kurtosis and power.
fn statistics(values: &[f32]) -> [f32; 5] {
    let count = values.len().max(1) as f32;
    let mean = values.iter().sum::<f32>() / count;
    let [mut second, mut third, mut fourth, mut power] = [0.0; 4];
    for value in values {
        let apart = value - mean;
        let square = apart * apart;
        second += square;
        third += square * apart;
        fourth += square * square;
        power += value * value;
    }
    let variance = second / count;
    // Rounding errors of equal values are no variance.
    if variance < 1e-9 {
        return [mean, 0.0, 0.0, 0.0, power / count];
    }
    let skewness = third / count / (variance * variance.sqrt());
    let kurtosis = fourth / count / (variance * variance) - 3.0;
    [mean, variance.sqrt(), skewness.asinh(), kurtosis.asinh(), power / count]
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::Image;

    use super::*;

    #[test]
    fn statistics_by_hand() {
        // 0, 0, 0, 1: mean 1/4, variance 3/16, skewness 2 / sqrt 3, kurtosis 7/3 - 3.
        let [mean, deviation, skewness, kurtosis, power] = statistics(&[0.0, 0.0, 0.0, 1.0]);
        let near = |got: f32, wanted: f32| assert!((got - wanted).abs() < 1e-5, "{got} {wanted}");
        near(mean, 0.25);
        near(deviation, 3f32.sqrt() / 4.0);
        near(skewness, (2.0 / 3f32.sqrt()).asinh());
        near(kurtosis, (7.0 / 3.0 - 3.0f32).asinh());
        near(power, 0.25);
        assert_eq!(statistics(&[0.5; 4]), [0.5, 0.0, 0.0, 0.0, 0.25]);
        assert_eq!(statistics(&[]), [0.0; 5]);
    }

    #[test]
    fn patches_have_their_own_statistics() {
        // Stripes in the upper left quarter only.
        let level = |at: usize| if at % 64 < 32 && at / 64 < 32 && at % 8 < 4 { 255 } else { 0 };
        let levels = (0..64 * 64).flat_map(|at| [level(at); 3]).collect();
        let mut map = EdgeMap::default();
        map.compute(Image::from_rgb8(levels, 64, 64).unwrap().view(), 64).unwrap();
        let moments = Moments { side: 16, levels: 2 };
        let mut description = Vec::new();
        moments.describe(&map, [0.0, 0.0, 64.0, 64.0], &mut MomentsScratch::default(), &mut description);
        assert_eq!(description.len(), moments.len());
        assert_eq!(moments.len(), 15 + 60);
        assert!(description.iter().all(|number| number.is_finite()));
        // Means over the cells of the four patches.
        let means: Vec<_> = description[15..].chunks_exact(15).map(|patch| patch[10]).collect();
        assert!(means[0] > 0.5 && means[3] == 0.0 && means[1] < 0.2, "{means:?}");
    }
}
