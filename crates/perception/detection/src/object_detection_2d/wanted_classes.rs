//! Which classes a detector is trained for.

use opendr_engine::target::Classes;
use opendr_engine::{Error, Result};

/// The classes to train: those that are wanted, or all that the data set has.
///
/// # Errors
/// `InvalidParam` when the data set does not have one of them, or names none and none are wanted.
pub(crate) fn wanted_classes(wanted: &[String], of_dataset: &Classes) -> Result<Classes> {
    if let Some(unknown) =
        wanted.iter().find(|name| !of_dataset.is_empty() && of_dataset.index(name).is_none())
    {
        let names: Vec<_> = of_dataset.iter().take(10).collect();
        return Err(Error::invalid_param(format!(
            "the data set has no class {unknown:?}; it has {} classes: {}{}",
            of_dataset.len(),
            names.join(", "),
            if of_dataset.len() > names.len() { ", ..." } else { "" }
        )));
    }
    match (wanted, of_dataset.is_empty()) {
        ([], true) => {
            Err(Error::invalid_param("the data set names no classes; give their names in `classes`"))
        }
        ([], false) => Ok(of_dataset.clone()),
        (wanted, _) => Ok(wanted.iter().map(String::as_str).collect()),
    }
}
