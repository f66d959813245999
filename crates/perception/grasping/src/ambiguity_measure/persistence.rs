//! Peaks of a map and their topological persistence.
//!
//! H. Edelsbrunner, D. Letscher, A. Zomorodian, "Topological persistence and simplification", 2002: as a level falls from the
//! highest value, components arise at peaks; where two meet, the component of the lower peak ends.

/// A peak of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Index of its pixel, row-major.
    pub at: usize,
    /// Value of the pixel.
    pub value: f32,
    /// Difference between the value and the level at which its component joins a higher one; for the highest peak, its value.
    pub persistence: f32,
}

/// Computes peaks; buffers are reused.
#[derive(Debug, Default)]
pub struct Persistence {
    order: Vec<u32>,
    /// Pixel towards the peak of the component; [`BELOW_LEVEL`] for pixels below the level.
    parents: Vec<u32>,
    ranks: Vec<u32>,
}

const BELOW_LEVEL: u32 = u32::MAX;

impl Persistence {
    /// Writes all peaks of a map of finite values, `width` per row, sorted by persistence. Diagonal pixels are neighbours; of
    /// equal values the first, row-major, is higher.
    pub fn peaks(&mut self, map: &[f32], width: usize, peaks: &mut Vec<Peak>) {
        peaks.clear();
        let Self { order, parents, ranks } = self;
        let height = map.len().checked_div(width).unwrap_or_default();
        order.clear();
        order.extend(0..map.len() as u32);
        order.sort_unstable_by(|one, other| {
            map[*other as usize].total_cmp(&map[*one as usize]).then(one.cmp(other))
        });
        parents.clear();
        parents.resize(map.len(), BELOW_LEVEL);
        ranks.clear();
        ranks.resize(map.len(), 0);
        for (rank, at) in (0..).zip(order.iter()) {
            ranks[*at as usize] = rank;
        }
        for at in order.iter().map(|at| *at as usize) {
            parents[at] = at as u32;
            let (x, y) = (at % width, at / width);
            for row in y.saturating_sub(1)..(y + 2).min(height) {
                for column in x.saturating_sub(1)..(x + 2).min(width) {
                    let other = row * width + column;
                    if other == at || parents[other] == BELOW_LEVEL {
                        continue;
                    }
                    let (mine, theirs) = (top(parents, at), top(parents, other));
                    if mine == theirs {
                        continue;
                    }
                    // The component of the lower peak ends here.
                    let (low, high) =
                        if ranks[mine] > ranks[theirs] { (mine, theirs) } else { (theirs, mine) };
                    parents[low] = high as u32;
                    if low != at {
                        peaks.push(Peak { at: low, value: map[low], persistence: map[low] - map[at] });
                    }
                }
            }
        }
        if let Some(highest) = order.first().map(|at| *at as usize) {
            peaks.push(Peak { at: highest, value: map[highest], persistence: map[highest] });
        }
        let rank = |peak: &Peak| ranks[peak.at];
        peaks.sort_by(|one, other| {
            let by_persistence = other.persistence.total_cmp(&one.persistence);
            // The highest peak comes first, even where values are below 0.
            (rank(one) != 0).cmp(&(rank(other) != 0)).then(by_persistence).then(rank(one).cmp(&rank(other)))
        });
    }
}

/// Returns the peak of a pixel's component, with path compression.
fn top(parents: &mut [u32], mut at: usize) -> usize {
    while parents[at] as usize != at {
        parents[at] = parents[parents[at] as usize];
        at = parents[at] as usize;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    fn peaks(map: &[f32], width: usize) -> Vec<(usize, f32, f32)> {
        let mut peaks = Vec::new();
        Persistence::default().peaks(map, width, &mut peaks);
        peaks.iter().map(|peak| (peak.at, peak.value, peak.persistence)).collect()
    }

    #[test]
    fn the_lower_component_ends_at_the_saddle() {
        assert_eq!(peaks(&[1.0, 5.0, 2.0, 4.0, 0.0, 3.0], 6), [(1, 5.0, 5.0), (5, 3.0, 3.0), (3, 4.0, 2.0)]);
        // Diagonal pixels are connected.
        assert_eq!(peaks(&[5.0, 0.0, 0.0, 4.0], 2), [(0, 5.0, 5.0)]);
        assert_eq!(peaks(&[-3.0, -5.0, -4.0], 3), [(0, -3.0, -3.0), (2, -4.0, 1.0)]);
    }

    #[test]
    fn a_plateau_has_one_peak() {
        assert_eq!(peaks(&[2.0; 12], 4), [(0, 2.0, 2.0)]);
        assert_eq!(peaks(&[2.0, 0.0, 2.0], 3), [(0, 2.0, 2.0), (2, 2.0, 2.0)]);
        assert_eq!(peaks(&[], 0), []);
    }
}
