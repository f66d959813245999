//! Traversals of the parameters of a module. Burn compiles a module's traversal for each type of visitor and mapper; with one of
//! either, it is compiled once per module, and what a traversal does once for all modules.

use burn::backend::capture::{CaptureBackend, TensorId};
use burn::module::{Module, ModuleMapper, ModuleVisitor, Param};
use burn::optim::GradientsParams;
use burn::tensor::{Bool, DType, Gradients, Int, Tensor, TensorData};

/// A floating-point parameter of any rank; tensors are flattened, `[values]`.
pub trait FloatParam {
    /// Returns the shape, without initialising the parameter.
    fn shape(&self) -> Vec<usize>;

    /// Returns whether gradients are recorded.
    fn is_trained(&self) -> bool;

    /// Returns the value.
    fn value(&self) -> Tensor<1>;

    /// Returns a tensor of `values` on the parameter's device.
    fn tensor(&self, values: Vec<f32>) -> Tensor<1>;

    /// Takes the gradient out of those of a backward pass.
    fn take_gradient(&self, gradients: &mut Gradients) -> Option<Tensor<1>>;

    /// Adds a gradient to those of an optimiser step.
    fn register_gradient(&self, gradient: Tensor<1>, gradients: &mut GradientsParams);
}

impl<const D: usize> FloatParam for Param<Tensor<D>> {
    fn shape(&self) -> Vec<usize> {
        self.lazy_shape().to_vec()
    }

    fn is_trained(&self) -> bool {
        self.val().is_require_grad()
    }

    fn value(&self) -> Tensor<1> {
        flat(self.val())
    }

    fn tensor(&self, values: Vec<f32>) -> Tensor<1> {
        let shape = [values.len()];
        Tensor::from_data(TensorData::new(values, shape), (&self.lazy_device(), DType::F32))
    }

    fn take_gradient(&self, gradients: &mut Gradients) -> Option<Tensor<1>> {
        self.val().grad_remove(gradients).map(flat)
    }

    fn register_gradient(&self, gradient: Tensor<1>, gradients: &mut GradientsParams) {
        gradients.register::<D>(self.id, gradient.reshape(self.lazy_shape()));
    }
}

fn flat<const D: usize>(tensor: Tensor<D>) -> Tensor<1> {
    let values = tensor.shape().num_elements();
    tensor.reshape([values])
}

/// A parameter of any type and rank on the device that records operations.
pub trait CapturedParam {
    /// Returns the id of the tensor in the recording; `None` on another device.
    fn tensor_id(&self) -> Option<TensorId>;
}

macro_rules! captured_param {
    ($kind:ty) => {
        impl<const D: usize> CapturedParam for Param<Tensor<D, $kind>> {
            fn tensor_id(&self) -> Option<TensorId> {
                self.val().try_into_primitive::<CaptureBackend>().ok().map(|tensor| tensor.id())
            }
        }
    };
}

captured_param!(burn::tensor::Float);
captured_param!(Int);
captured_param!(Bool);

/// What is done with the parameters of a module, in the order of its fields.
pub trait Visit {
    /// Begins the module `name` of the type `container`, e.g. `Struct:Linear`.
    fn enter(&mut self, _name: &str, _container: &str) {}

    /// Ends a module.
    fn exit(&mut self) {}

    /// Visits a floating-point parameter.
    fn float(&mut self, _param: &dyn FloatParam) {}

    /// Visits a parameter of any type.
    fn any(&mut self, _param: &dyn CapturedParam) {}
}

impl<F: FnMut(&dyn FloatParam)> Visit for F {
    fn float(&mut self, param: &dyn FloatParam) {
        self(param);
    }
}

/// How floating-point parameters of a module change, in the order of its fields.
pub trait Change {
    /// Begins the module `name` of the type `container`, e.g. `Struct:Linear`.
    fn enter(&mut self, _name: &str, _container: &str) {}

    /// Ends a module.
    fn exit(&mut self) {}

    /// Returns the new value, `[values]`; `None` leaves the parameter unchanged, and uninitialised if it was.
    fn float(&mut self, param: &dyn FloatParam) -> Option<Tensor<1>>;
}

/// A module whose type is not known.
pub trait AnyModule {
    /// Visits the parameters.
    fn visit_each(&self, visit: &mut dyn Visit);
}

impl<M: Module> AnyModule for M {
    fn visit_each(&self, visit: &mut dyn Visit) {
        self.visit(&mut Visitor(visit));
    }
}

/// Returns the module with changed parameters, which keep their ids in the optimiser and whether gradients are recorded.
pub fn changed<M: Module>(module: M, change: &mut dyn Change) -> M {
    module.map(&mut Mapper(change))
}

struct Visitor<'a>(&'a mut dyn Visit);

impl ModuleVisitor for Visitor<'_> {
    fn enter_module(&mut self, name: &str, container: &str) {
        self.0.enter(name, container);
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.0.exit();
    }

    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        self.0.float(param);
        self.0.any(param);
    }

    fn visit_int<const D: usize>(&mut self, param: &Param<Tensor<D, Int>>) {
        self.0.any(param);
    }

    fn visit_bool<const D: usize>(&mut self, param: &Param<Tensor<D, Bool>>) {
        self.0.any(param);
    }
}

struct Mapper<'a>(&'a mut dyn Change);

impl ModuleMapper for Mapper<'_> {
    fn enter_module(&mut self, name: &str, container: &str) {
        self.0.enter(name, container);
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.0.exit();
    }

    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let Some(value) = self.0.float(&param) else { return param };
        let (id, shape) = (param.id, param.lazy_shape());
        param.transform_for_load(value.reshape(shape), id)
    }
}
