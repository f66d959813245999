//! From a learner's classes to those of a data set, by their names.

use opendr_engine::Value;
use opendr_engine::target::{Classes, Name};

/// Words for the same thing in the data sets of the field: COCO, Pascal VOC, KITTI, Cityscapes, Open Images.
const SYNONYMS: &[&[&str]] = &[
    &["airplane", "aeroplane"],
    &["bicycle", "bike", "cyclist"],
    &["couch", "sofa"],
    &["dining table", "diningtable"],
    &["motorcycle", "motorbike"],
    &["person", "pedestrian", "people", "human"],
    &["potted plant", "pottedplant"],
    &["tv", "tvmonitor", "tv monitor", "television"],
];

/// What the classes of a learner's answers are called in a data set, by number.
///
/// Names are compared without case, spaces, hyphens and underscores, then by synonyms. Where the data set names no
/// classes, or an answer has neither name nor label, numbers stand for themselves.
#[derive(Debug, Clone, Default)]
pub struct ClassMap {
    of_dataset: Classes,
}

impl ClassMap {
    /// To the classes of a data set.
    pub fn to(of_dataset: Classes) -> Self {
        Self { of_dataset }
    }

    /// The number of a class in the data set; `None` when the data set does not have it.
    pub fn index(&self, name: &Name, classes: &Classes) -> Option<i64> {
        match classes.label(name) {
            Some(label) if !self.of_dataset.is_empty() => self.index_of_label(label),
            _ => match name {
                Name::Index(index) => Some(*index),
                Name::Label(_) => None,
            },
        }
    }

    fn index_of_label(&self, label: &str) -> Option<i64> {
        let plain = plain(label);
        let named = |wanted: &str| self.of_dataset.iter().position(|class| self::plain(class) == wanted);
        let synonym = || {
            let words = SYNONYMS.iter().find(|words| words.iter().any(|word| self::plain(word) == plain))?;
            words.iter().find_map(|word| named(&self::plain(word)))
        };
        named(&plain).or_else(synonym).map(|index| index as i64)
    }

    /// Renames the classes of an answer; objects of classes that the data set does not have are left out, since it
    /// cannot tell whether they are right.
    pub fn apply(&self, answer: &mut Value) {
        match answer {
            Value::BoundingBoxList(list) => {
                let classes = std::mem::replace(&mut list.classes, self.of_dataset.clone());
                list.boxes.retain_mut(|found| self.rename(&mut found.name, &classes));
            }
            Value::TrackingAnnotationList(list) => {
                let classes = std::mem::replace(&mut list.classes, self.of_dataset.clone());
                list.annotations.retain_mut(|track| self.rename(&mut track.bounding_box.name, &classes));
            }
            Value::BoundingBox3DList(list) => {
                let classes = std::mem::replace(&mut list.classes, self.of_dataset.clone());
                list.boxes.retain_mut(|found| self.rename(&mut found.name, &classes));
            }
            Value::Category(category) => {
                let label = category.description.as_deref().filter(|_| category.probabilities.is_empty());
                if let Some(index) = label.and_then(|label| self.index_of_label(label)) {
                    category.class = index;
                }
            }
            _ => {}
        }
    }

    fn rename(&self, name: &mut Name, classes: &Classes) -> bool {
        match self.index(name, classes) {
            Some(index) => {
                *name = Name::Index(index);
                true
            }
            None => false,
        }
    }
}

/// Letters and digits in lower case.
fn plain(label: &str) -> String {
    label.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::target::{BoundingBox, BoundingBoxList};

    #[test]
    fn by_name_by_synonym_or_by_number() {
        let map = ClassMap::to(["cat", "Person", "traffic light", "aeroplane"].into_iter().collect());
        let of_learner: Classes = ["pedestrian", "traffic_light", "airplane", "kite"].into_iter().collect();
        let index = |at: i64| map.index(&Name::Index(at), &of_learner);
        assert_eq!([index(0), index(1), index(2), index(3)], [Some(1), Some(2), Some(3), None]);
        assert_eq!(map.index(&Name::from("CAT"), &Classes::default()), Some(0));
        assert_eq!(map.index(&Name::Index(7), &Classes::default()), Some(7));
        assert_eq!(ClassMap::default().index(&Name::Index(2), &of_learner), Some(2));
    }

    #[test]
    fn objects_of_other_classes_are_left_out() {
        let map = ClassMap::to(["cat"].into_iter().collect());
        let boxes = ["dog", "cat"].map(|name| BoundingBox::new(name, 0.0, 0.0, 1.0, 1.0, 0.5));
        let mut answer = Value::from(BoundingBoxList::from(boxes.to_vec()));
        map.apply(&mut answer);
        let Value::BoundingBoxList(list) = answer else { panic!("another type") };
        assert_eq!((list.boxes.len(), &list.boxes[0].name), (1, &Name::Index(0)));
    }
}
