//! A learner whose answers stand in for annotations (distillation, pseudo-labels).

use std::fs;
use std::path::Path;

use opendr_datasets::Problems;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{AnyLearner, AnyStream, Entry};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Progress, Result, ResultExt, Unit, Value, ValueType};

use crate::journal::{Answer, Heading, Journal, Line};
use crate::predictor::predict_samples;
use crate::{ClassMap, ClassMatching, Subject, Taught};

/// What to do about classes that do not match.
const REMEDY: &str = "Map them with teacher_map (--teacher-map TEACHER=CLASS,...), or take their numbers as they are with \
                      teacher_by_number (--teacher-by-number)";
/// The label of pixels from which nothing is learned.
const IGNORED: u32 = 255;
/// The file of the teacher's answers.
const JOURNAL: &str = "teacher.jsonl";

/// A loaded learner that labels samples for another one.
pub struct Teacher {
    /// What it is: its journal names it.
    pub subject: Subject,
    /// Its tables.
    pub entry: &'static Entry,
    /// What its class numbers mean.
    pub classes: Classes,
    /// As many samples are answered at once.
    pub streams: Vec<Box<dyn AnyStream>>,
}

impl Teacher {
    /// A loaded learner of `entry`, called `name`; it answers `at_once` samples at once, unless it remembers.
    ///
    /// # Errors
    /// `NotFound` when nothing is loaded.
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

    /// That it answers what is wanted.
    fn check(&self, wanted: ValueType) -> Result<()> {
        let answers: Vec<_> = self.entry.outputs.iter().map(|output| output.value_type).collect();
        if answers.contains(&wanted) {
            return Ok(());
        }
        let answers: Vec<_> = answers.into_iter().map(ValueType::name).collect();
        Err(Error::invalid_input(format!(
            "{} answers {}, but what learns from it needs {}; name another teacher",
            self.subject.learner,
            answers.join(" and "),
            wanted.name()
        )))
    }
}

/// How a teacher's answers become annotations.
pub struct Lesson<'a> {
    /// What the data set is called in the journal.
    pub dataset: String,
    /// The type of the annotations.
    pub wanted: ValueType,
    /// Answers below this score are dropped.
    pub threshold: f32,
    /// The classes of the annotations; when empty those of the data set, or else the teacher's.
    pub classes: Classes,
    /// How the teacher's classes are matched with these.
    pub class_matching: ClassMatching,
    /// Whether samples in which nothing was found are kept, as examples of nothing.
    pub keep_empty: bool,
    /// Where every answer is written as it comes; a lesson that was broken off goes on from there.
    pub folder: &'a Path,
    /// What becomes of samples that cannot be answered.
    pub problems: &'a Problems,
    /// To whom to report; asked whether to stop.
    pub progress: &'a dyn Progress,
}

impl Lesson<'_> {
    /// Has the samples labelled. When the user stops it, the rest is left out.
    ///
    /// # Errors
    /// `InvalidInput` when the teacher answers something else; for a sample that cannot be answered, unless problems are
    /// skipped; `Io` when the journal cannot be written.
    pub fn teach<'d>(
        &self,
        mut teacher: Teacher,
        samples: Box<dyn DatasetIterator + 'd>,
    ) -> Result<Taught<'d>> {
        teacher.check(self.wanted)?;
        fs::create_dir_all(self.folder).context(|| format!("making {}", self.folder.display()))?;
        let known = [self.classes.clone(), samples.classes(), teacher.classes.clone()];
        let classes = known.into_iter().find(|classes| !classes.is_empty()).unwrap_or_default();
        let map = ClassMap::new(teacher.classes.clone(), classes.clone(), &self.class_matching)?;
        map.check(None, REMEDY)?;
        let map = map.with_no_class(IGNORED);
        let mut labels = Labels { lesson: self, map, next: 0, kept: Vec::new() };
        let what = format!("asking {}", teacher.subject.learner);
        self.progress.begin(&what, Some(samples.len() as u64), Unit::Items);
        let done = self.ask(&mut teacher, samples.as_ref(), &mut labels);
        self.progress.end();
        done?;
        let Labels { next, kept, map, .. } = labels;
        let matched = map.report();
        if !matched.is_empty() {
            self.progress.note(matched.to_string().trim_end());
        }
        Ok(Taught::new(samples, kept, classes, next))
    }

    fn ask(
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
        let (streams, ports, first) = (&mut teacher.streams, teacher.entry.ports, labels.next);
        predict_samples(streams, ports, samples, first, self.wanted, self.progress, |line| {
            journal.write(&line)?;
            labels.add(line)
        })
    }
}

/// The annotations so far.
struct Labels<'a> {
    lesson: &'a Lesson<'a>,
    map: ClassMap,
    next: usize,
    kept: Vec<(usize, Value)>,
}

impl Labels<'_> {
    fn add(&mut self, line: Line) -> Result<()> {
        self.next = line.at + 1;
        match line.answer {
            Answer::Prediction(answer) => {
                let label = self.label(*answer)?;
                self.kept.extend(label.map(|label| (line.at, label)));
                Ok(())
            }
            Answer::Error(problem) => self.lesson.problems.report(problem),
        }
    }

    /// What is left of a prediction; `None` when nothing is to be learned from it.
    fn label(&mut self, mut answer: Value) -> Result<Option<Value>> {
        let sure = |confidence: f32| confidence >= self.lesson.threshold;
        match &mut answer {
            Value::BoundingBoxList(list) => list.boxes.retain(|found| sure(found.confidence)),
            Value::BoundingBox3DList(list) => list.boxes.retain(|found| sure(found.confidence)),
            Value::PoseList(list) => list.poses.retain(|pose| sure(pose.confidence)),
            Value::Category(category) => {
                category.probabilities.clear();
                if !category.confidence.is_none_or(sure) {
                    return Ok(None);
                }
            }
            _ => {}
        }
        self.map.apply(&mut answer)?;
        if matches!(&answer, Value::Category(category) if self.map.is_beyond(category.class)) {
            return Ok(None);
        }
        let is_empty = match &answer {
            Value::BoundingBoxList(list) => list.boxes.is_empty(),
            Value::BoundingBox3DList(list) => list.boxes.is_empty(),
            Value::PoseList(list) => list.poses.is_empty(),
            _ => false,
        };
        Ok((self.lesson.keep_empty || !is_empty).then_some(answer))
    }
}

#[cfg(test)]
mod tests;
