//! Predictions as a COCO results file, with the ids of the data set.

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::{BoundingBoxList, CocoAnnotation, Name};
use opendr_engine::{Error, Result};

/// Returns the entries of a results file for the `predictions` of sample `index`. `image_id` and `category_id` are
/// those of the data set.
///
/// # Errors
/// `NotFound` for a class that is not in the data set.
pub fn coco_results(
    dataset: &dyn DatasetIterator,
    index: usize,
    predictions: &BoundingBoxList,
) -> Result<Vec<CocoAnnotation>> {
    let (classes, ids) = (dataset.classes(), dataset.class_ids());
    let image_id = Some(dataset.id(index).unwrap_or(index as i64 + 1));
    let entry = |mut entry: CocoAnnotation| {
        // Class names take precedence if both sides have them: the indices of a model may differ.
        let number = match predictions.classes.label(&entry.category_id) {
            Some(label) if !classes.is_empty() => classes.index(label),
            _ => match &entry.category_id {
                Name::Index(number) => Some(*number),
                Name::Label(_) => None,
            },
        };
        let number = number.and_then(|number| usize::try_from(number).ok()).ok_or_else(|| {
            let class = predictions
                .classes
                .label(&entry.category_id)
                .map_or_else(|| entry.category_id.to_string(), str::to_owned);
            Error::not_found(format!(
                "the data set has no class {class:?}; map the model's classes to the data set's"
            ))
        })?;
        let own = ids.get(number).copied();
        let id = own.or_else(|| ids.is_empty().then_some(number as i64 + 1));
        let id = id
            .ok_or_else(|| Error::not_found(format!("class {number} is not one of {} classes", ids.len())))?;
        entry.category_id = Name::Index(id);
        entry.image_id = image_id;
        Ok(entry)
    };
    predictions.coco(true).into_iter().map(entry).collect()
}
