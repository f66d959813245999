//! Recordings of robots (rosbag 1, rosbag 2, MCAP) with a topic of annotations, as data sets.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Category, Classes, Name};
use opendr_engine::{Error, Result, ResultExt, Value, ValueType};
use opendr_messages::{Message, MessageType};
use opendr_recordings::{Recording, Selection, Topic, is_recording, stamp_of, value_of};

use crate::folder::past_end;
use crate::{Format, OpenOptions, Problem, Problems, Recognition};

/// Largest difference between the stamps of a datum and its annotation in nanoseconds; the value of the ROS node.
const SLOP_NS: i64 = 20_000_000;

/// A recording: a sample is a message of the annotation topic and the datum with the nearest stamp within 20 ms.
/// Data without annotation are not samples.
#[derive(Debug)]
pub struct AnnotatedRecording {
    recording: Recording,
    data: (Topic, ValueType),
    ground_truth: (Topic, ValueType),
    samples: Vec<Pair>,
    classes: Classes,
}

#[derive(Debug, Clone, Copy)]
struct Pair {
    data: At,
    ground_truth: At,
}

/// Location of a message in its topic.
#[derive(Debug, Clone, Copy)]
struct At {
    stamp_ns: i64,
    log_time_ns: i64,
    /// Index among the messages of the same log time.
    nth: u32,
}

/// Returns the data types for a target type, the most likely first.
fn data_types(target: ValueType) -> &'static [ValueType] {
    match target {
        ValueType::BoundingBox3DList | ValueType::TrackingAnnotation3DList => {
            &[ValueType::PointCloud, ValueType::Image]
        }
        ValueType::Category => {
            &[ValueType::Image, ValueType::Timeseries, ValueType::Audio, ValueType::PointCloud]
        }
        _ => &[ValueType::Image],
    }
}

/// Returns the topic for one of `types`: a named topic of a fitting type, otherwise the only fitting one.
fn topic_of(recording: &Recording, types: &[ValueType], named: &[&str]) -> Result<(Topic, ValueType)> {
    let mut first_error = None;
    for value_type in types {
        let found = named.iter().find_map(|name| recording.topic_for(*value_type, Some(name)).ok());
        match found.map_or_else(|| recording.topic_for(*value_type, None), Ok) {
            Ok(topic) => return Ok((topic, *value_type)),
            Err(error) => first_error = first_error.or(Some(error)),
        }
    }
    let error = first_error.unwrap_or_else(|| Error::internal("no type is given"));
    Err(error
        .context("select the topics of data and annotations with the part to read (--split TOPIC,TOPIC)"))
}

impl AnnotatedRecording {
    fn index(&self, topic: &Topic, problems: &Problems) -> Result<Vec<At>> {
        let (mut places, mut last) = (Vec::new(), (i64::MIN, 0));
        for message in self.recording.bag().select(&Selection::topics([&topic.name]))? {
            let message = match message {
                Ok(message) => message,
                Err(error) => {
                    problems.report(Problem::new(self.recording.path(), error.to_string()))?;
                    break;
                }
            };
            let nth = if last.0 == message.log_time_ns { last.1 + 1 } else { 0 };
            last = (message.log_time_ns, nth);
            match self.recording.decode(&message) {
                Ok(decoded) => {
                    let stamp_ns = stamp_of(&decoded, message.log_time_ns);
                    places.push(At { stamp_ns, log_time_ns: message.log_time_ns, nth });
                }
                Err(error) => self.problem(topic, message.log_time_ns, &error, problems)?,
            }
        }
        Ok(places)
    }

    fn problem(&self, topic: &Topic, time_ns: i64, error: &Error, problems: &Problems) -> Result<()> {
        let place = format!("{} at {time_ns} ns", topic.name);
        problems.report(Problem::at_key(self.recording.path(), place, error.to_string()))
    }

    fn message(&self, topic: &Topic, at: At) -> Result<Message> {
        let time = Some(at.log_time_ns);
        let selection = Selection { start_ns: time, end_ns: time, ..Selection::topics([&topic.name]) };
        let message = self.recording.bag().select(&selection)?.nth(at.nth as usize);
        let message = message.ok_or_else(|| {
            Error::format("a message is missing: the file was modified while it was in use")
        })??;
        self.recording.decode(&message)
    }

    fn value(&self, (topic, value_type): &(Topic, ValueType), at: At) -> Result<Value> {
        let read = || value_of(*value_type, self.message(topic, at)?, at.stamp_ns);
        read().map_err(|error| {
            let place = format!("{} at {} ns", topic.name, at.log_time_ns);
            Problem::at_key(self.recording.path(), place, error.to_string()).into()
        })
    }

    fn pair(&self, index: usize) -> Result<Pair> {
        self.samples.get(index).copied().ok_or_else(|| past_end(index, self.samples.len()))
    }

    /// Returns the class names of the only LabelInfo message, followed by the labels of annotations that it lacks,
    /// sorted.
    fn find_classes(&self) -> Result<Classes> {
        let mut names = Vec::new();
        let topics = self.recording.topics();
        let info: Vec<_> = topics
            .iter()
            .filter(|topic| topic.message_type == Some(MessageType::VisionMsgsLabelInfo))
            .collect();
        if let [topic] = info[..]
            && let Some(message) = self.recording.bag().select(&Selection::topics([&topic.name]))?.next()
            && let Message::VisionMsgsLabelInfo(info) = self.recording.decode(&message?)?
        {
            let count = info.class_map.iter().map(|class| usize::from(class.class_id) + 1).max().unwrap_or(0);
            names = vec![String::new(); count];
            for class in info.class_map {
                if let Some(name) = names.get_mut(usize::from(class.class_id)) {
                    *name = class.class_name;
                }
            }
        }
        let mut labels = BTreeSet::new();
        for pair in &self.samples {
            // Errors of reading are reported when the sample is read.
            match self.value(&self.ground_truth, pair.ground_truth) {
                Ok(mut value) => for_each_name(&mut value, |name| {
                    if let Name::Label(label) = name {
                        labels.insert(label.to_string());
                    }
                }),
                Err(_) => continue,
            }
        }
        labels.retain(|label| !names.contains(label));
        Ok(names.into_iter().chain(labels).collect())
    }
}

/// Calls `each` with every class name of a target.
fn for_each_name(value: &mut Value, mut each: impl FnMut(&mut Name)) {
    match value {
        Value::BoundingBoxList(list) => list.boxes.iter_mut().for_each(|one| each(&mut one.name)),
        Value::TrackingAnnotationList(list) => {
            list.annotations.iter_mut().for_each(|one| each(&mut one.bounding_box.name));
        }
        Value::BoundingBox3DList(list) => list.boxes.iter_mut().for_each(|one| each(&mut one.name)),
        Value::TrackingAnnotation3DList(list) => {
            list.annotations.iter_mut().for_each(|one| each(&mut one.bounding_box_3d.name));
        }
        Value::Category(Category { class, description: Some(label), .. }) => {
            let mut name = Name::Label(label.clone());
            each(&mut name);
            if let Name::Index(index) = name {
                *class = index;
            }
        }
        _ => {}
    }
}

impl Dataset for AnnotatedRecording {}

impl DatasetIterator for AnnotatedRecording {
    fn len(&self) -> usize {
        self.samples.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let data = vec![self.value(&self.data, self.pair(index)?.data)?];
        Ok(Sample { data, target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let mut value = self.value(&self.ground_truth, self.pair(index)?.ground_truth)?;
        for_each_name(&mut value, |name| {
            if let Some(number) = self.classes.label(name).and_then(|label| self.classes.index(label)) {
                *name = Name::Index(number);
            }
        });
        let classes = self.classes.clone();
        match &mut value {
            Value::BoundingBoxList(list) => list.classes = classes,
            Value::TrackingAnnotationList(list) => list.classes = classes,
            Value::BoundingBox3DList(list) => list.classes = classes,
            Value::TrackingAnnotation3DList(list) => list.classes = classes,
            _ => {}
        }
        Ok(Some(value))
    }

    /// Returns the stamp of the datum in nanoseconds.
    fn name(&self, index: usize) -> String {
        self.pair(index).map_or_else(|_| index.to_string(), |pair| pair.data.stamp_ns.to_string())
    }

    fn path(&self, _index: usize) -> Option<PathBuf> {
        Some(self.recording.path().to_owned())
    }

    fn sequence(&self, _index: usize) -> Option<usize> {
        Some(0)
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

impl Format for AnnotatedRecording {
    const NAME: &'static str = "recording";
    const ALIASES: &'static [&'static str] = &["rosbag", "rosbag2", "mcap"];
    const ABOUT: &'static str = "recordings of robots with a topic of annotations";
    const LAYOUT: &'static str = "a .bag, .mcap or .db3 file, or a folder with metadata.yaml; annotations as vision_msgs Detection2DArray, Detection3DArray or Classification, or opendr_msgs Pose2DArray, with the stamps of their data; if several topics fit, a part is TOPIC,TOPIC";
    const TARGETS: &'static [ValueType] = &[
        ValueType::BoundingBoxList,
        ValueType::TrackingAnnotationList,
        ValueType::BoundingBox3DList,
        ValueType::TrackingAnnotation3DList,
        ValueType::PoseList,
        ValueType::Category,
    ];

    fn recognise(path: &Path) -> Recognition {
        match is_recording(path) {
            true => Recognition::Certain,
            false => Recognition::No("a .bag, .mcap or .db3 file, or a metadata.yaml".into()),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let recording = Recording::open(path)?;
        let named: Vec<&str> = options.split.iter().flat_map(|split| split.split(',')).collect();
        let types = options.target.as_ref().map_or(Self::TARGETS, std::slice::from_ref);
        let ground_truth = topic_of(&recording, types, &named)?;
        let data = topic_of(&recording, data_types(ground_truth.1), &named)?;
        let is_unused = |name: &&&str| {
            [&data.0, &ground_truth.0]
                .iter()
                .all(|topic| topic.name.trim_start_matches('/') != name.trim_start_matches('/'))
        };
        if let Some(name) = named.iter().find(is_unused) {
            // The error of `topic_for` states the reason.
            recording.topic_for(ground_truth.1, Some(name))?;
            return Err(Error::invalid_param(format!(
                "{name:?} is one topic too many: select one of data and one of annotations"
            )));
        }
        if !recording.bag().is_complete() {
            let message = "is truncated or damaged; its readable part is used";
            problems.report(Problem::new(path, message))?;
        }
        let classes = Classes::default();
        let mut opened = Self { recording, data, ground_truth, samples: Vec::new(), classes };
        let mut data = opened.index(&opened.data.0, problems)?;
        data.sort_by_key(|at| at.stamp_ns);
        for ground_truth in opened.index(&opened.ground_truth.0, problems)? {
            let after = data.partition_point(|at| at.stamp_ns < ground_truth.stamp_ns);
            let near =
                [after.checked_sub(1), Some(after)].into_iter().flatten().filter_map(|at| data.get(at));
            let distance = |at: &&At| at.stamp_ns.saturating_sub(ground_truth.stamp_ns).saturating_abs();
            if let Some(nearest) = near.min_by_key(distance).filter(|at| distance(at) <= SLOP_NS) {
                opened.samples.push(Pair { data: *nearest, ground_truth });
            } else {
                let message = Error::invalid_input(format!(
                    "{} has no message within 20 ms of the stamp",
                    opened.data.0.name
                ));
                opened.problem(&opened.ground_truth.0, ground_truth.log_time_ns, &message, problems)?;
            }
        }
        opened.classes = opened.find_classes().context(|| path.display().to_string())?;
        Ok(opened)
    }
}

#[cfg(test)]
mod tests;
