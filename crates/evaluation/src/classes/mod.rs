//! From the classes of predictions to those of a data set, by their names.

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

/// What a user may say about classes.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClassMatching {
    /// Classes of the data set by classes of the learner; they go before names.
    pub pairs: BTreeMap<String, String>,
    /// Whether numbers are compared, whatever the names are.
    pub by_number: bool,
}

/// What the labels of a map of classes mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapLabels {
    /// Class numbers.
    Classes,
    /// [`LABEL_DIVISOR`] times the class, plus the number of the object.
    Segments,
}

/// The one place that maps classes: of categories and their probabilities, maps of classes and of segments, boxes, boxes in space
/// and tracks. (Poses are compared by the names of their joints, see `opendr_metrics`.)
///
/// Classes are matched by the pairs that the user gave, by name (without case, spaces, hyphens and underscores), by the
/// published synonyms, and by a published grouping of finer classes. Only where one side names no class at all, or the user
/// asks for it, numbers are compared.
#[derive(Debug, Clone)]
pub struct ClassMap {
    dataset: Classes,
    learner: Classes,
    matching: ClassMatching,
    /// Label of a pixel whose class the data set does not have.
    no_class: u32,
    map_labels: MapLabels,
    /// Where each label of a prediction is found in the data set.
    known: HashMap<String, Option<usize>>,
    pairs: Vec<ClassPair>,
    learner_only: Vec<String>,
    /// Whether a prediction had no name, so that its number was compared.
    has_unnamed: bool,
}

/// What a class of a prediction is in the data set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Found {
    /// This class.
    Class(i64),
    /// None: the place among the learner's classes that the data set does not have.
    Unmatched(usize),
}

impl ClassMap {
    /// A map to the classes `dataset`. `learner` are those of the learner where they are known before its predictions.
    ///
    /// # Errors
    /// `InvalidParam` for a pair whose class neither side has.
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

    /// The same map for maps of segments.
    #[must_use]
    pub fn with_labels(self, map_labels: MapLabels) -> Self {
        Self { map_labels, ..self }
    }

    /// The same map, with a label of its own for pixels whose class the data set does not have.
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
                    "the {side} has no class {name:?}; there are {}",
                    listed(&there)
                )));
            }
        }
        Ok(())
    }

    /// Looks every name of a list up, so that what is missing is known before the first prediction.
    fn learn(&mut self, classes: &Classes) {
        if !self.dataset.is_empty() && !self.matching.by_number {
            for label in classes.iter() {
                self.place_of(label);
            }
        }
    }

    /// The place of a class among those of the data set.
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

    /// What the class `name` of a prediction that names the classes `own` is in the data set.
    fn found(&mut self, name: &Name, own: &Classes) -> Found {
        let number = |name: &Name| match name {
            Name::Index(index) => Some(*index),
            Name::Label(_) => None,
        };
        if self.matching.by_number {
            let index = number(name).or_else(|| own.index(own.label(name)?));
            return index.map_or(Found::Unmatched(0), Found::Class);
        }
        let own = if own.is_empty() { self.learner.clone() } else { own.clone() };
        let label = match (own.label(name), name) {
            (Some(label), _) => label.to_owned(),
            // Some are named, this one is not.
            (None, Name::Index(index)) if !own.is_empty() => format!("class {index}"),
            (None, Name::Index(index)) => {
                // Without a name on this side a pair can still say what a number means.
                let label = index.to_string();
                if !self.matching.pairs.contains_key(&label) {
                    self.has_unnamed = true;
                    return Found::Class(*index);
                }
                label
            }
            (None, Name::Label(label)) => label.to_string(),
        };
        match self.place_of(&label) {
            Some(place) => Found::Class(place as i64),
            None => Found::Unmatched(self.learner_only.iter().position(|other| *other == label).unwrap_or(0)),
        }
    }

    /// Returns the number of a class in the data set; `None` when the data set does not have it.
    pub fn index(&mut self, name: &Name, own: &Classes) -> Option<i64> {
        match self.found(name, own) {
            Found::Class(index) => Some(index),
            Found::Unmatched(_) => None,
        }
    }

    /// Puts a prediction into the classes of the data set. Objects of classes that the data set does not have are left out, since it
    /// cannot tell whether they are right; pixels become no class, and a category one behind those of the data set.
    ///
    /// # Errors
    /// `InvalidInput` when a category has probabilities of other classes than the learner names.
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

    /// Gives a list the names of the data set, where it has some, and returns its own.
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
                // What the single probabilities are of is not said.
                category.probabilities.clear();
            } else if own.len() == count {
                category.probabilities = self.mapped_probabilities(&category.probabilities, &own);
            } else {
                return Err(Error::invalid_input(format!(
                    "the learner names {} classes and gives {count} probabilities; one of each class is needed",
                    own.len()
                )));
            }
        }
        match self.found(&name, &own) {
            Found::Class(index) => {
                category.class = index;
                if let Some(label) = self.dataset.name(index) {
                    category.description = Some(label.clone());
                }
            }
            Found::Unmatched(place) => {
                category.class = (self.dataset.len() + place) as i64;
                category.description = own.label(&name).map(Into::into).or(category.description.take());
            }
        }
        Ok(())
    }

    /// Probabilities by the classes of the data set, then by those of the learner that the data set does not have. What several
    /// classes of the learner give to one of the data set is added.
    fn mapped_probabilities(&mut self, probabilities: &[f32], own: &Classes) -> Vec<f32> {
        let mut mapped = vec![0.0; self.dataset.len() + self.learner_only.len()];
        for (class, probability) in (0..).zip(probabilities) {
            let place = match self.found(&Name::Index(class), own) {
                Found::Class(index) => usize::try_from(index).ok(),
                Found::Unmatched(place) => Some(self.dataset.len() + place),
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
            // Scores of every class: the class of the highest.
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
        // A label that is no class of the learner's, such as 255 where nothing is known, is none of the data set's.
        own.name(class.into())?;
        self.index(&Name::Index(class.into()), own).and_then(|index| u32::try_from(index).ok())
    }

    fn mapped_classes(&mut self, labels: &[u32], own: &Classes) -> Vec<u32> {
        let table: Vec<u32> = (0..own.len() as u32)
            .map(|class| self.mapped_label(class, own).unwrap_or(self.no_class))
            .collect();
        labels.iter().map(|label| table.get(*label as usize).copied().unwrap_or(self.no_class)).collect()
    }

    /// Segments of one class of the learner may meet those of another in one class of the data set: objects are numbered anew.
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
                    // A picture with more objects of a class than labels can say shares the last number.
                    *number = (*number + 1).min(LABEL_DIVISOR - 1);
                    class * LABEL_DIVISOR + *number
                });
                last = Some((*label, result));
                result
            })
            .collect()
    }

    /// Whether a class number stands behind those of the data set: for a class that it does not have.
    pub fn is_beyond(&self, class: i64) -> bool {
        !self.dataset.is_empty() && !self.matching.by_number && class >= self.dataset.len() as i64
    }

    /// The map that was used.
    pub fn report(&self) -> ClassReport {
        let names_nothing = self.pairs.is_empty() && self.learner_only.is_empty();
        let by_number = match () {
            () if self.matching.by_number => Some(ByNumber::Asked),
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

    /// Checks that learner and data set speak of the same things. `annotated` are the classes that the annotations have, where they
    /// are known: classes that a data set names and never uses do not count.
    ///
    /// # Errors
    /// `InvalidInput`, with the names of both, when the learner has classes that the data set does not have, and less than half of
    /// the data set's classes are matched. (A learner all of whose classes are matched knows few things, but no others.) `remedy` says
    /// what the user can do.
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
