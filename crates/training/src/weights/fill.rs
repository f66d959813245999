//! Writes values into a module.

use std::collections::HashMap;

use burn::module::{Module, ModuleMapper, Param};
use burn::tensor::{DType, Tensor, TensorData};

use crate::weights::slot::Walk;

/// Values by the path of their parameter, in the parameter's length and layout.
pub(super) type Plan = HashMap<String, Vec<f32>>;

struct Fill {
    walk: Walk,
    plan: Plan,
}

impl ModuleMapper for Fill {
    fn enter_module(&mut self, name: &str, container_type: &str) {
        self.walk.enter(name, container_type);
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.walk.exit();
    }

    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let Some(values) = self.plan.remove(&self.walk.path()) else { return param };
        let data = TensorData::new(values, param.lazy_shape());
        let tensor = Tensor::from_data(data, (&param.lazy_device(), DType::F32));
        let id = param.id;
        param.transform_for_load(tensor, id)
    }
}

/// Returns the module with the plan's values; other parameters are unchanged, and all keep their ids in the optimiser.
pub(super) fn fill<M: Module>(module: M, plan: Plan) -> M {
    module.map(&mut Fill { walk: Walk::default(), plan })
}
