//! Text boxes of the probability map of a text detector with differentiable binarisation (DB).

use super::rectangle::{Pixel, Rectangle, convex_hull};

/// A region with a shorter side is no candidate, in pixels of the map.
const MIN_SIDE: f64 = 3.0;
/// A grown box with a shorter side is dropped, in pixels of the map.
const MIN_GROWN_SIDE: f64 = 5.0;
/// Maps with a longer side have no boxes: up to it, pixels are exact in `f32` and products of them in `i64`.
const MAX_MAP_SIDE: usize = 1 << 24;

/// A box of text: a rotated rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextBox {
    /// The corners in pixels of the map, clockwise from the top left of the text. The centre of the first pixel is (0, 0). They may lie
    /// outside of the map.
    pub corners: [[f32; 2]; 4],
    /// The mean probability inside of the box before its growth.
    pub score: f32,
}

/// The parameters of [`Regions::find`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegionParams {
    /// Pixels with a higher probability are text.
    pub threshold: f32,
    /// Boxes with a lower score are dropped.
    pub box_threshold: f32,
    /// Boxes grow on each side by their area times this, divided by their perimeter.
    pub unclip_ratio: f32,
    /// The largest number of regions that are scored, from the top of the map. Those with a short side below 3 pixels do not count.
    pub max_candidates: usize,
}

impl Default for RegionParams {
    /// The defaults of PaddleOCR.
    fn default() -> Self {
        Self { threshold: 0.3, box_threshold: 0.6, unclip_ratio: 1.5, max_candidates: 1000 }
    }
}

/// Neighbouring pixels of text in one row.
#[derive(Debug, Clone, Copy)]
struct Run {
    row: u32,
    first: u32,
    last: u32,
    /// An earlier run of the same region, or this run.
    parent: u32,
}

/// Finds text boxes. It keeps its work memory, so that further maps of the same size allocate nothing.
#[derive(Debug, Clone, Default)]
pub struct Regions {
    runs: Vec<Run>,
    /// The region of each run.
    labels: Vec<u32>,
    /// Where the runs of each region begin in `members`, and where those of the last one end.
    starts: Vec<usize>,
    /// The runs, by region and then by row and column.
    members: Vec<u32>,
    points: Vec<Pixel>,
    hull: Vec<Pixel>,
    /// The first and last column inside of a polygon, by row.
    spans: Vec<[i64; 2]>,
}

impl Regions {
    /// Writes the text boxes of a map of `height` rows of `width` probabilities to `boxes`, in the order of the first pixel of their
    /// regions by row and column. Regions are 8-connected, and holes in them make no boxes of their own. A map with fewer values than
    /// `width` times `height` has no boxes.
    pub fn find(
        &mut self,
        map: &[f32],
        width: usize,
        height: usize,
        params: &RegionParams,
        boxes: &mut Vec<TextBox>,
    ) {
        boxes.clear();
        let Some(map) = Map::new(map, width, height) else { return };
        self.collect_runs(&map, params.threshold);
        self.group_runs();
        let mut candidates = 0;
        for region in 0..self.starts.len() - 1 {
            let Some(rectangle) = self.rectangle(region) else { continue };
            if rectangle.short_side() < MIN_SIDE {
                continue;
            }
            if candidates == params.max_candidates {
                break;
            }
            candidates += 1;
            boxes.extend(map.text_box(&rectangle, params, &mut self.spans));
        }
    }

    fn collect_runs(&mut self, map: &Map<'_>, threshold: f32) {
        self.runs.clear();
        let mut above = 0;
        for (row, values) in map.values.chunks_exact(map.width).enumerate() {
            let begin = self.runs.len();
            let mut column = 0;
            while let Some(skipped) = first_above(&values[column..], threshold) {
                let first = column + skipped;
                let rest = &values[first..];
                let length =
                    rest.iter().position(|&value| value.is_nan() || value <= threshold).unwrap_or(rest.len());
                column = first + length;
                let parent = self.runs.len() as u32;
                self.runs.push(Run {
                    row: row as u32,
                    first: first as u32,
                    last: (column - 1) as u32,
                    parent,
                });
            }
            self.join_rows(above, begin);
            above = begin;
        }
    }

    /// Joins the runs of a row, from `below` on, with the ones they touch of the row before, from `above` on.
    fn join_rows(&mut self, mut above: usize, below: usize) {
        let end = self.runs.len();
        let mut lower = below;
        while above < below && lower < end {
            let (a, b) = (self.runs[above], self.runs[lower]);
            if a.first <= b.last + 1 && b.first <= a.last + 1 {
                self.join(above as u32, lower as u32);
            }
            if a.last < b.last {
                above += 1;
            } else {
                lower += 1;
            }
        }
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.runs[a.max(b) as usize].parent = a.min(b);
    }

    /// The first run of the region of a run.
    fn root(&mut self, mut run: u32) -> u32 {
        loop {
            let parent = self.runs[run as usize].parent;
            if parent == run {
                return run;
            }
            let grandparent = self.runs[parent as usize].parent;
            self.runs[run as usize].parent = grandparent;
            run = grandparent;
        }
    }

    /// Sorts the runs by region: counts those of each region, then places them.
    fn group_runs(&mut self) {
        self.labels.clear();
        self.starts.clear();
        self.starts.push(0);
        for run in 0..self.runs.len() as u32 {
            let root = self.root(run);
            let label = if root == run {
                self.starts.push(0);
                self.starts.len() as u32 - 2
            } else {
                self.labels[root as usize]
            };
            self.labels.push(label);
            self.starts[label as usize] += 1;
        }
        let mut end = 0;
        for start in &mut self.starts {
            end += *start;
            *start = end;
        }
        self.members.clear();
        self.members.resize(self.runs.len(), 0);
        for (run, &label) in self.labels.iter().enumerate().rev() {
            self.starts[label as usize] -= 1;
            self.members[self.starts[label as usize]] = run as u32;
        }
    }

    /// The rectangle of least area around the pixels of a region.
    fn rectangle(&mut self, region: usize) -> Option<Rectangle> {
        self.points.clear();
        for &run in &self.members[self.starts[region]..self.starts[region + 1]] {
            let Run { row, first, last, .. } = self.runs[run as usize];
            self.points.push([first.into(), row.into()]);
            if last != first {
                self.points.push([last.into(), row.into()]);
            }
        }
        convex_hull(&self.points, &mut self.hull);
        Rectangle::around(&self.hull)
    }
}

/// A probability map.
struct Map<'a> {
    values: &'a [f32],
    width: usize,
    height: usize,
}

impl<'a> Map<'a> {
    fn new(values: &'a [f32], width: usize, height: usize) -> Option<Self> {
        if width == 0 || height == 0 || width.max(height) > MAX_MAP_SIDE {
            return None;
        }
        let count = width.checked_mul(height).filter(|&count| u32::try_from(count).is_ok())?;
        Some(Self { values: values.get(..count)?, width, height })
    }

    /// The grown box of a candidate, if its score and size suffice.
    fn text_box(
        &self,
        rectangle: &Rectangle,
        params: &RegionParams,
        spans: &mut Vec<[i64; 2]>,
    ) -> Option<TextBox> {
        let score = self.mean_inside(&rectangle.corners(), spans);
        if !(score.is_finite() && score >= params.box_threshold) {
            return None;
        }
        let distance = rectangle.area() * f64::from(params.unclip_ratio) / rectangle.perimeter();
        let grown = rectangle.grown(distance);
        if !(distance.is_finite() && grown.short_side() >= MIN_GROWN_SIDE) {
            return None;
        }
        Some(TextBox { corners: grown.corners().map(|corner| corner.map(|value| value as f32)), score })
    }

    /// The mean of the map inside of a convex quadrilateral with corners cut to whole pixels, the pixels of its outline included.
    fn mean_inside(&self, corners: &[[f64; 2]; 4], spans: &mut Vec<[i64; 2]>) -> f32 {
        // Through `f32`, so that whole pixels are not just below their number.
        let corners = corners.map(|corner| corner.map(|value| f64::from(value as f32)));
        let [left, right] = bounds(corners.map(|corner| corner[0]), self.width);
        let [top, bottom] = bounds(corners.map(|corner| corner[1]), self.height);
        spans.clear();
        spans.resize((bottom - top + 1) as usize, [i64::MAX, i64::MIN]);
        let pixels = corners.map(|[x, y]| [(x - left as f64) as i64, (y - top as f64) as i64]);
        for side in 0..4 {
            cover_line(spans, pixels[side], pixels[(side + 1) % 4]);
        }
        let (mut sum, mut count) = (0.0, 0);
        let rows = self.values.chunks_exact(self.width).skip(top as usize);
        for (row, [first, last]) in rows.zip(spans.iter()) {
            let (first, last) = ((*first).max(0), (*last).min(right - left));
            if first <= last {
                let values = &row[(left + first) as usize..=(left + last) as usize];
                sum += f64::from(sum_of(values));
                count += values.len();
            }
        }
        if count == 0 { 0.0 } else { (sum / count as f64) as f32 }
    }
}

/// The first and last whole pixel around coordinates, inside of `0..size`.
fn bounds(values: [f64; 4], size: usize) -> [i64; 2] {
    let least = values.into_iter().fold(f64::INFINITY, f64::min);
    let most = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
    [least.floor(), most.ceil()].map(|value| (value as i64).clamp(0, size as i64 - 1))
}

/// Extends the spans of the rows by the pixels of a line. Half pixels belong to its left end, as in OpenCV.
fn cover_line(spans: &mut [[i64; 2]], a: Pixel, b: Pixel) {
    let (from, to) = if a[0] <= b[0] { (a, b) } else { (b, a) };
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let steps = dx.max(dy.abs());
    for step in 0..=steps {
        let at = |length: i64| half_down(length * step, steps.max(1));
        let (x, y) = (from[0] + at(dx), from[1] + at(dy.abs()) * dy.signum());
        if let Some([first, last]) = usize::try_from(y).ok().and_then(|row| spans.get_mut(row)) {
            *first = (*first).min(x);
            *last = (*last).max(x);
        }
    }
}

/// A ratio rounded to the nearest whole number, halves down. The divisor is positive.
fn half_down(value: i64, divisor: i64) -> i64 {
    (2 * value + divisor - 1).div_euclid(2 * divisor)
}

/// The index of the first value above a threshold.
fn first_above(values: &[f32], threshold: f32) -> Option<usize> {
    const WIDTH: usize = 32;
    let mut skipped = 0;
    for chunk in values.chunks_exact(WIDTH) {
        if chunk.iter().fold(false, |any, &value| any | (value > threshold)) {
            break;
        }
        skipped += WIDTH;
    }
    values[skipped..].iter().position(|&value| value > threshold).map(|index| skipped + index)
}

/// The sum, in eight interleaved parts.
fn sum_of(values: &[f32]) -> f32 {
    let mut parts = [0.0; 8];
    let chunks = values.chunks_exact(8);
    let rest: f32 = chunks.remainder().iter().sum();
    for chunk in chunks {
        for (part, value) in parts.iter_mut().zip(chunk) {
            *part += value;
        }
    }
    parts.iter().sum::<f32>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 64;
    const HEIGHT: usize = 48;

    fn map_of(text: impl Fn(usize, usize) -> bool) -> Vec<f32> {
        (0..WIDTH * HEIGHT).map(|index| if text(index % WIDTH, index / WIDTH) { 0.9 } else { 0.1 }).collect()
    }

    fn find(map: &[f32], params: RegionParams) -> Vec<TextBox> {
        let mut boxes = Vec::new();
        Regions::default().find(map, WIDTH, HEIGHT, &params, &mut boxes);
        boxes
    }

    fn inside(x: usize, y: usize, columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) -> bool {
        columns.contains(&x) && rows.contains(&y)
    }

    #[test]
    fn upright_region_grows_by_the_ratio() {
        // 20 x 10 between the centres of the outer pixels: distance 200 * 1.5 / 60 = 5.
        let boxes = find(&map_of(|x, y| inside(x, y, 20..41, 15..26)), RegionParams::default());
        assert_eq!(boxes.len(), 1);
        assert_eq!(boxes[0].corners, [[15.0, 10.0], [45.0, 10.0], [45.0, 30.0], [15.0, 30.0]]);
        assert!((boxes[0].score - 0.9).abs() < 1e-6);
    }

    #[test]
    fn tilted_region_keeps_its_angle() {
        // |x - y| <= 6 and 40 <= x + y <= 70: sides along the diagonals.
        let boxes =
            find(&map_of(|x, y| x.abs_diff(y) <= 6 && (40..=70).contains(&(x + y))), RegionParams::default());
        assert_eq!(boxes.len(), 1);
        let [a, b, c, _] = boxes[0].corners;
        let length = |p: [f32; 2], q: [f32; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
        let distance = 15.0 * 6.0 * 1.5 / (15.0 + 6.0) / 2.0_f32.sqrt() * 2.0;
        let sides = [length(a, b), length(b, c)];
        assert!(
            (sides[0] + sides[1] - 42.0 / 2.0_f32.sqrt() - 2.0 * distance).abs() < 1e-3,
            "{sides:?} {distance}"
        );
    }

    #[test]
    fn neighbours_on_diagonals_are_one_region_and_holes_are_none() {
        let diagonal = map_of(|x, y| inside(x, y, 5..15, 5..15) || inside(x, y, 15..25, 15..25));
        let low = RegionParams { box_threshold: 0.2, ..RegionParams::default() };
        assert_eq!(find(&diagonal, low).len(), 1);
        let ring = map_of(|x, y| inside(x, y, 5..45, 5..35) && !inside(x, y, 10..40, 10..30));
        assert_eq!(find(&ring, low).len(), 1);
        assert_eq!(find(&ring, RegionParams::default()).len(), 0, "the mean includes the hole");
    }

    #[test]
    fn branches_that_meet_late_are_one_region() {
        let comb = map_of(|x, y| (y < 40 && x % 4 < 2 && x < 60) || (40..44).contains(&y));
        assert_eq!(find(&comb, RegionParams { box_threshold: 0.1, ..RegionParams::default() }).len(), 1);
    }

    #[test]
    fn rows_in_between_separate_regions() {
        let map = map_of(|x, y| inside(x, y, 5..40, 5..15) || inside(x, y, 5..40, 16..26));
        let boxes = find(&map, RegionParams { unclip_ratio: 0.0, ..RegionParams::default() });
        assert_eq!(boxes.iter().map(|found| found.corners[0]).collect::<Vec<_>>(), [[5.0, 5.0], [5.0, 16.0]]);
    }

    #[test]
    fn limits_drop_boxes() {
        let thin = map_of(|x, y| inside(x, y, 5..40, 5..8));
        assert!(find(&thin, RegionParams::default()).is_empty());
        let small = map_of(|x, y| inside(x, y, 5..9, 5..9));
        assert!(find(&small, RegionParams { unclip_ratio: 1.0, ..RegionParams::default() }).is_empty());
        assert_eq!(find(&small, RegionParams { unclip_ratio: 2.0, ..RegionParams::default() }).len(), 1);
        let grid = map_of(|x, y| x % 16 < 8 && y % 16 < 8);
        assert_eq!(find(&grid, RegionParams::default()).len(), 12);
        assert_eq!(find(&grid, RegionParams { max_candidates: 5, ..RegionParams::default() }).len(), 5);
        assert!(find(&grid, RegionParams { box_threshold: 0.95, ..RegionParams::default() }).is_empty());
    }

    #[test]
    fn strange_maps_have_no_boxes() {
        for map in
            [vec![f32::NAN; WIDTH * HEIGHT], vec![f32::INFINITY; WIDTH * HEIGHT], vec![0.9; 5], Vec::new()]
        {
            assert!(find(&map, RegionParams::default()).is_empty());
        }
        let nan = RegionParams {
            threshold: f32::NAN,
            box_threshold: f32::NAN,
            unclip_ratio: f32::NAN,
            max_candidates: 9,
        };
        assert!(find(&vec![1.0; WIDTH * HEIGHT], nan).is_empty());
        assert!(
            find(
                &vec![1.0; WIDTH * HEIGHT],
                RegionParams { unclip_ratio: f32::NAN, ..RegionParams::default() }
            )
            .is_empty()
        );
        let mut boxes = vec![TextBox { corners: [[0.0; 2]; 4], score: 1.0 }];
        for (width, height) in [(0, 0), (0, 5), (5, 0), (usize::MAX, 2), (usize::MAX, usize::MAX)] {
            Regions::default().find(&[1.0; 10], width, height, &RegionParams::default(), &mut boxes);
            assert!(boxes.is_empty());
        }
        let mut holes = vec![1.0; WIDTH * HEIGHT];
        holes[20 * WIDTH + 20] = f32::NAN;
        assert!(find(&holes, RegionParams::default()).is_empty());
        assert_eq!(find(&vec![1.0; WIDTH * HEIGHT], RegionParams::default()).len(), 1);
    }

    #[test]
    fn lines_are_those_of_opencv() {
        let rows = |to: Pixel, height: usize| {
            let mut spans = vec![[i64::MAX, i64::MIN]; height];
            cover_line(&mut spans, to, [0, 0]);
            spans
        };
        assert_eq!(rows([10, 3], 4), [[0, 1], [2, 5], [6, 8], [9, 10]]);
        assert_eq!(rows([3, 4], 5), [[0, 0], [1, 1], [1, 1], [2, 2], [3, 3]]);
        assert_eq!(rows([0, 0], 1), [[0, 0]]);
        assert_eq!(rows([-4, 2], 1), [[0, 0]], "rows outside are left out");
    }

    #[test]
    fn work_memory_is_kept() {
        let map = map_of(|x, y| x % 16 < 8 && y % 16 < 8);
        let (mut regions, mut boxes) = (Regions::default(), Vec::new());
        regions.find(&map, WIDTH, HEIGHT, &RegionParams::default(), &mut boxes);
        let memory =
            |regions: &Regions| (regions.runs.as_ptr(), regions.members.as_ptr(), regions.hull.as_ptr());
        let (before, first) = (memory(&regions), boxes.clone());
        regions.find(&map, WIDTH, HEIGHT, &RegionParams::default(), &mut boxes);
        assert_eq!((memory(&regions), boxes), (before, first));
    }
}
