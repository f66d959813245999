//! Selection of the classes that a detector trains on.

use opendr_engine::target::Classes;
use opendr_engine::{Error, Result};

/// Returns the classes to train: those of `selection`, or all of the data set when it is empty.
///
/// # Errors
/// `InvalidParam` when the data set does not have one of them, or names none and `selection` is empty.
pub(crate) fn selected_classes(selection: &[String], of_dataset: &Classes) -> Result<Classes> {
    if let Some(unknown) =
        selection.iter().find(|name| !of_dataset.is_empty() && of_dataset.index(name).is_none())
    {
        let names: Vec<_> = of_dataset.iter().take(10).collect();
        return Err(Error::invalid_param(format!(
            "the data set has no class {unknown:?}; it has {} classes: {}{}",
            of_dataset.len(),
            names.join(", "),
            if of_dataset.len() > names.len() { ", ..." } else { "" }
        )));
    }
    match (selection, of_dataset.is_empty()) {
        ([], true) => {
            Err(Error::invalid_param("the data set names no classes; give their names in `classes`"))
        }
        ([], false) => Ok(of_dataset.clone()),
        (selection, _) => Ok(selection.iter().map(String::as_str).collect()),
    }
}
