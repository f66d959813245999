//! KITTI's object detection: average precision of boxes in the image, in bird's-eye view and in space, and of orientation.
//!
//! A. Geiger, P. Lenz, R. Urtasun, "Are we ready for autonomous driving? The KITTI vision benchmark suite", CVPR 2012;
//! 40 recall points: A. Simonelli et al., "Disentangling monocular 3D object detection", ICCV 2019. The rules are those
//! of the development kit (`evaluate_object_3d.cpp`).

mod average_precision;
mod frame;
mod object;
mod rules;

use std::collections::BTreeMap;

use opendr_engine::Result;
use opendr_engine::params::NoParams;
use opendr_engine::target::BoundingBox3DList;

use crate::{Curves, Figure, Line, Metric, Report, Table};

pub use average_precision::KittiScore;
pub use object::KittiObject;
pub use rules::{KittiClass, KittiDifficulty, KittiOverlap};

use average_precision::curves;
use frame::Frame;
use rules::Rules;

/// KITTI's object detection metrics.
///
/// The properties that the rules use are kept for every box, as the score thresholds depend on all of them.
#[derive(Debug, Clone, Default)]
pub struct Kitti {
    frames: Vec<Frame>,
}

impl Kitti {
    /// Adds image `at` and returns how well boxes of the same class overlap in space, 0 to 1.
    ///
    /// # Errors
    /// Returns `InvalidInput` for more than 1024 boxes, and for a box whose numbers are not finite.
    pub fn count(&mut self, at: usize, found: &[KittiObject], ground_truth: &[KittiObject]) -> Result<f64> {
        let frame = Frame::new(at, found, ground_truth)?;
        let coverage = frame.coverage;
        self.frames.push(frame);
        Ok(coverage)
    }

    /// Returns the scores of every class, kind of overlap and difficulty with ground truth that counts.
    ///
    /// The score of orientation is included unless a predicted box has no `alpha` (-10).
    pub fn scores(&self) -> Vec<KittiScore> {
        let mut frames: Vec<_> = self.frames.iter().collect();
        frames.sort_by_key(|frame| frame.at);
        let with_orientation = frames.iter().all(|frame| frame.has_orientations);
        Rules::all().filter_map(|rules| curves(&frames, &rules, with_orientation)).collect()
    }
}

impl Metric for Kitti {
    const NAME: &'static str = "kitti_detection";
    const ABOUT: &'static str =
        "KITTI's AP of boxes in the image, in bird's-eye view and in space, and AOS, as its development kit";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        (
            "map_<kind>_<difficulty>_<points>",
            "Mean over the classes: `2d`, `bev`, `3d` or `aos`; `easy`, `moderate` or `hard`; `r11` or `r40` points of recall, and `_loose` with the lower limits of overlap.",
        ),
        ("<class>_<kind>_<difficulty>_<points>", "AP of one class: `car`, `pedestrian` or `cyclist`."),
    ];
    const IS_RANKING: bool = true;
    type Params = NoParams;
    type Prediction = BoundingBox3DList;
    type GroundTruth = BoundingBox3DList;

    fn new(_params: &NoParams) -> Result<Self> {
        Ok(Self::default())
    }

    fn update(
        &mut self,
        at: usize,
        prediction: &BoundingBox3DList,
        ground_truth: &BoundingBox3DList,
    ) -> Result<f64> {
        self.count(at, &object::objects_from_list(prediction)?, &object::objects_from_list(ground_truth)?)
    }

    fn merge(&mut self, other: Self) {
        self.frames.extend(other.frames);
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("map_3d_moderate_r40");
        let scores = self.scores();
        let mut means = BTreeMap::<String, Vec<f64>>::new();
        for score in &scores {
            for (kind, r11, r40) in score.numbers() {
                for (points, value) in [("r11", r11), ("r40", r40)] {
                    let key = format!("{kind}_{}_{points}{}", score.difficulty.name(), score.suffix());
                    report.statistics.set(format!("{}_{key}", score.class.name()), value);
                    means.entry(format!("map_{key}")).or_default().push(value);
                }
            }
        }
        for (key, values) in means {
            report.statistics.set(key, values.iter().sum::<f64>() / values.len() as f64);
        }
        report.tables.push(table(&scores));
        report.figures.push(Figure::Curves(precision_over_recall(&scores)));
        report
    }
}

/// Returns a line for every class and kind of overlap, at moderate difficulty.
fn precision_over_recall(scores: &[KittiScore]) -> Curves {
    let usual =
        scores.iter().filter(|score| score.difficulty == KittiDifficulty::Moderate && !score.is_loose);
    let lines = usual.map(|score| {
        let steps = (score.precision.len() - 1) as f64;
        let point = |(at, precision): (usize, &f64)| [at as f64 / steps, *precision];
        let label = format!("{} {}", score.class.name(), score.overlap.name());
        Line { label, points: score.precision.iter().enumerate().map(point).collect() }
    });
    Curves {
        name: "precision_recall".to_owned(),
        title: "Precision over recall, moderate difficulty".to_owned(),
        x: "recall".to_owned(),
        y: "precision".to_owned(),
        lines: lines.collect(),
    }
}

/// Returns a table with rows of class, kind and overlap, and a column per difficulty and number of recall points.
fn table(scores: &[KittiScore]) -> Table {
    let mut table = Table { name: "class".to_owned(), ..Table::default() };
    for points in ["R40", "R11"] {
        table
            .columns
            .extend(KittiDifficulty::ALL.map(|difficulty| format!("{} {points}", difficulty.name())));
    }
    for score in scores {
        let column = score.difficulty as usize;
        for (kind, r11, r40) in score.numbers() {
            let label = format!("{} {kind} @{:.2}", score.class.name(), score.overlap_threshold);
            let row = match table.rows.iter().position(|(other, _)| *other == label) {
                Some(row) => row,
                None => {
                    table.rows.push((label, vec![None; 6]));
                    table.rows.len() - 1
                }
            };
            table.rows[row].1[column] = Some(r40);
            table.rows[row].1[column + 3] = Some(r11);
        }
    }
    table
}

#[cfg(test)]
mod tests;
