//! Category ids of COCO, which have gaps, and the class indices of targets, which have none.

use opendr_engine::target::Classes;

use super::record::CategoryRecord;

/// The categories of a data set in the order of their ids, as in pycocotools.
#[derive(Debug, Clone, Default)]
pub(super) struct Categories {
    ids: Vec<i64>,
    classes: Classes,
    /// Number of keypoints of each class, 0 if it has none.
    keypoints: Vec<usize>,
    things: Vec<bool>,
}

impl Categories {
    /// Sorts by id; the first of two categories with the same id is kept.
    pub fn new(mut records: Vec<CategoryRecord>) -> Self {
        records.sort_by_key(|record| record.id);
        records.dedup_by_key(|record| record.id);
        let name = |record: &CategoryRecord| record.name.clone().unwrap_or_else(|| record.id.to_string());
        Self {
            ids: records.iter().map(|record| record.id).collect(),
            classes: records.iter().map(name).collect(),
            keypoints: records.iter().map(|record| record.keypoints.len()).collect(),
            things: records.iter().map(|record| record.isthing).collect(),
        }
    }

    /// Returns the class index of a category.
    pub fn class(&self, id: i64) -> Option<usize> {
        self.ids.binary_search(&id).ok()
    }

    /// Returns the category ids by class index.
    pub fn ids(&self) -> &[i64] {
        &self.ids
    }

    /// Returns the names of the classes.
    pub fn classes(&self) -> &Classes {
        &self.classes
    }

    /// Returns the number of keypoints of a class; 0 if the file does not state it.
    pub fn keypoints(&self, class: usize) -> usize {
        self.keypoints.get(class).copied().unwrap_or(0)
    }

    /// Returns whether instances of a class are distinguished (a thing class).
    pub fn is_thing(&self, class: usize) -> bool {
        self.things.get(class).copied().unwrap_or(true)
    }
}
