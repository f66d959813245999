//! `opendr view`: shows inputs with predictions, or the curves of a training or a study, on a local web page.

use std::path::Path;

use clap::{ArgMatches, Command};
use opendr::runlog::has_scalars;
use opendr::viewer::CurveSource;
use opendr::{Error, Result, STUDY_JOURNAL};

use crate::command::fit::LOGS;
use crate::command::infer;
use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::{curves, loading, viewing};

pub const NAME: &str = "view";

const EXAMPLES: &str = "\
Examples:
  opendr view nanodet street.mp4                      detections in a video, at its speed
  opendr view nanodet camera:0 --view-write           ... of a camera, with sliders for live parameters
  opendr view voxel_object_detection_3d scans/        point clouds with 3D boxes
  opendr view nanodet drive.bag --topic /camera/image_raw
  opendr view runs/mine                               the curves of a training or a study, while it runs or later
  opendr view nanodet camera:0 --view=0.0.0.0:7007    for other machines; the printed address has a token

Over SSH: ssh -L 7007:localhost:7007 robot, then open http://localhost:7007. Ctrl-C ends the page.";

pub fn grammar() -> Command {
    infer::arguments(Command::new(NAME))
        .about("Show inputs with predictions, or the curves of a training or a study, on a local web page")
        .mut_arg("view", |view| view.default_value(viewing::ADDRESS))
        .after_help(EXAMPLES)
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let spec = matches.get_one::<String>(loading::LEARNER).map_or("", String::as_str);
    if let Some(curves) = curves_of(spec) {
        let bar = ProgressBar::new(matches.get_flag("quiet"));
        let viewer = viewing::of_curves(spec, curves, matches, &bar)?;
        viewing::wait_for_interrupt();
        drop(viewer);
        return Ok(Outcome::Done);
    }
    if !matches.contains_id("input") {
        return Err(Error::invalid_param(format!(
            "{spec} is no folder of a training or a study; to view predictions, give inputs: opendr view {spec} street.mp4"
        )));
    }
    infer::run_until_interrupt(matches)
}

/// Returns the curves in the output folder of a training or a study.
pub fn curves_of(spec: &str) -> Option<CurveSource> {
    let folder = Path::new(spec);
    let journal = folder.join(STUDY_JOURNAL);
    if journal.is_file() {
        return Some(curves::of_study(journal));
    }
    let mut logs = [folder.join(LOGS), folder.to_owned()].into_iter();
    logs.find(|folder| has_scalars(folder)).map(curves::of_training)
}
