//! COCO's category numbers, which have gaps, and the class numbers of targets, which have none.

use opendr_engine::target::Classes;

use super::record::CategoryRecord;

/// The categories of a data set, in the order of their numbers, as pycocotools takes them.
#[derive(Debug, Clone, Default)]
pub(super) struct Categories {
    ids: Vec<i64>,
    classes: Classes,
    /// Key points of each class, 0 where it has none.
    keypoints: Vec<usize>,
    things: Vec<bool>,
}

impl Categories {
    /// In the order of their numbers; of two with the same number the first counts.
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

    /// The class number of a category.
    pub fn class(&self, id: i64) -> Option<usize> {
        self.ids.binary_search(&id).ok()
    }

    /// The category of each class.
    pub fn ids(&self) -> &[i64] {
        &self.ids
    }

    /// The names of the classes.
    pub fn classes(&self) -> &Classes {
        &self.classes
    }

    /// How many key points an object of a class has; 0 when the file does not tell.
    pub fn keypoints(&self, class: usize) -> usize {
        self.keypoints.get(class).copied().unwrap_or(0)
    }

    /// Whether objects of a class are told apart.
    pub fn is_thing(&self, class: usize) -> bool {
        self.things.get(class).copied().unwrap_or(true)
    }
}
