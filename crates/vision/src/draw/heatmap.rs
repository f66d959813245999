//! Drawing of class maps and score maps over an image.

use opendr_engine::data::Image;
use opendr_engine::target::{Heatmap, HeatmapValues};

use crate::draw::canvas::Canvas;
use crate::draw::colour_map::heat_colours;
use crate::draw::label::draw_chip;
use crate::draw::palette::{Colour, colour_of_index};
use crate::draw::style::Style;
use crate::draw::text::Text;

/// Maximum number of classes with a legend.
const MAX_LEGEND: usize = 24;

/// Draws a map over the whole of `image`, which is converted to RGB `u8` where needed.
///
/// Class indices (`[height, width]`) are drawn in the colours of their classes, with a legend of the named ones;
/// class 0 is transparent when it is called `background` or has no name. Scores (`[height, width]`) range from
/// transparent violet for the lowest to yellow for the highest. Of scores of several classes
/// (`[classes, height, width]`), the best class of each cell is drawn, more transparent the lower its score. A map of
/// another shape is not drawn.
pub fn draw_heatmap(image: &mut Image, map: &Heatmap, style: &Style) {
    let (planes, height, width) = match *map.shape() {
        [height, width] => (1, height, width),
        [planes, height, width] => (planes, height, width),
        _ => return,
    };
    if planes * height * width == 0 {
        return;
    }
    let mut canvas = Canvas::over(image);
    let grid = Grid::new(width, height, &canvas);
    match map.values() {
        HeatmapValues::Labels(labels) if planes == 1 => {
            let seen = draw_labels(&mut canvas, labels, &grid, map, style);
            draw_legend(&mut canvas, map, &seen, style);
        }
        HeatmapValues::Labels(_) => {}
        HeatmapValues::Scores(scores) if planes == 1 => draw_scores(&mut canvas, scores, &grid, style),
        HeatmapValues::Scores(scores) => draw_class_scores(&mut canvas, scores, width * height, &grid, style),
    }
}

/// The mapping from the pixels of a canvas to the cells of a map.
struct Grid {
    width: usize,
    columns: Vec<Places>,
    rows: Vec<Places>,
}

/// The cells along one axis for a pixel: the nearest, and the two around it with the weight of the second.
#[derive(Clone, Copy)]
struct Places {
    nearest: usize,
    around: [usize; 2],
    share: f32,
}

impl Grid {
    /// The caller guarantees that no side is 0.
    fn new(width: usize, height: usize, canvas: &Canvas<'_>) -> Self {
        let axis = |places: usize, pixels: usize| {
            let places_of = |at: usize| {
                let middle =
                    ((at as f32 + 0.5) * places as f32 / pixels as f32 - 0.5).clamp(0.0, (places - 1) as f32);
                let first = (middle as usize).min(places - 1);
                let around = [first, (first + 1).min(places - 1)];
                Places { nearest: at * places / pixels, around, share: middle.fract() }
            };
            (0..pixels).map(places_of).collect()
        };
        Self { width, columns: axis(width, canvas.width()), rows: axis(height, canvas.height()) }
    }

    /// Returns every pixel with the index of the nearest cell.
    fn nearest(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        self.rows.iter().enumerate().flat_map(move |(y, row)| {
            let start = row.nearest * self.width;
            self.columns.iter().enumerate().map(move |(x, column)| (x, y, start + column.nearest))
        })
    }

    /// Returns every pixel with the label of the largest weight among the four cells around, so that the edges of
    /// coarse maps are smooth. The caller guarantees a label for every cell.
    fn winners(&self, labels: &[u32]) -> impl Iterator<Item = (usize, usize, u32)> {
        self.rows.iter().enumerate().flat_map(move |(y, row)| {
            let [upper, lower] = row.around.map(|place| &labels[place * self.width..][..self.width]);
            self.columns.iter().enumerate().map(move |(x, Places { around: [left, right], share, .. })| {
                let four = [upper[*left], upper[*right], lower[*left], lower[*right]];
                (x, y, winner(four, *share, row.share))
            })
        })
    }

    /// Returns every pixel with its interpolated score. The caller guarantees a score for every cell.
    fn blended(&self, scores: &[f32]) -> impl Iterator<Item = (usize, usize, f32)> {
        self.rows.iter().enumerate().flat_map(move |(y, row)| {
            let [upper, lower] = row.around.map(|place| &scores[place * self.width..][..self.width]);
            self.columns.iter().enumerate().map(move |(x, Places { around: [left, right], share, .. })| {
                let along = |row: &[f32]| row[*left] + (row[*right] - row[*left]) * share;
                (x, y, along(upper) + (along(lower) - along(upper)) * row.share)
            })
        })
    }
}

/// Returns the label of the largest weight among four: two above, two below, with the weights of the right and the
/// lower ones.
fn winner(four: [u32; 4], right: f32, lower: f32) -> u32 {
    let [first, ..] = four;
    if four.iter().all(|label| *label == first) {
        return first;
    }
    let (left, upper) = (1.0 - right, 1.0 - lower);
    let weights = [left * upper, right * upper, left * lower, right * lower];
    let weight = |label: u32| -> f32 {
        four.iter().zip(weights).filter(|(other, _)| **other == label).map(|(_, weight)| weight).sum()
    };
    four.into_iter().max_by(|a, b| weight(*a).total_cmp(&weight(*b))).unwrap_or(first)
}

/// Draws class indices; returns which of the named classes occur.
fn draw_labels(
    canvas: &mut Canvas<'_>,
    labels: &[u32],
    grid: &Grid,
    map: &Heatmap,
    style: &Style,
) -> Vec<bool> {
    let clear = map.classes.name(0).is_none_or(|name| name.eq_ignore_ascii_case("background"));
    let mut seen = vec![false; map.classes.len()];
    let mut last: (u32, Colour) = (0, colour_of_index(0));
    for (x, y, label) in grid.winners(labels) {
        if label == 0 && clear {
            continue;
        }
        if last.0 != label {
            last = (label, colour_of_index(i64::from(label)));
        }
        if let Some(seen) = seen.get_mut(label as usize) {
            *seen = true;
        }
        canvas.blend(x, y, last.1, style.opacity);
    }
    seen
}

fn draw_legend(canvas: &mut Canvas<'_>, map: &Heatmap, seen: &[bool], style: &Style) {
    let classes: Vec<(usize, &str)> =
        map.classes.iter().enumerate().filter(|(class, _)| seen.get(*class) == Some(&true)).collect();
    if !style.labels || classes.len() > MAX_LEGEND {
        return;
    }
    let unit = style.letter_unit(canvas);
    let mut top = unit;
    for (class, name) in classes {
        let [_, height] =
            draw_chip(canvas, &Text::new(name, unit), [unit, top], colour_of_index(class as i64));
        top += height + unit;
    }
}

fn draw_scores(canvas: &mut Canvas<'_>, scores: &[f32], grid: &Grid, style: &Style) {
    let colours = heat_colours();
    let [low, high] = range(scores);
    let part = |score: &f32| if score.is_finite() { (score - low) / (high - low) } else { 0.0 };
    let parts: Vec<f32> = scores.iter().map(part).collect();
    for (x, y, part) in grid.blended(&parts) {
        let Some(colour) = colours.get((part * 255.0 + 0.5) as usize) else { continue };
        // Low scores are transparent; from a third of the range on, the opacity is the style's.
        canvas.blend(x, y, *colour, style.opacity * (part * 3.0).min(1.0));
    }
}

fn draw_class_scores(canvas: &mut Canvas<'_>, scores: &[f32], places: usize, grid: &Grid, style: &Style) {
    let [low, high] = range(scores);
    let mut best = vec![(0, low); places];
    for (class, plane) in (0..).zip(scores.chunks_exact(best.len())) {
        for (best, score) in best.iter_mut().zip(plane) {
            if *score > best.1 {
                *best = (class, *score);
            }
        }
    }
    for (x, y, place) in grid.nearest() {
        let (class, score) = best[place];
        canvas.blend(x, y, colour_of_index(class), style.opacity * ((score - low) / (high - low)).min(1.0));
    }
}

/// Returns the lower and upper end of the colour map: 0 and 1 for scores within them, otherwise the lowest and the
/// highest.
fn range(scores: &[f32]) -> [f32; 2] {
    let finite = scores.iter().copied().filter(|score| score.is_finite());
    let [low, high] =
        finite.fold([f32::MAX, f32::MIN], |[low, high], score| [low.min(score), high.max(score)]);
    if low >= 0.0 && high <= 1.0 || low >= high { [0.0, 1.0] } else { [low, high] }
}
