//! Writes values into a module.

use std::collections::HashMap;

use burn::module::Module;
use burn::tensor::Tensor;

use crate::traversal::{Change, FloatParam, changed};
use crate::weights::slot::Walk;

/// Values by the path of their parameter, in the parameter's length and layout.
pub(super) type Plan = HashMap<String, Vec<f32>>;

struct Fill {
    walk: Walk,
    plan: Plan,
}

impl Change for Fill {
    fn enter(&mut self, name: &str, container: &str) {
        self.walk.enter(name, container);
    }

    fn exit(&mut self) {
        self.walk.exit();
    }

    fn float(&mut self, param: &dyn FloatParam) -> Option<Tensor<1>> {
        self.plan.remove(&self.walk.path()).map(|values| param.tensor(values))
    }
}

/// Returns the module with the plan's values; other parameters are unchanged, and all keep their ids in the optimiser.
pub(super) fn fill<M: Module>(module: M, plan: Plan) -> M {
    changed(module, &mut Fill { walk: Walk::default(), plan })
}
