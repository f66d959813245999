//! Teachers: learners whose predictions replace annotations (distillation, pseudo-labels).

use std::fs;
use std::path::Path;

use opendr_datasets::Problems;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{AnyLearner, AnyStream, Entry};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Progress, Result, ResultExt, Unit, Value, ValueType};

use crate::journal::{Heading, Journal, Line, SampleResult};
use crate::predictor::PredictionJob;
use crate::{ClassMap, ClassMatching, LabelledDataset, Subject};

/// Advice for classes that do not match.
const REMEDY: &str = "Map them with teacher_map (--teacher-map TEACHER=CLASS,...), or take their numbers as they are with \
                      teacher_by_number (--teacher-by-number)";
/// Label of pixels that are ignored in training.
const IGNORED: u32 = 255;
/// File of the teacher's predictions.
const JOURNAL: &str = "teacher.jsonl";

/// A loaded learner that annotates samples for another one.
pub struct Teacher {
    /// The learner, as named in the journal.
    pub subject: Subject,
    /// Its registry entry.
    pub entry: &'static Entry,
    /// Classes of its predictions.
    pub classes: Classes,
    /// Streams, one per sample in parallel.
    pub streams: Vec<Box<dyn AnyStream>>,
}

impl Teacher {
    /// Creates a teacher from a loaded learner of `entry`, called `name`, with `at_once` streams, or one if it keeps state.
    ///
    /// # Errors
    /// `NotFound` when no model is loaded.
    pub fn new(
        name: impl Into<String>,
        learner: &dyn AnyLearner,
        entry: &'static Entry,
        at_once: usize,
    ) -> Result<Self> {
        let at_once = if entry.stateful { 1 } else { at_once.max(1) };
        Ok(Self {
            subject: Subject { learner: name.into(), model: None, params: learner.params() },
            entry,
            classes: learner.classes(),
            streams: (0..at_once).map(|_| learner.stream()).collect::<Result<_>>()?,
        })
    }

    /// Checks that the teacher predicts the type `wanted`.
    fn check(&self, wanted: ValueType) -> Result<()> {
        let outputs: Vec<_> = self.entry.outputs.iter().map(|output| output.value_type).collect();
        if outputs.contains(&wanted) {
            return Ok(());
        }
        let outputs: Vec<_> = outputs.into_iter().map(ValueType::name).collect();
        Err(Error::invalid_input(format!(
            "{} predicts {}, but the student needs {}; choose another teacher",
            self.subject.learner,
            outputs.join(" and "),
            wanted.name()
        )))
    }
}

/// Settings of a distillation: how a teacher's predictions become annotations.
pub struct Distillation<'a> {
    /// Name of the data set in the journal.
    pub dataset: String,
    /// Type of the annotations.
    pub annotation_type: ValueType,
    /// Predictions below this score are dropped.
    pub threshold: f32,
    /// Classes of the annotations; if empty, those of the data set, or else the teacher's.
    pub classes: Classes,
    /// How the teacher's classes are matched with these.
    pub class_matching: ClassMatching,
    /// Whether samples without detections are kept, as negative examples.
    pub keep_empty: bool,
    /// Folder to which every prediction is written at once; an interrupted run resumes from it.
    pub folder: &'a Path,
    /// How samples without a prediction are handled.
    pub problems: &'a Problems,
    /// Receives the progress, and may stop the run.
    pub progress: &'a dyn Progress,
}

impl Distillation<'_> {
    /// Annotates samples with a teacher. If the user stops it, the remaining samples are left out.
    ///
    /// # Errors
    /// `InvalidInput` when the teacher predicts another type, and for a sample without a prediction unless problems are
    /// skipped; `Io` when the journal cannot be written.
    pub fn label<'d>(
        &self,
        mut teacher: Teacher,
        samples: Box<dyn DatasetIterator + 'd>,
    ) -> Result<LabelledDataset<'d>> {
        teacher.check(self.annotation_type)?;
        fs::create_dir_all(self.folder).context(|| format!("creating {}", self.folder.display()))?;
        let known = [self.classes.clone(), samples.classes(), teacher.classes.clone()];
        let classes = known.into_iter().find(|classes| !classes.is_empty()).unwrap_or_default();
        let map = ClassMap::new(teacher.classes.clone(), classes.clone(), &self.class_matching)?;
        map.check(None, REMEDY)?;
        let map = map.with_no_class(IGNORED);
        let mut labels = Labels { lesson: self, map, next: 0, kept: Vec::new() };
        let what = format!("annotating with {}", teacher.subject.learner);
        self.progress.begin(&what, Some(samples.len() as u64), Unit::Items);
        let done = self.predict(&mut teacher, samples.as_ref(), &mut labels);
        self.progress.end();
        done?;
        let Labels { next, kept, map, .. } = labels;
        let matched = map.report();
        if !matched.is_empty() {
            self.progress.note(matched.to_string().trim_end());
        }
        Ok(LabelledDataset::new(samples, kept, classes, next))
    }

    fn predict(
        &self,
        teacher: &mut Teacher,
        samples: &dyn DatasetIterator,
        labels: &mut Labels<'_>,
    ) -> Result<()> {
        let heading = Heading::new(teacher.subject.clone(), self.dataset.clone(), samples);
        let mut journal = Journal::resume(&self.folder.join(JOURNAL), &heading, samples, |line| {
            self.progress.advance(1);
            labels.add(line)
        })?;
        let job = PredictionJob {
            ports: teacher.entry.ports,
            dataset: samples,
            first: labels.next,
            wanted: self.annotation_type,
            observer: None,
        };
        job.predict(&mut teacher.streams, self.progress, |line| {
            journal.write(&line)?;
            labels.add(line)
        })
    }
}

/// The annotations so far.
struct Labels<'a> {
    lesson: &'a Distillation<'a>,
    map: ClassMap,
    next: usize,
    kept: Vec<(usize, Value)>,
}

impl Labels<'_> {
    fn add(&mut self, line: Line) -> Result<()> {
        self.next = line.at + 1;
        match line.result {
            SampleResult::Prediction(prediction) => {
                let label = self.label(*prediction)?;
                self.kept.extend(label.map(|label| (line.at, label)));
                Ok(())
            }
            SampleResult::Error(problem) => self.lesson.problems.report(problem),
        }
    }

    /// Converts a prediction into an annotation; `None` when it has no information for training.
    fn label(&mut self, mut prediction: Value) -> Result<Option<Value>> {
        let is_confident = |confidence: f32| confidence >= self.lesson.threshold;
        match &mut prediction {
            Value::BoundingBoxList(list) => list.boxes.retain(|found| is_confident(found.confidence)),
            Value::BoundingBox3DList(list) => list.boxes.retain(|found| is_confident(found.confidence)),
            Value::PoseList(list) => list.poses.retain(|pose| is_confident(pose.confidence)),
            Value::Category(category) => {
                category.probabilities.clear();
                if !category.confidence.is_none_or(is_confident) {
                    return Ok(None);
                }
            }
            _ => {}
        }
        self.map.apply(&mut prediction)?;
        if matches!(&prediction, Value::Category(category) if self.map.is_beyond(category.class)) {
            return Ok(None);
        }
        let is_empty = match &prediction {
            Value::BoundingBoxList(list) => list.boxes.is_empty(),
            Value::BoundingBox3DList(list) => list.boxes.is_empty(),
            Value::PoseList(list) => list.poses.is_empty(),
            _ => false,
        };
        Ok((self.lesson.keep_empty || !is_empty).then_some(prediction))
    }
}

#[cfg(test)]
mod tests;
