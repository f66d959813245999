//! Matching of the classes of predictions with those of a data set, by name.

mod annotated;
mod report;
mod synonyms;

use std::collections::{BTreeMap, HashMap};

use opendr_engine::target::{Category, Classes, Heatmap, HeatmapValues, Name};
use opendr_engine::{Error, Result, Value};
use opendr_metrics::LABEL_DIVISOR;
use serde::{Deserialize, Serialize};

pub(crate) use annotated::{AnnotatedClasses, annotated_classes};
pub use report::{ByNumber, ClassPair, ClassReport};
pub use synonyms::MatchedBy;

use report::listed;
use synonyms::{find, plain};

/// A user's settings of the class matching.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClassMatching {
    /// Maps classes of the learner to classes of the data set; takes precedence over names.
    pub pairs: BTreeMap<String, String>,
    /// Whether classes are compared by number, regardless of their names.
    pub by_number: bool,
}

/// Meaning of the labels of a class map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapLabels {
    /// Class numbers.
    Classes,
    /// [`LABEL_DIVISOR`] times the class, plus the instance number.
    Segments,
}

/// Maps the classes of categories and their probabilities, semantic and panoptic maps, boxes, 3D boxes and tracks.
/// (Poses are compared by the names of their keypoints, see `opendr_metrics`.)
///
/// Classes are matched by the user's pairs, by name (ignoring case, spaces, hyphens and underscores), by
/// published synonyms, and by published groupings of finer classes. Classes are compared by number only if one side has no names or the
/// user requests it.
#[derive(Debug, Clone)]
pub struct ClassMap {
    dataset: Classes,
    learner: Classes,
    matching: ClassMatching,
    /// Label of pixels whose class the data set does not have.
    no_class: u32,
    map_labels: MapLabels,
    /// Index in the data set of each label of the predictions.
    known: HashMap<String, Option<usize>>,
    pairs: Vec<ClassPair>,
    learner_only: Vec<String>,
    /// Whether a prediction had no name, so that its number was compared.
    has_unnamed: bool,
}

/// Match of a predicted class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ClassMatch {
    /// A class of the data set.
    Class(i64),
    /// None: the index among the learner's classes that the data set does not have.
    Unmatched(usize),
}

impl ClassMap {
    /// Creates a map to the classes `dataset`. `learner` are those of the learner, if known before its predictions.
    ///
    /// # Errors
    /// `InvalidParam` for a pair with a class that its side does not have.
    pub fn new(learner: Classes, dataset: Classes, matching: &ClassMatching) -> Result<Self> {
        let mut map = Self {
            dataset,
            learner: learner.clone(),
            matching: matching.clone(),
            no_class: Heatmap::NO_CLASS,
            map_labels: MapLabels::Classes,
            known: HashMap::new(),
            pairs: Vec::new(),
            learner_only: Vec::new(),
            has_unnamed: false,
        };
        map.check_pairs()?;
        map.learn(&learner);
        Ok(map)
    }

    /// Sets the meaning of the labels of maps.
    #[must_use]
    pub fn with_labels(self, map_labels: MapLabels) -> Self {
        Self { map_labels, ..self }
    }

    /// Sets the label of pixels whose class the data set does not have.
    #[must_use]
    pub fn with_no_class(self, no_class: u32) -> Self {
        Self { no_class, ..self }
    }

    fn check_pairs(&self) -> Result<()> {
        let has = |classes: &Classes, wanted: &str| classes.iter().any(|class| plain(class) == plain(wanted));
        for (learner, dataset) in &self.matching.pairs {
            let sides = [("learner", &self.learner, learner), ("data set", &self.dataset, dataset)];
            if let Some((side, classes, name)) =
                sides.into_iter().find(|(_, classes, name)| !classes.is_empty() && !has(classes, name))
            {
                let there: Vec<_> = classes.iter().collect();
                return Err(Error::invalid_param(format!(
                    "the {side} has no class {name:?}; its classes are {}",
                    listed(&there)
                )));
            }
        }
        Ok(())
    }

    /// Looks up all names of a list, so that missing classes are known before the first prediction.
    fn learn(&mut self, classes: &Classes) {
        if !self.dataset.is_empty() && !self.matching.by_number {
            for label in classes.iter() {
                self.place_of(label);
            }
        }
    }

    /// Returns the index of a class in the data set.
    fn place_of(&mut self, label: &str) -> Option<usize> {
        if let Some(place) = self.known.get(label) {
            return *place;
        }
        let pair = self.matching.pairs.iter().find(|(learner, _)| plain(learner) == plain(label));
        let found = match pair {
            Some((_, wanted)) => {
                let place = self.dataset.iter().position(|class| plain(class) == plain(wanted));
                place.map(|place| (place, MatchedBy::Pair))
            }
            None => find(label, self.dataset.iter()),
        };
        match found {
            Some((place, by)) => {
                let dataset =
                    self.dataset.name(place as i64).map(|name| name.to_string()).unwrap_or_default();
                self.pairs.push(ClassPair { learner: label.to_owned(), dataset, by });
            }
            None => self.learner_only.push(label.to_owned()),
        }
        let place = found.map(|(place, _)| place);
        self.known.insert(label.to_owned(), place);
        place
    }

    /// Returns the match of the class `name` of a prediction with the classes `own`.
    fn match_class(&mut self, name: &Name, own: &Classes) -> ClassMatch {
        let number = |name: &Name| match name {
            Name::Index(index) => Some(*index),
            Name::Label(_) => None,
        };
        if self.matching.by_number {
            let index = number(name).or_else(|| own.index(own.label(name)?));
            return index.map_or(ClassMatch::Unmatched(0), ClassMatch::Class);
        }
        let own = if own.is_empty() { self.learner.clone() } else { own.clone() };
        let label = match (own.label(name), name) {
            (Some(label), _) => label.to_owned(),
            // Some classes are named, this one is not.
            (None, Name::Index(index)) if !own.is_empty() => format!("class {index}"),
            (None, Name::Index(index)) => {
                // Without a name, a pair can still map the number.
                let label = index.to_string();
                if !self.matching.pairs.contains_key(&label) {
                    self.has_unnamed = true;
                    return ClassMatch::Class(*index);
                }
                label
            }
            (None, Name::Label(label)) => label.to_string(),
        };
        match self.place_of(&label) {
            Some(place) => ClassMatch::Class(place as i64),
            None => {
                ClassMatch::Unmatched(self.learner_only.iter().position(|other| *other == label).unwrap_or(0))
            }
        }
    }

    /// Returns the number of a class in the data set; `None` when the data set does not have it.
    pub fn index(&mut self, name: &Name, own: &Classes) -> Option<i64> {
        match self.match_class(name, own) {
            ClassMatch::Class(index) => Some(index),
            ClassMatch::Unmatched(_) => None,
        }
    }

    /// Converts a prediction to the classes of the data set. Objects of other classes are dropped, since the data set has no ground
    /// ground truth for them. Pixels of other classes get no class, and a category gets one after those of the data set.
    ///
    /// # Errors
    /// `InvalidInput` when the numbers of a category's probabilities and of the learner's classes differ.
    pub fn apply(&mut self, prediction: &mut Value) -> Result<()> {
        if self.dataset.is_empty() && !self.matching.by_number {
            return Ok(());
        }
        match prediction {
            Value::BoundingBoxList(list) => {
                let own = self.replace_classes(&mut list.classes);
                list.boxes.retain_mut(|found| self.rename(&mut found.name, &own));
            }
            Value::TrackingAnnotationList(list) => {
                let own = self.replace_classes(&mut list.classes);
                list.annotations.retain_mut(|track| self.rename(&mut track.bounding_box.name, &own));
            }
            Value::BoundingBox3DList(list) => {
                let own = self.replace_classes(&mut list.classes);
                list.boxes.retain_mut(|found| self.rename(&mut found.name, &own));
            }
            Value::TrackingAnnotation3DList(list) => {
                let own = self.replace_classes(&mut list.classes);
                list.annotations.retain_mut(|track| self.rename(&mut track.bounding_box_3d.name, &own));
            }
            Value::Category(category) => self.apply_to_category(category)?,
            Value::Heatmap(map) => self.apply_to_map(map)?,
            _ => {}
        }
        Ok(())
    }

    /// Replaces the classes of a list by those of the data set, if it has names, and returns the original ones.
    fn replace_classes(&mut self, classes: &mut Classes) -> Classes {
        let own = std::mem::replace(classes, self.dataset.clone());
        self.learn(&own);
        own
    }

    fn rename(&mut self, name: &mut Name, own: &Classes) -> bool {
        let index = self.index(name, own);
        if let Some(index) = index {
            *name = Name::Index(index);
        }
        index.is_some()
    }

    fn apply_to_category(&mut self, category: &mut Category) -> Result<()> {
        let own = self.learner.clone();
        let name = match &category.description {
            Some(label) if own.is_empty() => Name::Label(label.clone()),
            _ => Name::Index(category.class),
        };
        if self.matching.by_number {
            category.description = self.dataset.name(category.class).cloned();
            return Ok(());
        }
        let has_names = !own.is_empty() || matches!(name, Name::Label(_));
        let count = category.probabilities.len();
        if has_names && count > 0 {
            if own.is_empty() {
                // The classes of the probabilities are unknown.
                category.probabilities.clear();
            } else if own.len() == count {
                category.probabilities = self.mapped_probabilities(&category.probabilities, &own);
            } else {
                return Err(Error::invalid_input(format!(
                    "the learner has {} classes and {count} probabilities; it must return one per class",
                    own.len()
                )));
            }
        }
        match self.match_class(&name, &own) {
            ClassMatch::Class(index) => {
                category.class = index;
                if let Some(label) = self.dataset.name(index) {
                    category.description = Some(label.clone());
                }
            }
            ClassMatch::Unmatched(place) => {
                category.class = (self.dataset.len() + place) as i64;
                category.description = own.label(&name).map(Into::into).or(category.description.take());
            }
        }
        Ok(())
    }

    /// Returns the probabilities of the data set's classes, followed by those of the learner's other classes. Those of
    /// several classes of the learner for one of the data set are added.
    fn mapped_probabilities(&mut self, probabilities: &[f32], own: &Classes) -> Vec<f32> {
        let mut mapped = vec![0.0; self.dataset.len() + self.learner_only.len()];
        for (class, probability) in (0..).zip(probabilities) {
            let place = match self.match_class(&Name::Index(class), own) {
                ClassMatch::Class(index) => usize::try_from(index).ok(),
                ClassMatch::Unmatched(place) => Some(self.dataset.len() + place),
            };
            if let Some(sum) = place.and_then(|place| mapped.get_mut(place)) {
                *sum += probability;
            }
        }
        mapped
    }

    fn apply_to_map(&mut self, map: &mut Heatmap) -> Result<()> {
        if self.matching.by_number {
            return Ok(());
        }
        let own = if map.classes.is_empty() { self.learner.clone() } else { map.classes.clone() };
        let is_map_of_classes = match map.values() {
            HeatmapValues::Labels(_) => true,
            // Scores of every class become the class of the highest.
            HeatmapValues::Scores(_) => matches!(map.shape(), [classes, _, _] if *classes == own.len()),
        };
        if !is_map_of_classes {
            return Ok(());
        }
        if own.is_empty() {
            self.has_unnamed = true;
            return Ok(());
        }
        self.learn(&own);
        let (labels, shape) = map.class_labels()?;
        let mapped = match self.map_labels {
            MapLabels::Classes => self.mapped_classes(&labels, &own),
            MapLabels::Segments => self.mapped_segments(&labels, &own),
        };
        let shape = shape.to_vec();
        drop(labels);
        map.labels_mut(&shape).copy_from_slice(&mapped);
        map.classes = self.dataset.clone();
        Ok(())
    }

    fn mapped_label(&mut self, class: u32, own: &Classes) -> Option<u32> {
        // A label that is not a class of the learner, such as 255 for unknown, has none in the data set.
        own.name(class.into())?;
        self.index(&Name::Index(class.into()), own).and_then(|index| u32::try_from(index).ok())
    }

    fn mapped_classes(&mut self, labels: &[u32], own: &Classes) -> Vec<u32> {
        let table: Vec<u32> = (0..own.len() as u32)
            .map(|class| self.mapped_label(class, own).unwrap_or(self.no_class))
            .collect();
        labels.iter().map(|label| table.get(*label as usize).copied().unwrap_or(self.no_class)).collect()
    }

    /// Renumbers instances, since several classes of the learner may map to one of the data set.
    fn mapped_segments(&mut self, labels: &[u32], own: &Classes) -> Vec<u32> {
        let mut mapped = HashMap::<u32, u32>::new();
        let mut objects = HashMap::<u32, u32>::new();
        let mut last = None;
        labels
            .iter()
            .map(|label| {
                if let Some((same, result)) = last.filter(|(same, _)| same == label) {
                    let _: u32 = same;
                    return result;
                }
                let result = *mapped.entry(*label).or_insert_with(|| {
                    let Some(class) = self.mapped_label(label / LABEL_DIVISOR, own) else {
                        return self.no_class;
                    };
                    if label % LABEL_DIVISOR == 0 {
                        return class * LABEL_DIVISOR;
                    }
                    let number = objects.entry(class).or_default();
                    // Instances beyond the maximum number share the last one.
                    *number = (*number + 1).min(LABEL_DIVISOR - 1);
                    class * LABEL_DIVISOR + *number
                });
                last = Some((*label, result));
                result
            })
            .collect()
    }

    /// Returns whether a class index is beyond those of the data set: the index of a class that the data set does not have.
    pub fn is_beyond(&self, class: i64) -> bool {
        !self.dataset.is_empty() && !self.matching.by_number && class >= self.dataset.len() as i64
    }

    /// Returns the map that was used.
    pub fn report(&self) -> ClassReport {
        let names_nothing = self.pairs.is_empty() && self.learner_only.is_empty();
        let by_number = match () {
            () if self.matching.by_number => Some(ByNumber::Requested),
            () if self.dataset.is_empty() => Some(ByNumber::DatasetUnnamed),
            () if names_nothing && self.has_unnamed => Some(ByNumber::LearnerUnnamed),
            () => None,
        };
        if by_number.is_some() {
            return ClassReport { by_number, ..ClassReport::default() };
        }
        let is_matched = |class: &str| self.pairs.iter().any(|pair| pair.dataset == class);
        let unmatched = self.dataset.iter().filter(|class| !is_matched(class)).map(str::to_owned);
        ClassReport {
            by_number,
            pairs: self.pairs.clone(),
            learner_only: self.learner_only.clone(),
            dataset_only: if names_nothing { Vec::new() } else { unmatched.collect() },
        }
    }

    /// Checks that learner and data set have enough classes in common. `annotated` are the classes that occur in the annotations, where
    /// known: classes that a data set names and never uses do not count.
    ///
    /// # Errors
    /// `InvalidInput`, with the names of both sides, when the learner has classes that the data set does not have, and less than half of
    /// the data set's classes are matched. (A learner whose classes all match may have few of them.) `remedy` is the
    /// advice to the user.
    pub fn check(&self, annotated: Option<&[usize]>, remedy: &str) -> Result<()> {
        let report = self.report();
        if report.by_number.is_some() || report.learner_only.is_empty() || !self.matching.pairs.is_empty() {
            return Ok(());
        }
        let counted: Vec<&str> = match annotated {
            Some(classes) => classes
                .iter()
                .filter_map(|class| self.dataset.name(*class as i64))
                .map(AsRef::as_ref)
                .collect(),
            None => self.dataset.iter().collect(),
        };
        let matched =
            counted.iter().filter(|class| report.pairs.iter().any(|pair| pair.dataset == **class)).count();
        if matched * 2 >= counted.len() {
            return Ok(());
        }
        let learner: Vec<&str> = match self.learner.is_empty() {
            true => report
                .pairs
                .iter()
                .map(|pair| pair.learner.as_str())
                .chain(report.learner_only.iter().map(String::as_str))
                .collect(),
            false => self.learner.iter().collect(),
        };
        Err(Error::invalid_input(format!(
            "only {matched} of {} classes of the data set match one of the learner by name.\n  learner: {}\n  data set: {}\n{remedy}",
            counted.len(),
            listed(&learner),
            listed(&counted)
        )))
    }
}

#[cfg(test)]
mod tests;
