//! Files of results in COCO's format.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::time::Instant;

use opendr_datasets::{Coco, Format as _, OpenOptions, find_format};
use opendr_engine::dataset::ExternalDataset;
use opendr_engine::params::{ParamMap, ParamValue};
use opendr_engine::{Error, Result, ResultExt};
use opendr_metrics::MetricEntry;
use opendr_metrics::coco::files::{CocoFiles, CocoKind};

use crate::{ClassReport, Outcome};

/// Bytes read to recognise the format.
const HEAD: u64 = 4096;

/// Evaluates a file of COCO results against a COCO data set on `threads` threads, directly on the numbers in the files. This is
/// about as fast as reading them.
///
/// # Errors
/// `InvalidParam` when the data set has another format; `Unsupported` for a metric that is not COCO's; `NotFound` without
/// annotations; `Format` with the position in the file.
pub fn score_coco_results(
    metric: &MetricEntry,
    params: &ParamMap,
    results: &Path,
    dataset: &ExternalDataset,
    split: Option<String>,
    threads: usize,
) -> Result<Outcome> {
    let begun = Instant::now();
    let format = dataset.dataset_type();
    if !["", "auto"].contains(&format) && find_format(format)?.name != Coco::NAME {
        return Err(Error::invalid_param(format!(
            "{} has COCO results, which are compared with a data set of format {}, not {format}",
            results.display(),
            Coco::NAME
        )));
    }
    let kind = match metric.name {
        "coco_detection" => CocoKind::Boxes,
        "coco_segmentation" => CocoKind::Masks,
        "coco_keypoints" => CocoKind::Keypoints,
        other => {
            return Err(Error::unsupported(format!(
                "a file of COCO results needs the metric coco_detection, coco_segmentation or coco_keypoints, not {other}"
            )));
        }
    };
    // Checks the parameters.
    metric.make(params)?;
    let options = OpenOptions { split, target: Some(metric.ground_truth) };
    let annotations = Coco::annotation_file(dataset.path(), &options)?;
    let mut files = CocoFiles { threads, ..CocoFiles::new(kind) };
    if let Some(ParamValue::Bool(use_classes)) = params.get("use_classes") {
        files.use_classes = *use_classes;
    }
    if let Some(most) = params.get("max_detections").and_then(ParamValue::as_int) {
        files.max_detections = u32::try_from(most).unwrap_or(u32::MAX);
    }
    let found = files.compare(&annotations, results)?;
    let pictures = usize::try_from(found.images).unwrap_or(usize::MAX);
    Ok(Outcome {
        learner: results.display().to_string(),
        dataset: annotations.display().to_string(),
        metric: metric.name.to_owned(),
        metric_params: params.clone(),
        threshold: None,
        // Results and annotations share one list of category ids.
        classes: ClassReport::default(),
        samples: pictures,
        counted: pictures,
        skipped: 0,
        complete: true,
        seconds: begun.elapsed().as_secs_f64(),
        report: found.report(),
        interval: None,
        lowest_scores: Vec::new(),
        evenly_spaced: Vec::new(),
        problems: Vec::new(),
        written: Vec::new(),
    })
}

/// Returns whether a file is a JSON list, as COCO's results are.
///
/// # Errors
/// `Io` when it cannot be read.
pub fn is_coco_results(path: &Path) -> Result<bool> {
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json")) {
        return Ok(false);
    }
    let context = || format!("opening {}", path.display());
    let mut head = Vec::new();
    File::open(path).context(context)?.take(HEAD).read_to_end(&mut head).context(context)?;
    Ok(head.trim_ascii_start().first() == Some(&b'['))
}
