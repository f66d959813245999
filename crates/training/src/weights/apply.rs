//! Loading of weights into a module.

use burn::module::Module;
use opendr_engine::Result;

use crate::weights::fill::fill;
use crate::weights::slot::slots;
use crate::weights::{Report, Rules, WeightTable, names, order};

impl WeightTable {
    /// Loads the weights into `module`, which stays on its device; parameters without a weight are unchanged.
    ///
    /// By name, a weight of another shape (such as a head for other classes) is skipped and listed in the report; by order, it
    /// is an error.
    ///
    /// # Errors
    /// `InvalidParam` for contradictory rules, `InvalidInput` when the layers in order do not match the module's.
    pub fn apply<M: Module>(&self, module: M, rules: &Rules) -> Result<(M, Report)> {
        let slots = slots(&module, rules);
        let (plan, report) = match rules.is_by_order() {
            true => order::plan(&slots, self, rules)?,
            false => names::plan(&slots, self, rules)?,
        };
        Ok((fill(module, plan), report))
    }
}
