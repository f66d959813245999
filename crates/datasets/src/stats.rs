//! Statistics of a data set.

use std::collections::BTreeMap;
use std::fmt;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::Name;
use opendr_engine::{JsonFormat, Progress, Result, Unit, Value};
use serde::Serialize;

use crate::{Problem, Problems};

/// Counts of one class.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ClassCount {
    /// Number of annotations.
    pub annotations: u64,
    /// Number of samples with annotations of the class.
    pub samples: u64,
}

/// Minimum, mean and maximum of a quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Spread {
    /// Minimum.
    pub min: f64,
    /// Mean.
    pub mean: f64,
    /// Maximum.
    pub max: f64,
    #[serde(skip)]
    count: u64,
}

impl Default for Spread {
    fn default() -> Self {
        Self { min: f64::INFINITY, mean: 0.0, max: f64::NEG_INFINITY, count: 0 }
    }
}

impl Spread {
    fn add(&mut self, value: f64) {
        if value.is_finite() {
            self.count += 1;
            self.mean += (value - self.mean) / self.count as f64;
            self.min = self.min.min(value);
            self.max = self.max.max(value);
        }
    }

    fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// Statistics of a data set. `Display` prints a table.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct DatasetStats {
    /// Number of samples.
    pub samples: u64,
    /// Number of samples without annotation.
    pub without_annotation: u64,
    /// Number of annotations.
    pub annotations: u64,
    /// Number of sequences (videos, drives), if samples are frames.
    pub sequences: u64,
    /// Counts by class.
    pub classes: BTreeMap<String, ClassCount>,
    /// Image width in pixels.
    #[serde(skip_serializing_if = "Spread::is_empty")]
    pub image_width: Spread,
    /// Image height in pixels.
    #[serde(skip_serializing_if = "Spread::is_empty")]
    pub image_height: Spread,
    /// Square root of the area of boxes in pixels.
    #[serde(skip_serializing_if = "Spread::is_empty")]
    pub box_side: Spread,
    /// Number of boxes by COCO's sizes: below 32x32, below 96x96, larger.
    pub small_medium_large: [u64; 3],
}

impl DatasetStats {
    /// Format of the statistics as JSON. Version 2 renamed `picture_width` and `picture_height` to `image_...`.
    pub const FORMAT: JsonFormat = JsonFormat::new("statistics of a data set", 2);

    /// Counts a data set; images are read only if the format requires it.
    ///
    /// # Errors
    /// The error of the first sample that cannot be read, unless `problems` skips it.
    pub fn of(dataset: &dyn DatasetIterator, problems: &Problems, progress: &dyn Progress) -> Result<Self> {
        let mut stats = Self::default();
        let names = dataset.classes();
        let mut sequence = None;
        progress.begin("counting", Some(dataset.len() as u64), Unit::Items);
        for at in (0..dataset.len()).take_while(|_| !progress.stopped()) {
            progress.advance(1);
            stats.samples += 1;
            if dataset.sequence(at).is_some() && dataset.sequence(at) != sequence {
                sequence = dataset.sequence(at);
                stats.sequences += 1;
            }
            if let Some([width, height]) = dataset.image_size(at) {
                stats.image_width.add(width.into());
                stats.image_height.add(height.into());
            }
            match dataset.target(at) {
                Ok(target) => stats.count(target.as_ref(), &|name| label(name, &names)),
                Err(error) => {
                    problems.report(Problem::of(&error, dataset, at))?;
                }
            }
        }
        progress.end();
        Ok(stats)
    }

    fn count(&mut self, target: Option<&Value>, label: &dyn Fn(&Name) -> String) {
        let mut here = BTreeMap::<String, u64>::new();
        let mut add = |name: String| *here.entry(name).or_default() += 1;
        match target {
            Some(Value::BoundingBoxList(list)) => list.boxes.iter().for_each(|found| {
                add(label(&found.name));
                self.add_box(f64::from(found.area()));
            }),
            Some(Value::TrackingAnnotationList(list)) => list.annotations.iter().for_each(|track| {
                add(label(&track.bounding_box.name));
                self.add_box(f64::from(track.bounding_box.area()));
            }),
            Some(Value::BoundingBox3DList(list)) => {
                list.boxes.iter().for_each(|found| add(label(&found.name)));
            }
            Some(Value::PoseList(list)) => list.poses.iter().for_each(|_| add("person".to_owned())),
            Some(Value::Category(category)) => add(match &category.description {
                Some(description) => description.to_string(),
                None => label(&Name::Index(category.class)),
            }),
            Some(_) => add("annotation".to_owned()),
            None => {}
        }
        self.without_annotation += u64::from(here.is_empty());
        for (name, count) in here {
            self.annotations += count;
            let class = self.classes.entry(name).or_default();
            class.annotations += count;
            class.samples += 1;
        }
    }

    fn add_box(&mut self, area: f64) {
        self.box_side.add(area.sqrt());
        self.small_medium_large[usize::from(area >= 32.0 * 32.0) + usize::from(area >= 96.0 * 96.0)] += 1;
    }
}

fn label(name: &Name, classes: &opendr_engine::target::Classes) -> String {
    classes.label(name).map_or_else(|| format!("class {name}"), str::to_owned)
}

impl fmt::Display for DatasetStats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} samples, {} annotations", self.samples, self.annotations)?;
        if self.sequences > 0 {
            write!(f, ", {} sequences", self.sequences)?;
        }
        writeln!(f, ", {} samples without any", self.without_annotation)?;
        for (what, spread) in [
            ("image width", &self.image_width),
            ("image height", &self.image_height),
            ("box side", &self.box_side),
        ] {
            if !spread.is_empty() {
                writeln!(f, "{what:14}  {:.0} to {:.0} px, mean {:.0}", spread.min, spread.max, spread.mean)?;
            }
        }
        let [small, medium, large] = self.small_medium_large;
        if small + medium + large > 0 {
            writeln!(f, "boxes           {small} small, {medium} medium, {large} large")?;
        }
        let mut classes: Vec<_> = self.classes.iter().collect();
        classes.sort_by_key(|(_, class)| std::cmp::Reverse(class.annotations));
        let width = classes.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0).max(5);
        writeln!(f, "\n{:width$}  {:>11}  {:>8}", "class", "annotations", "samples")?;
        for (name, ClassCount { annotations, samples }) in classes {
            writeln!(f, "{name:width$}  {annotations:>11}  {samples:>8}")?;
        }
        Ok(())
    }
}
