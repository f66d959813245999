//! Training of learners.

use std::ffi::{c_char, c_void};

use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::{Error, FitData, FitEnvironments, FitOptions, Result};

use crate::environment::source_of;
use crate::handle::Out;
use crate::learner::{Loaded, opendr_learner};
use crate::pointer::{optional_text, path};
use crate::progress::{Listener, opendr_progress};
use crate::status::{guard, opendr_status};
use crate::string::{Text, opendr_string};

/// Trains the learner on a data set on disk, from its model if it has one, and loads the result.
///
/// dataset_type is its format, e.g. "coco"; NULL detects it. options_json is an object: "params" (of the training), "split",
/// "val", "val_format", "val_split", "limit", "out", "logging_path", "resume", "teacher", "teacher_threshold",
/// "teacher_classes", "keep_empty", "skip_broken"; NULL uses the defaults. progress, which may be NULL, receives the progress
/// and may stop the training, which then saves a checkpoint to resume from. The report is a JSON object, with the values by
/// name under "curves" and "scalars" and the path of the trained container under "model"; it must be freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_fit(
    learner: *const opendr_learner,
    dataset: *const c_char,
    dataset_type: *const c_char,
    options_json: *const c_char,
    progress: opendr_progress,
    context: *mut c_void,
    report: *mut *mut opendr_string,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe {
        fit(learner, dataset, dataset_type, options_json, &Listener::new(progress, context), report)
    })
}

/// # Safety
/// The same as for [`opendr_fit`].
unsafe fn fit(
    learner: *const opendr_learner,
    dataset: *const c_char,
    dataset_type: *const c_char,
    options_json: *const c_char,
    progress: &Listener,
    report: *mut *mut opendr_string,
) -> Result<()> {
    // SAFETY: the caller's promise.
    let (out, loaded, dataset, dataset_type, options) = unsafe {
        (
            Out::new(report, "report")?,
            Loaded::of(learner)?,
            path(dataset, "dataset")?,
            optional_text(dataset_type, "dataset_type")?.unwrap_or("auto"),
            optional_text(options_json, "options_json")?.unwrap_or("{}"),
        )
    };
    let options = options_from_json(options)?;
    let external = ExternalDataset::new(dataset, dataset_type);
    let data = FitData::from(DatasetRef::External(&external));
    let fitted = opendr::fit(loaded.lock().as_mut(), loaded.entry, data, &options, progress)?;
    out.set(Text::of_json(&fitted)?);
    Ok(())
}

fn options_from_json(json: &str) -> Result<FitOptions> {
    serde_json::from_str(json).map_err(|error| {
        Error::invalid_param("options_json is not a JSON object of options of opendr_fit").with_source(error)
    })
}

/// Trains a policy in the environment id, e.g. "CartPole-v1", from its model if it has one, and loads the result.
///
/// env_params_json is an object of parameters of the environment; NULL uses the defaults. options_json is an object:
/// "params" (of the training), "out", "logging_path", "resume"; NULL uses the defaults. progress and report are the same as
/// for opendr_fit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_fit_policy(
    learner: *const opendr_learner,
    id: *const c_char,
    env_params_json: *const c_char,
    options_json: *const c_char,
    progress: opendr_progress,
    context: *mut c_void,
    report: *mut *mut opendr_string,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (listener, out, loaded, source, options) = unsafe {
            (
                Listener::new(progress, context),
                Out::new(report, "report")?,
                Loaded::of(learner)?,
                source_of(id, env_params_json)?,
                optional_text(options_json, "options_json")?.unwrap_or("{}"),
            )
        };
        let options = options_from_json(options)?;
        let environments = FitEnvironments { env: &source, val_env: None };
        let fitted =
            opendr::fit_policy(loaded.lock().as_mut(), loaded.entry, environments, &options, &listener)?;
        out.set(Text::of_json(&fitted)?);
        Ok(())
    })
}
