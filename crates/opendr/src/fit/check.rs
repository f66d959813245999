//! Checks before a training.

use opendr_engine::learner::Entry;
use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result};

use crate::registry;

/// Checks that a learner trains and that its training has the parameters, before data sets are opened.
///
/// # Errors
/// `Unsupported`, with the names of learners that train; `InvalidParam`.
pub fn check_fit(entry: &Entry, params: &ParamMap) -> Result<()> {
    if !entry.capabilities.fit && !entry.capabilities.fit_in {
        return Err(cannot_fit(entry));
    }
    params.iter().try_for_each(|(name, value)| {
        let field = entry.fit_params.iter().find(|field| field.is_called(name)).ok_or_else(|| {
            let names: Vec<_> = entry.fit_params.iter().map(|field| field.name).collect();
            let class = entry.spec.class;
            Error::invalid_param(format!(
                "fit of {class} has no parameter {name:?}; it has {}",
                names.join(", ")
            ))
        })?;
        field.check(value)
    })
}

#[cold]
fn cannot_fit(entry: &Entry) -> Error {
    let (class, task) = (entry.spec.class, entry.spec.task);
    let names = |of_task: bool| {
        let entries = registry().entries().into_iter();
        let able = entries.filter(|other| other.capabilities.fit && (!of_task || other.spec.task == task));
        able.map(|other| other.spec.name).collect::<Vec<_>>().join(", ")
    };
    Error::unsupported(match (names(true), names(false)) {
        _ if !cfg!(feature = "training") => {
            format!("{class} cannot fit: this build has no training; build with --features training")
        }
        (none, others) if none.is_empty() => {
            format!("{class} cannot fit, nor can any learner of {task}; learners that train: {others}")
        }
        (of_task, _) => format!("{class} cannot fit; learners of {task} that train: {of_task}"),
    })
}
