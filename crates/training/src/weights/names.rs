//! Matching of weights by name.

use std::collections::HashMap;

use opendr_engine::{Error, Result};

use crate::weights::fill::Plan;
use crate::weights::slot::Slot;
use crate::weights::{Mismatch, Report, Rules, Weight, WeightTable};

/// Returns the plan that assigns weights by name, and its report.
pub(super) fn plan(slots: &[Slot], table: &WeightTable, rules: &Rules) -> Result<(Plan, Report)> {
    rules.check()?;
    let mut by_name: HashMap<String, &Weight> = HashMap::new();
    for weight in table.weights() {
        if let Some(other) = by_name.insert(rules.renamed(weight.name()), weight) {
            return Err(Error::invalid_param(format!(
                "the renames map {:.80?} and {:.80?} to the same name",
                other.name(),
                weight.name()
            )));
        }
    }
    let (mut plan, mut report) = (Plan::new(), Report::default());
    for slot in slots.iter().filter(|slot| slot.covered) {
        let Some(weight) = names_of(slot).iter().find_map(|name| by_name.remove(name)) else {
            report.missing.push(slot.path.clone());
            continue;
        };
        if slot.file_shape() == weight.shape() {
            plan.insert(slot.path.clone(), slot.values_from_file(weight.values()));
            report.loaded.push(slot.path.clone());
        } else {
            report.mismatched.push(Mismatch {
                parameter: slot.path.clone(),
                expected: slot.file_shape(),
                actual: weight.shape().to_vec(),
            });
        }
    }
    let left = table.weights().iter().filter(|weight| by_name.contains_key(&rules.renamed(weight.name())));
    report.unexpected = left.map(|weight| weight.name().to_owned()).collect();
    Ok((plan, report))
}

/// Returns the names of weights that match a parameter.
fn names_of(slot: &Slot) -> Vec<String> {
    let (module, name) = slot.split();
    let dot = if module.is_empty() { "" } else { "." };
    let other = match name {
        "gamma" => Some("weight"),
        "beta" => Some("bias"),
        _ => None,
    };
    let others = other.map(|other| format!("{module}{dot}{other}"));
    [slot.path.clone()].into_iter().chain(others).collect()
}
