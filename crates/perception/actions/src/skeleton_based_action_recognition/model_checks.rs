//! Checks of parameters against a loaded model.

use opendr_engine::model::Model;
use opendr_engine::params::{Param, ParamValue};
use opendr_engine::{Error, Result};

use super::GraphType;

/// Returns the number of joints of a graph.
///
/// # Errors
/// `InvalidParam` when the given number differs.
pub(super) fn joints_of(graph: GraphType, given: Option<usize>) -> Result<usize> {
    match given {
        Some(given) if given != graph.joints() => Err(Error::invalid_param(format!(
            "num_point = {given}, but graph_type {} has {}; omit num_point or choose another graph_type",
            graph.name(),
            graph.joints()
        ))),
        _ => Ok(graph.joints()),
    }
}

/// Checks the number of classes that the user gave, where there is one, against the model.
///
/// # Errors
/// `InvalidParam` when they differ.
pub(super) fn check_classes(name: &str, wanted: Option<usize>, present: usize) -> Result<()> {
    match wanted {
        Some(wanted) if wanted != present => Err(Error::invalid_param(format!(
            "{name} = {wanted}, but the model has {present} classes; omit {name} or load another model"
        ))),
        _ => Ok(()),
    }
}

/// Checks the architecture that the user gave against that of the model; a model that states none has the default.
///
/// # Errors
/// `InvalidParam` when they differ.
pub(super) fn check_architecture<T: Param + Default>(name: &str, wanted: &T, model: &Model) -> Result<()> {
    let (wanted, default) = (wanted.to_value(), T::default().to_value());
    let stated: &ParamValue = model.params().get(name).unwrap_or(&default);
    match *stated == wanted {
        true => Ok(()),
        false => Err(Error::invalid_param(format!(
            "{name} = {wanted}, but the model has {stated}; omit {name} or load another model"
        ))),
    }
}
