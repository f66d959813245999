//! Evaluation of two COCO JSON files: annotations, and the results of a detector.
//!
//! Both files are read in blocks, and 64 bytes per box are kept, whatever else the files contain. Numbers keep all their
//! digits.

mod batches;
mod entry;
mod ground_truth;
mod kind;
mod results;
#[cfg(test)]
mod tests;
mod text;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use opendr_engine::{Result, ResultExt, map_in_order};

use super::accumulator::Accumulator;
use super::protocol::Protocol;
use super::summary::Outcome;
use crate::Report;
use ground_truth::GroundTruths;
use kind::{Boxes, Kind, Masks, Persons};
use results::Results;

/// A file, and the context of its errors.
type Named<R> = (R, String);

/// Images per job of a thread.
const IMAGES_PER_JOB: u32 = 64;

/// Kind of a COCO evaluation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CocoKind {
    /// Boxes (`bbox`).
    Boxes,
    /// Masks (`segm`).
    Masks,
    /// Keypoints of persons (`keypoints`).
    Keypoints,
}

/// Options of the evaluation of COCO files.
#[derive(Debug, Clone)]
pub struct CocoFiles {
    /// Kind of the evaluation.
    pub kind: CocoKind,
    /// Whether detections match only objects of their class; with keypoints always.
    pub use_classes: bool,
    /// Maximum number of detections per image and class.
    pub max_detections: u32,
    /// Number of threads.
    pub threads: usize,
}

impl CocoFiles {
    /// Creates the options of pycocotools: with classes, at most 100 detections per image and class (20 persons). Uses all
    /// cores.
    pub fn new(kind: CocoKind) -> Self {
        let max_detections = if kind == CocoKind::Keypoints { 20 } else { 100 };
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        Self { kind, use_classes: true, max_detections, threads }
    }

    /// Evaluates results against annotations.
    ///
    /// # Errors
    /// Returns `NotFound`, `Io`, or `Format` with file, line, byte and key.
    pub fn compare(&self, annotations: &Path, results: &Path) -> Result<CocoComparison> {
        let open = |path: &Path| -> Result<_> {
            let name = format!("reading {}", path.display());
            Ok((File::open(path).context(|| &name)?, name))
        };
        self.dispatch(open(annotations)?, open(results)?)
    }

    /// Compares as [`CocoFiles::compare`], from readers.
    ///
    /// # Errors
    /// As [`CocoFiles::compare`].
    pub fn compare_readers(&self, annotations: impl Read, results: impl Read) -> Result<CocoComparison> {
        self.dispatch((annotations, "reading annotations".into()), (results, "reading results".into()))
    }

    fn dispatch(&self, annotations: Named<impl Read>, results: Named<impl Read>) -> Result<CocoComparison> {
        match self.kind {
            CocoKind::Boxes => self.run::<Boxes>(annotations, results),
            CocoKind::Masks => self.run::<Masks>(annotations, results),
            CocoKind::Keypoints => self.run::<Persons>(annotations, results),
        }
    }

    fn run<K: Kind>(
        &self,
        annotations: Named<impl Read>,
        results: Named<impl Read>,
    ) -> Result<CocoComparison> {
        let threads = self.threads.max(1);
        let ground_truths = GroundTruths::<K>::read(annotations.0, threads).context(|| annotations.1)?;
        let results = Results::read(results.0, &ground_truths, threads).context(|| results.1)?;
        let fresh = || {
            Accumulator::new(match self.kind {
                CocoKind::Keypoints => Protocol::keypoints(self.max_detections),
                _ => Protocol::objects(self.max_detections),
            })
        };
        let by_class = self.use_classes || self.kind == CocoKind::Keypoints;
        let mut parts: Vec<_> = (0..threads).map(|_| fresh()).collect();
        let count = ground_truths.images() as u32;
        let starts = (0..count).step_by(IMAGES_PER_JOB as usize);
        map_in_order(
            &mut parts,
            starts,
            |part, start| {
                (start..count.min(start + IMAGES_PER_JOB))
                    .try_for_each(|at| add(part, at, &ground_truths, &results, by_class))
            },
            |done| done,
        )?;
        let mut whole = fresh();
        parts.into_iter().for_each(|part| whole.merge(part));
        Ok(CocoComparison {
            images: ground_truths.images() as u64,
            objects: ground_truths.objects() as u64,
            detections: results.detections() as u64,
            unlisted_objects: ground_truths.unlisted,
            unlisted_detections: results.unlisted,
            classes: ground_truths.classes,
            outcome: whole.finish(threads),
        })
    }
}

/// Class of all objects if classes count as one.
const ANY: i64 = 0;

fn add<K: Kind>(
    part: &mut Accumulator<i64>,
    at: u32,
    ground_truths: &GroundTruths<K>,
    results: &Results<K>,
    by_class: bool,
) -> Result<()> {
    let mut annotated: Vec<_> = ground_truths.of_image(at).iter().collect();
    let mut detected: Vec<_> = results.of_image(at).collect();
    // pycocotools goes through the classes one after the other, even if they count as one.
    annotated.sort_by_key(|annotation| annotation.class);
    detected.sort_by_key(|detection| detection.class);
    let (mut annotated, mut detected) = (&annotated[..], &detected[..]);
    while let Some(first) =
        annotated.first().map(|one| one.class).into_iter().chain(detected.first().map(|one| one.class)).min()
    {
        let class = if by_class { first } else { ANY };
        let of_class = |other: i64| !by_class || other == first;
        let (of_class_annotated, later_annotated) =
            annotated.split_at(annotated.partition_point(|one| of_class(one.class)));
        let (of_class_detected, later_detected) =
            detected.split_at(detected.partition_point(|one| of_class(one.class)));
        (annotated, detected) = (later_annotated, later_detected);
        let mut objects = Vec::with_capacity(of_class_annotated.len());
        let mut matched = Vec::with_capacity(of_class_annotated.len());
        for annotation in of_class_annotated {
            let (object, area) = K::object(&annotation.annotated, ground_truths.size(at))
                .context(|| format!("an annotation of image {}", ground_truths.id(at)))?;
            objects.push(object);
            matched.push(annotation.ground_truth(area));
        }
        let detections: Vec<_> = of_class_detected.iter().map(|one| one.detection).collect();
        part.count(&class, at, &matched, &detections, |detection, ground_truth| {
            K::overlap(
                &of_class_detected[detection].detected,
                &objects[ground_truth],
                matched[ground_truth].crowd,
            )
        })
        .context(|| format!("image {}", ground_truths.id(at)))?;
    }
    Ok(())
}

/// Result of the evaluation of two files.
#[derive(Debug, Clone)]
pub struct CocoComparison {
    /// Metrics.
    pub outcome: Outcome<i64>,
    /// Class names by category id.
    pub classes: BTreeMap<i64, String>,
    /// Number of annotated images.
    pub images: u64,
    /// Number of annotated objects, including crowds.
    pub objects: u64,
    /// Number of detections.
    pub detections: u64,
    /// Number of annotations that are ignored because their image or category is not listed.
    pub unlisted_objects: u64,
    /// Number of detections that are ignored because their category is not listed.
    pub unlisted_detections: u64,
}

impl CocoComparison {
    /// Returns the metrics, a table by class, and precision-recall curves.
    pub fn report(&self) -> Report {
        self.outcome.report(|class| self.classes.get(class).cloned().unwrap_or_else(|| class.to_string()))
    }
}
