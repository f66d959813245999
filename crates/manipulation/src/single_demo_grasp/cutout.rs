//! The demonstrated object, cut out of its background.

use opendr_engine::{Error, Result};

use super::example::GraspExample;
use super::network::{SIDE, SQUARE};

/// An object with its outline.
#[derive(Debug, Clone)]
pub(super) struct Cutout {
    /// Red, green, blue, each times the coverage, and the coverage, `[4, SIDE, SIDE]`.
    pub planes: Vec<f32>,
    pub jaws: [[f32; 2]; 2],
    /// Colour of the background of the demonstration.
    pub background: [f32; 3],
}

/// Width of the border that shows the background, pixels.
const BORDER: usize = 4;
/// Least ratio of the difference of an object to those in the border.
const BORDER_NOISE: f32 = 1.5;
/// Least difference of an object from the background, of a level of 1.
const DIFFERENCE: f32 = 0.06;
/// Fewest pixels of an object.
const FEWEST: usize = 30;

impl Cutout {
    /// Cuts the object out that is between the jaws: what differs from the border of the image (Otsu, 1979), connected.
    ///
    /// # Errors
    /// `InvalidInput` where nothing between the jaws differs from the border.
    pub fn new(example: &GraspExample) -> Result<Self> {
        let levels = |at: usize| [0, 1, 2].map(|channel| example.planes[channel * SQUARE + at]);
        let background = border_colour(&example.planes);
        let difference: Vec<f32> = (0..SQUARE)
            .map(|at| {
                let pairs = levels(at).into_iter().zip(background);
                pairs.map(|(level, own)| (level - own) * (level - own)).sum::<f32>().sqrt()
            })
            .collect();
        // An object of several colours is darker and brighter than Otsu's threshold: what the free border does not have is object.
        let threshold = otsu(&difference).min(BORDER_NOISE * border_noise(&difference)).max(DIFFERENCE);
        let covered = connected(&difference, threshold, &example.jaws);
        if covered.iter().filter(|covered| **covered).count() < FEWEST {
            return Err(Error::invalid_input(
                "nothing between the jaws differs from the border of the image; demonstrate the object on a plain background of another colour, with a free border around it",
            ));
        }
        let mut planes = vec![0.0; 4 * SQUARE];
        for at in (0..SQUARE).filter(|at| covered[*at]) {
            for (channel, level) in levels(at).into_iter().enumerate() {
                planes[channel * SQUARE + at] = level;
            }
            planes[3 * SQUARE + at] = 1.0;
        }
        Ok(Self { planes, jaws: example.jaws, background })
    }
}

/// Returns the median of each channel over the border.
fn border_colour(planes: &[f32]) -> [f32; 3] {
    [0, 1, 2].map(|channel| border_quantile(&planes[channel * SQUARE..][..SQUARE], 0.5))
}

/// Returns the difference that hardly a pixel of the border exceeds.
fn border_noise(difference: &[f32]) -> f32 {
    border_quantile(difference, 0.99)
}

/// Returns a quantile of the values in the border of an image.
fn border_quantile(values: &[f32], share: f64) -> f32 {
    let inner = |part: usize| (BORDER..SIDE - BORDER).contains(&part);
    let is_border = |at: usize| !(inner(at % SIDE) && inner(at / SIDE));
    let mut levels: Vec<f32> = (0..SQUARE).filter(|at| is_border(*at)).map(|at| values[at]).collect();
    levels.sort_by(f32::total_cmp);
    levels[((levels.len() - 1) as f64 * share) as usize]
}

/// Returns the threshold between two classes of differences, with the largest variance between them.
fn otsu(difference: &[f32]) -> f32 {
    const BINS: usize = 128;
    let most = difference.iter().copied().fold(1e-6, f32::max);
    let mut counts = [0.0_f64; BINS];
    for value in difference {
        counts[((value / most * BINS as f32) as usize).min(BINS - 1)] += 1.0;
    }
    let total: f64 = counts.iter().sum();
    let all: f64 = counts.iter().zip(0..).map(|(count, bin)| count * f64::from(bin)).sum();
    let (mut below, mut sum, mut best) = (0.0, 0.0, (0.0, 0));
    for (count, bin) in counts.iter().zip(0..) {
        below += count;
        sum += count * f64::from(bin);
        let above = total - below;
        if below == 0.0 || above == 0.0 {
            continue;
        }
        let apart = sum / below - (all - sum) / above;
        let variance = below * above * apart * apart;
        if variance > best.0 {
            best = (variance, bin);
        }
    }
    most * (best.1 as f32 + 1.0) / BINS as f32
}

/// Returns the pixels over the threshold that are connected with one on the line between the jaws.
fn connected(difference: &[f32], threshold: f32, jaws: &[[f32; 2]; 2]) -> Vec<bool> {
    let mut covered = vec![false; SQUARE];
    let mut open = Vec::new();
    let [left, right] = jaws;
    for step in 0..=2 * SIDE {
        let share = step as f32 / (2 * SIDE) as f32;
        let part = |axis: usize| {
            (left[axis] + share * (right[axis] - left[axis])).clamp(0.0, SIDE as f32 - 1.0) as usize
        };
        open.push(part(1) * SIDE + part(0));
    }
    while let Some(at) = open.pop() {
        if covered[at] || difference[at] < threshold {
            continue;
        }
        covered[at] = true;
        let (column, row) = (at % SIDE, at / SIDE);
        for y in row.saturating_sub(1)..=(row + 1).min(SIDE - 1) {
            for x in column.saturating_sub(1)..=(column + 1).min(SIDE - 1) {
                open.push(y * SIDE + x);
            }
        }
    }
    covered
}
