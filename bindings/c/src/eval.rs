//! A learner measured on a data set.

use std::ffi::c_char;

use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::evaluation::EvalOptions;
use opendr::{Error, Result, Silent};

use crate::handle::Out;
use crate::learner::{Loaded, opendr_learner};
use crate::pointer::{optional_text, path};
use crate::status::{guard, opendr_status};
use crate::string::{Text, opendr_string};

/// Measures the learner on a data set on disk.
///
/// dataset_type is its format, e.g. "coco"; NULL recognises it. options_json is an object: "metric", "metric_params",
/// "split", "limit", "folder", "skip_broken"; NULL takes the defaults. The outcome is an object of JSON: under "scalars"
/// the numbers by name; it is to be freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_eval(
    learner: *const opendr_learner,
    dataset: *const c_char,
    dataset_type: *const c_char,
    options_json: *const c_char,
    outcome: *mut *mut opendr_string,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { eval(learner, dataset, dataset_type, options_json, outcome) })
}

/// # Safety
/// As [`opendr_eval`].
unsafe fn eval(
    learner: *const opendr_learner,
    dataset: *const c_char,
    dataset_type: *const c_char,
    options_json: *const c_char,
    outcome: *mut *mut opendr_string,
) -> Result<()> {
    // SAFETY: the caller's promise.
    let (out, loaded, dataset, dataset_type, options) = unsafe {
        (
            Out::new(outcome, "outcome")?,
            Loaded::of(learner)?,
            path(dataset, "dataset")?,
            optional_text(dataset_type, "dataset_type")?.unwrap_or("auto"),
            optional_text(options_json, "options_json")?.unwrap_or("{}"),
        )
    };
    let options: EvalOptions = serde_json::from_str(options).map_err(|error| {
        Error::invalid_param("options_json is no JSON object of options of opendr_eval").with_source(error)
    })?;
    let external = ExternalDataset::new(dataset, dataset_type);
    let dataset = DatasetRef::External(&external);
    let measured = options.run(&mut loaded.lock(), loaded.entry, dataset, &Silent)?;
    out.set(Text::of_json(&measured)?);
    Ok(())
}
