//! The camera policy beside baselines, on the same episodes.

use std::fmt;

use opendr_engine::{Progress, Result};
use serde::Serialize;

use crate::camera_policy::{
    CameraPolicy, GreedyPolicy, OracleBaseline, OrbitBaseline, RandomBaseline, StaticBaseline, TrainedPolicy,
};
use crate::episode::run_episode;
use crate::model::ActiveModel;
use crate::report::ActiveReport;
use crate::scene::ActiveScene;
use crate::stop::StopRule;
use crate::view_loop::ViewLoop;

/// First seed of the evaluation. Trainings and calibrations use none from 1,000,000 to 2^32; the worlds were designed on episodes from
/// 1,000,000 on.
pub const FIRST_EVALUATION_SEED: u64 = 5_000_000;

/// Figures of each camera policy.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// A row per camera policy.
    pub rows: Vec<ComparisonRow>,
}

/// Figures of a camera policy.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparisonRow {
    /// Name of the camera policy.
    pub camera_policy: &'static str,
    /// Its figures.
    #[serde(flatten)]
    pub report: ActiveReport,
}

/// Evaluates the camera policy of a model and the baselines on the episodes with seeds from `first_seed` on.
///
/// # Errors
/// Returns errors of the scene, and `InvalidInput` when stopped before the first episode ended.
pub fn compare<S: ActiveScene>(
    scene: S,
    model: &ActiveModel,
    first_seed: u64,
    episodes: u64,
    progress: &dyn Progress,
) -> Result<Comparison> {
    let one = StopRule { moves: 0, ..model.stop };
    let policies: [(&str, Box<dyn CameraPolicy>, StopRule); 6] = [
        ("static", Box::new(StaticBaseline), one),
        ("random", Box::<RandomBaseline>::default(), model.stop),
        ("orbit", Box::new(OrbitBaseline), model.stop),
        ("greedy", Box::new(GreedyPolicy::new(model.gain.clone())), model.stop),
        ("policy", Box::new(TrainedPolicy::new(model.policy.clone())), model.stop),
        ("oracle", Box::new(OracleBaseline), model.stop),
    ];
    let mut view_loop = ViewLoop::new(scene, model.fusion, model.stop.moves, model.best_view.clone())?;
    let mut rows = Vec::new();
    for (camera_policy, mut policy, stop) in policies {
        let mut results = Vec::new();
        for seed in (first_seed..first_seed + episodes).take_while(|_| !progress.stopped()) {
            results.push(run_episode(&mut view_loop, &mut *policy, &stop, seed, None)?);
            progress.advance(1);
        }
        rows.push(ComparisonRow { camera_policy, report: ActiveReport::of(&results)? });
    }
    Ok(Comparison { rows })
}

impl Comparison {
    /// Returns the report of a camera policy.
    pub fn of(&self, camera_policy: &str) -> Option<&ActiveReport> {
        self.rows.iter().find(|row| row.camera_policy == camera_policy).map(|row| &row.report)
    }
}

/// A table in Markdown.
impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "| camera policy | accuracy (95 %) | ECE | median views to 0.9 | mean views |")?;
        writeln!(f, "|---|---|---|---|---|")?;
        self.rows.iter().try_for_each(|row| writeln!(f, "| {} | {} |", row.camera_policy, row.report))
    }
}
