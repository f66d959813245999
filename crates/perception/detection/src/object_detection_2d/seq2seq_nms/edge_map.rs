//! Binary edge maps of images.

use opendr_engine::Result;
use opendr_engine::data::ImageView;
use opendr_vision::{ChannelOrder, Preprocess};

/// The binary edges of an image as an integral image, so that the share of edges in a rectangle costs four look-ups. Its
/// memory is reused.
#[derive(Debug, Clone)]
pub struct EdgeMap {
    preprocess: Preprocess,
    size: [usize; 2],
    scale: [f32; 2],
    grey: Vec<u8>,
    line: Vec<i32>,
    smooth: Vec<i32>,
    /// Number of edge pixels left of and above each pixel corner, `[height + 1, width + 1]`.
    sums: Vec<u32>,
}

/// Threshold of edges: the magnitude of Scharr's filters, each clipped at 255, as in OpenDR.
const STRONG: i32 = 240;
/// Maximum of a gradient.
const MOST: i32 = 255;

impl Default for EdgeMap {
    fn default() -> Self {
        Self {
            preprocess: Preprocess::new(1, 1).order(ChannelOrder::Grey),
            size: [0; 2],
            scale: [0.0; 2],
            grey: Vec::new(),
            line: Vec::new(),
            smooth: Vec::new(),
            sums: Vec::new(),
        }
    }
}

impl EdgeMap {
    /// Computes the edges of an image, resized so that its longer side has at most `longest` pixels.
    ///
    /// # Errors
    /// As the pre-processing of images.
    pub fn compute(&mut self, view: ImageView<'_>, longest: usize) -> Result<()> {
        let full = [view.width(), view.height()];
        let by = (longest as f32 / full[0].max(full[1]).max(1) as f32).min(1.0);
        let [width, height] = full.map(|side| ((side as f32 * by).round() as usize).max(1));
        self.size = [width, height];
        self.scale = [width as f32 / full[0].max(1) as f32, height as f32 / full[1].max(1) as f32];
        let preprocess = self.preprocess.with_size(width, height);
        self.grey.resize(preprocess.len(), 0);
        preprocess.run_into(view, &mut self.grey)?;
        self.blur();
        self.sum_edges();
        Ok(())
    }

    /// Applies a 3x3 Gaussian, times 16.
    fn blur(&mut self) {
        let [width, height] = self.size;
        self.line.clear();
        for row in self.grey.chunks_exact(width) {
            let level = |x: usize| i32::from(row[x]);
            self.line.extend(
                (0..width).map(|x| level(x.saturating_sub(1)) + 2 * level(x) + level((x + 1).min(width - 1))),
            );
        }
        self.smooth.clear();
        for y in 0..height {
            let [above, here, below] =
                [y.saturating_sub(1), y, (y + 1).min(height - 1)].map(|y| &self.line[y * width..][..width]);
            let rows = above.iter().zip(here).zip(below);
            self.smooth.extend(rows.map(|((above, here), below)| above + 2 * here + below));
        }
    }

    fn sum_edges(&mut self) {
        let [width, height] = self.size;
        self.sums.clear();
        self.sums.resize((width + 1) * (height + 1), 0);
        for y in 0..height {
            let rows = [y.saturating_sub(1), y, (y + 1).min(height - 1)];
            let [above, here, below] = rows.map(|y| &self.smooth[y * width..][..width]);
            let mut in_row = 0;
            for x in 0..width {
                let (left, right) = (x.saturating_sub(1), (x + 1).min(width - 1));
                let across = 3 * (above[right] - above[left] + below[right] - below[left])
                    + 10 * (here[right] - here[left]);
                let down = 3 * (below[left] - above[left] + below[right] - above[right])
                    + 10 * (below[x] - above[x]);
                let [across, down] = [across, down].map(|gradient| (gradient.abs() / 16).min(MOST));
                in_row += u32::from(across * across + down * down > STRONG * STRONG);
                self.sums[(y + 1) * (width + 1) + x + 1] = self.sums[y * (width + 1) + x + 1] + in_row;
            }
        }
    }

    /// Computes the share of edges in each of `side` x `side` equal cells of the box `[x0, y0, x1, y1]`, in image pixels.
    /// There are no edges outside the image.
    pub fn cells_into(
        &self,
        corners: [f32; 4],
        side: usize,
        corner_sums: &mut Vec<f32>,
        cells: &mut Vec<f32>,
    ) {
        let [x0, y0, x1, y1] = corners;
        let step = [(x1 - x0) * self.scale[0] / side as f32, (y1 - y0) * self.scale[1] / side as f32];
        let first = [x0 * self.scale[0], y0 * self.scale[1]];
        let area = (step[0] * step[1]).max(f32::MIN_POSITIVE);
        corner_sums.clear();
        for row in 0..=side {
            let y = first[1] + row as f32 * step[1];
            corner_sums.extend((0..=side).map(|column| self.sum_at(first[0] + column as f32 * step[0], y)));
        }
        cells.clear();
        for (above, below) in
            corner_sums.chunks_exact(side + 1).zip(corner_sums[side + 1..].chunks_exact(side + 1))
        {
            let sums = above.windows(2).zip(below.windows(2));
            cells.extend(
                sums.map(|(above, below)| {
                    ((below[1] - below[0] - above[1] + above[0]) / area).clamp(0.0, 1.0)
                }),
            );
        }
    }

    /// Returns the number of edge pixels left of and above a point, interpolated between pixels.
    fn sum_at(&self, x: f32, y: f32) -> f32 {
        let [width, height] = self.size;
        let (x, y) = (x.clamp(0.0, width as f32), y.clamp(0.0, height as f32));
        let (column, row) = ((x as usize).min(width - 1), (y as usize).min(height - 1));
        let (right, down) = (x - column as f32, y - row as f32);
        let at = row * (width + 1) + column;
        let [left_above, right_above, left_below, right_below] =
            [at, at + 1, at + width + 1, at + width + 2].map(|at| self.sums[at] as f32);
        let above = left_above + (right_above - left_above) * right;
        above + (left_below + (right_below - left_below) * right - above) * down
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::Image;

    use super::*;

    /// Returns the edges of an image that is dark on the left and bright on the right.
    fn halves(width: usize) -> EdgeMap {
        let levels =
            (0..width * 40).flat_map(|at| [if at % width < width / 2 { 0 } else { 255 }; 3]).collect();
        let mut map = EdgeMap::default();
        map.compute(Image::from_rgb8(levels, width, 40).unwrap().view(), 80).unwrap();
        map
    }

    fn cells(map: &EdgeMap, corners: [f32; 4], side: usize) -> Vec<f32> {
        let mut cells = Vec::new();
        map.cells_into(corners, side, &mut Vec::new(), &mut cells);
        cells
    }

    #[test]
    fn an_edge_is_where_brightness_changes() {
        // Four columns of pixels respond to the step through both filters.
        let shares = cells(&halves(80), [0.0, 0.0, 80.0, 40.0], 4);
        assert_eq!(shares.len(), 16);
        for row in shares.chunks_exact(4) {
            assert!(row[0] == 0.0 && row[3] == 0.0, "{row:?}");
            assert!((row[1] - 0.1).abs() < 0.06 && (row[2] - row[1]).abs() < 0.01, "{row:?}");
        }
        assert!(cells(&halves(80), [0.0, 0.0, 30.0, 40.0], 4).iter().all(|share| *share == 0.0));
    }

    #[test]
    fn boxes_are_in_image_pixels_at_any_map_size() {
        let (small, large) = (halves(80), halves(160));
        assert_eq!(large.size, [80, 20]);
        let near = |corners: [f32; 4], map: &EdgeMap| cells(map, corners, 1)[0] > 0.0;
        assert!(near([36.0, 0.0, 44.0, 40.0], &small) && near([76.0, 0.0, 84.0, 40.0], &large));
        assert!(!near([36.0, 0.0, 44.0, 40.0], &large));
    }

    #[test]
    fn boxes_outside_have_no_edges() {
        let map = halves(80);
        for corners in [[-50.0, -50.0, -10.0, -10.0], [500.0, 0.0, 600.0, 40.0], [40.0, 20.0, 40.0, 20.0]] {
            assert!(cells(&map, corners, 3).iter().all(|share| *share == 0.0), "{corners:?}");
        }
    }
}
