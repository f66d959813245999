//! Evaluation of a learner on a data set.

use std::ffi::c_char;

use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::evaluation::{EvalOptions, Outcome, Subject};
use opendr::{Error, Pipeline, Result, Silent};

use crate::handle::Out;
use crate::learner::{Loaded, opendr_learner};
use crate::pointer::{optional_text, path};
use crate::status::{guard, opendr_status};
use crate::string::{Text, opendr_string};

/// Evaluates the learner on a data set on disk.
///
/// dataset_type is its format, e.g. "coco"; NULL detects it. options_json is an object: "metric", "metric_params",
/// "split", "limit", "out", "skip_broken", "classes" (an object: classes of the data set by classes of the learner), "by_number",
/// "resamples", and "then", a list of pretrained learners after this one, such as ["byte_track"], to evaluate the pipeline;
/// NULL uses the defaults. The outcome is a JSON object, with the scalars by name under "scalars"; it must be freed.
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
/// The same as for [`opendr_eval`].
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
    let invalid = |error| {
        Error::invalid_param("options_json is not a JSON object of options of opendr_eval").with_source(error)
    };
    let mut options: serde_json::Map<String, serde_json::Value> =
        serde_json::from_str(options).map_err(invalid)?;
    let then = options.remove("then").unwrap_or_else(|| serde_json::Value::Array(Vec::new()));
    let then: Vec<String> = serde_json::from_value(then).map_err(invalid)?;
    let options: EvalOptions = serde_json::from_value(options.into()).map_err(invalid)?;
    let external = ExternalDataset::new(dataset, dataset_type);
    let dataset = DatasetRef::External(&external);
    let evaluated = match then.is_empty() {
        true => options.run(&mut loaded.lock(), loaded.entry, dataset, &Silent)?,
        false => eval_pipeline(loaded, &then, &options, dataset)?,
    };
    out.set(Text::of_json(&evaluated)?);
    Ok(())
}

/// Evaluates a pipeline of the learner and pretrained learners after it.
fn eval_pipeline(
    loaded: &Loaded,
    then: &[String],
    options: &EvalOptions,
    dataset: DatasetRef<'_>,
) -> Result<Outcome> {
    let learner = loaded.lock();
    let first = Pipeline::default().then(loaded.entry, learner.as_ref())?;
    let add = |pipeline: Pipeline, spec: &String| pipeline.then_named(spec, learner.device(), &Silent);
    let mut pipelines = [then.iter().try_fold(first, add)?];
    let [pipeline] = &pipelines;
    let names: Vec<_> = pipeline.entries().map(|entry| entry.spec.name).collect();
    let subject = Subject { learner: names.join(" + "), model: None, params: learner.params() };
    let last = pipeline.entries().last().unwrap_or(loaded.entry);
    let (ports, classes) = (pipeline.ports().to_vec(), pipeline.classes());
    options.open(last, dataset)?.run_pipelines(&mut pipelines, &ports, classes, subject, &Silent)
}
