//! The classes that occur in the annotations of a data set.

use std::collections::{BTreeMap, BTreeSet};

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::{Classes, Name};
use opendr_engine::{Value, ValueType};

use super::synonyms::plain;

/// Maximum number of samples whose annotations are read, spaced evenly over the data set.
const MAX_SAMPLES: usize = 2000;
/// Maximum number of classes from numbered descriptions.
const MAX_CLASSES: i64 = 1 << 16;
/// Labels of regions that do not count, in normalised spelling.
const NO_CLASS: [&str; 3] = ["dontcare", "ignored", "void"];

/// The classes of a data set, and which of them are annotated.
pub(crate) struct AnnotatedClasses {
    /// The classes that it names, or else those that its annotations name.
    pub classes: Classes,
    /// Indices of those that occur; `None` where that would need reading every image.
    pub occurring: Option<Vec<usize>>,
}

/// Reads the classes of a data set whose targets have this type.
pub(crate) fn annotated_classes(dataset: &dyn DatasetIterator, target: ValueType) -> AnnotatedClasses {
    let classes = dataset.classes();
    if !reads_quickly(target) || dataset.is_empty() {
        return AnnotatedClasses { classes, occurring: None };
    }
    let step = dataset.len().div_ceil(MAX_SAMPLES);
    let (mut numbers, mut labels, mut described) = (BTreeSet::new(), BTreeSet::new(), BTreeMap::new());
    for at in (0..dataset.len()).step_by(step) {
        // Broken samples are reported when they are evaluated.
        let Ok(Some(target)) = dataset.target(at) else { continue };
        let mut add = |name: &Name, own: &Classes| match (own.label(name), name) {
            (Some(label), _) => drop(labels.insert(label.to_owned())),
            (None, Name::Index(index)) => drop(numbers.insert(*index)),
            (None, Name::Label(label)) => drop(labels.insert(label.to_string())),
        };
        match &target {
            Value::BoundingBoxList(list) => {
                list.boxes.iter().for_each(|found| add(&found.name, &list.classes));
            }
            Value::BoundingBox3DList(list) => {
                list.boxes.iter().for_each(|found| add(&found.name, &list.classes));
            }
            Value::TrackingAnnotationList(list) => {
                list.annotations.iter().for_each(|track| add(&track.bounding_box.name, &list.classes));
            }
            Value::TrackingAnnotation3DList(list) => {
                list.annotations.iter().for_each(|track| add(&track.bounding_box_3d.name, &list.classes));
            }
            Value::Category(category) => {
                numbers.insert(category.class);
                if let Some(label) = &category.description {
                    described.insert(category.class, label.to_string());
                }
            }
            _ => {}
        }
    }
    labels.retain(|label| !NO_CLASS.contains(&plain(label).as_str()));
    let classes = match (classes.is_empty(), labels.is_empty()) {
        (false, _) => classes,
        (true, false) => labels.iter().map(String::as_str).collect(),
        (true, true) => numbered(&described),
    };
    let of_number = numbers.iter().filter_map(|number| usize::try_from(*number).ok());
    let of_label = labels.iter().filter_map(|label| usize::try_from(classes.index(label)?).ok());
    let mut occurring: Vec<usize> =
        of_number.chain(of_label).filter(|place| *place < classes.len()).collect();
    occurring.sort_unstable();
    occurring.dedup();
    AnnotatedClasses { classes, occurring: Some(occurring).filter(|places| !places.is_empty()) }
}

/// Returns whether annotations are read without decoding images.
fn reads_quickly(target: ValueType) -> bool {
    matches!(
        target,
        ValueType::BoundingBoxList
            | ValueType::BoundingBox3DList
            | ValueType::Category
            | ValueType::TrackingAnnotationList
            | ValueType::TrackingAnnotation3DList
    )
}

/// Returns the list of descriptions by number.
fn numbered(described: &BTreeMap<i64, String>) -> Classes {
    let Some((last, _)) = described.last_key_value().filter(|(last, _)| (0..MAX_CLASSES).contains(*last))
    else {
        return Classes::default();
    };
    (0..=*last)
        .map(|class| described.get(&class).cloned().unwrap_or_else(|| format!("class {class}")))
        .collect()
}
