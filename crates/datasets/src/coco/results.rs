//! Answers as a COCO results file, in the data set's own numbers.

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::{BoundingBoxList, CocoAnnotation, Name};
use opendr_engine::{Error, Result};

/// The entries of a results file for what was found in sample number `index`: `image_id` and `category_id` are those of
/// the data set's files.
///
/// # Errors
/// `NotFound` for a class that the data set does not have.
pub fn coco_results(
    dataset: &dyn DatasetIterator,
    index: usize,
    found: &BoundingBoxList,
) -> Result<Vec<CocoAnnotation>> {
    let (classes, ids) = (dataset.classes(), dataset.class_ids());
    let image_id = Some(dataset.id(index).unwrap_or(index as i64 + 1));
    let entry = |mut entry: CocoAnnotation| {
        // Names tell which class is meant where both sides have them: a model may number them otherwise.
        let number = match found.classes.label(&entry.category_id) {
            Some(label) if !classes.is_empty() => classes.index(label),
            _ => match &entry.category_id {
                Name::Index(number) => Some(*number),
                Name::Label(_) => None,
            },
        };
        let number = number.and_then(|number| usize::try_from(number).ok()).ok_or_else(|| {
            let class = found
                .classes
                .label(&entry.category_id)
                .map_or_else(|| entry.category_id.to_string(), str::to_owned);
            Error::not_found(format!("the data set has no class {class:?}; map the model's classes to it"))
        })?;
        let own = ids.get(number).copied();
        let id = own.or_else(|| ids.is_empty().then_some(number as i64 + 1));
        let id = id.ok_or_else(|| Error::not_found(format!("class {number} is none of {}", ids.len())))?;
        entry.category_id = Name::Index(id);
        entry.image_id = image_id;
        Ok(entry)
    };
    found.coco(true).into_iter().map(entry).collect()
}
