//! Encoding of persons to target maps.

use opendr_engine::target::Keypoint;

use super::{FIELDS, Grid, HEAT_MAPS, JOINTS, LIMBS};

/// Parameters of the target maps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapEncoder {
    /// Standard deviation of the Gaussian around a joint, in pixels of the network's input.
    pub sigma: f32,
    /// Half the width of a limb, in pixels of the network's input.
    pub limb_half_width: f32,
}

impl Default for MapEncoder {
    /// Returns Osokin's parameters: 7 pixels, and one cell of 8.
    fn default() -> Self {
        Self { sigma: 7.0, limb_half_width: 8.0 }
    }
}

/// Exponent of the Gaussian beyond which it is below 1 % and not painted.
const FADED: f32 = 4.6;

impl MapEncoder {
    /// Paints `persons`, in pixels of the network's input, into `heat` (`[19, rows, columns]`: the maximum of all persons'
    /// Gaussians per joint, and the background as the last map) and `fields` (`[38, rows, columns]`: unit vectors along
    /// limbs, their mean where several persons' overlap, Cao et al., Eq. 9). Previous values are overwritten; missing
    /// joints are skipped.
    ///
    /// Slices of other lengths are painted as far as they reach.
    pub fn encode(&self, grid: Grid, persons: &[[Keypoint; JOINTS]], heat: &mut [f32], fields: &mut [f32]) {
        let cells = grid.cells().max(1);
        heat.fill(0.0);
        fields.fill(0.0);
        for (joint, map) in heat.chunks_exact_mut(cells).take(JOINTS).enumerate() {
            for person in persons.iter().filter(|person| person[joint].is_detected()) {
                self.paint_joint(grid, person[joint], map);
            }
        }
        paint_background(heat, cells);
        let mut counts = vec![0u16; cells];
        for (maps, [from, to]) in fields.chunks_exact_mut(2 * cells).take(FIELDS / 2).zip(LIMBS) {
            let (x, y) = maps.split_at_mut(cells);
            counts.fill(0);
            for person in
                persons.iter().filter(|person| person[from].is_detected() && person[to].is_detected())
            {
                self.each_cell_of_limb(grid, [person[from], person[to]], |cell, [along_x, along_y]| {
                    x[cell] += along_x;
                    y[cell] += along_y;
                    counts[cell] = counts[cell].saturating_add(1);
                });
            }
            for (part, count) in x.iter_mut().chain(y).zip(counts.iter().chain(&counts)) {
                *part /= f32::from(*count).max(1.0);
            }
        }
    }

    fn paint_joint(&self, grid: Grid, joint: Keypoint, map: &mut [f32]) {
        let reach = self.sigma * (2.0 * FADED).sqrt();
        let [columns, rows] = cells_around(grid, [joint.x, joint.y], [joint.x, joint.y], reach);
        for row in rows {
            for column in columns.clone() {
                let [x, y] = grid.point_from_cell([column as f32, row as f32]);
                let squares = (x - joint.x).powi(2) + (y - joint.y).powi(2);
                let exponent = squares / (2.0 * self.sigma * self.sigma);
                if exponent <= FADED {
                    let value = &mut map[row * grid.columns + column];
                    *value = value.max((-exponent).exp());
                }
            }
        }
    }

    /// Calls `each` for the cells whose centres are at most half a width beside the limb, and half of that beyond its ends.
    fn each_cell_of_limb(
        &self,
        grid: Grid,
        [from, to]: [Keypoint; 2],
        mut each: impl FnMut(usize, [f32; 2]),
    ) {
        let way = [to.x - from.x, to.y - from.y];
        let length = way[0].hypot(way[1]);
        if !(length > 0.0 && length.is_finite()) {
            return;
        }
        let along = way.map(|part| part / length);
        let low = [from.x.min(to.x), from.y.min(to.y)];
        let high = [from.x.max(to.x), from.y.max(to.y)];
        let [columns, rows] = cells_around(grid, low, high, self.limb_half_width);
        for row in rows {
            for column in columns.clone() {
                let [x, y] = grid.point_from_cell([column as f32, row as f32]);
                let (x, y) = (x - from.x, y - from.y);
                let (ahead, aside) = (x * along[0] + y * along[1], x * along[1] - y * along[0]);
                let within = -self.limb_half_width / 2.0..=length + self.limb_half_width / 2.0;
                if aside.abs() <= self.limb_half_width && within.contains(&ahead) {
                    each(row * grid.columns + column, along);
                }
            }
        }
    }
}

/// Returns columns and rows of the cells within `reach` of a rectangle of pixels.
fn cells_around(grid: Grid, low: [f32; 2], high: [f32; 2], reach: f32) -> [std::ops::Range<usize>; 2] {
    let low = grid.cell_from_point(low.map(|edge| edge - reach));
    let high = grid.cell_from_point(high.map(|edge| edge + reach));
    // Casts saturate: values below 0 and NaN become 0.
    let range = |axis: usize, count: usize| {
        (low[axis].ceil() as usize).min(count)..((high[axis] + 1.0).floor() as usize).min(count)
    };
    [range(0, grid.columns), range(1, grid.rows)]
}

fn paint_background(heat: &mut [f32], cells: usize) {
    let (joints, background) = heat.split_at_mut(heat.len().min(JOINTS * cells));
    for map in joints.chunks_exact(cells) {
        background.iter_mut().zip(map).for_each(|(most, value)| *most = value.max(*most));
    }
    debug_assert!(background.is_empty() || HEAT_MAPS * cells == joints.len() + background.len());
    background.iter_mut().for_each(|most| *most = 1.0 - *most);
}
