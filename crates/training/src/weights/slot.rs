//! The parameters of a module, in the order of its fields.

use burn::module::{Module, ModuleVisitor, Param};
use burn::tensor::Tensor;

use crate::weights::Rules;

/// A place for a weight.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slot {
    /// Where it is, e.g. `backbone.conv.weight`.
    pub path: String,
    pub shape: Vec<usize>,
    /// Whether it is the matrix of a dense layer: `[inputs, outputs]` here, the other way round in files.
    pub dense: bool,
    /// Whether it is the kernel of a transposed convolution, `[inputs, outputs, ..]`.
    pub transposed: bool,
    /// Whether the rules give it a weight.
    pub covered: bool,
}

impl Slot {
    /// The module that it belongs to, and its name there.
    pub fn split(&self) -> (&str, &str) {
        self.path.rsplit_once('.').unwrap_or(("", &self.path))
    }

    /// Its shape as files have it.
    pub fn file_shape(&self) -> Vec<usize> {
        match self.shape[..] {
            [inputs, outputs] if self.dense => vec![outputs, inputs],
            _ => self.shape.clone(),
        }
    }

    /// Values as the module has them.
    pub fn values_from_file(&self, values: &[f32]) -> Vec<f32> {
        match self.shape[..] {
            [inputs, outputs] if self.dense => {
                let column = |input| (0..outputs).map(move |output| values[output * inputs + input]);
                (0..inputs).flat_map(column).collect()
            }
            _ => values.to_vec(),
        }
    }
}

/// Where a walk through a module is.
#[derive(Default)]
pub(super) struct Walk {
    names: Vec<String>,
    containers: Vec<String>,
}

impl Walk {
    pub fn enter(&mut self, name: &str, container: &str) {
        self.names.push(name.to_owned());
        self.containers.push(container.to_owned());
    }

    pub fn exit(&mut self) {
        self.names.pop();
        self.containers.pop();
    }

    /// The parameter here. Variants of an enum are no part of its name.
    pub fn path(&self) -> String {
        let variant = |container: &String| container.starts_with("Enum:");
        let names = self.names.iter().zip(&self.containers).filter(|(_, container)| !variant(container));
        names.map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(".")
    }

    /// The type of the module whose parameter this is.
    fn container(&self) -> &str {
        self.containers.last().and_then(|container| container.strip_prefix("Struct:")).unwrap_or_default()
    }
}

struct Slots<'a> {
    walk: Walk,
    rules: &'a Rules,
    slots: Vec<Slot>,
}

impl ModuleVisitor for Slots<'_> {
    fn enter_module(&mut self, name: &str, container_type: &str) {
        self.walk.enter(name, container_type);
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.walk.exit();
    }

    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        let (path, shape) = (self.walk.path(), param.lazy_shape().to_vec());
        let dense = self.walk.container() == "Linear" && path.ends_with("weight");
        let transposed = self.walk.container().starts_with("ConvTranspose");
        self.slots.push(Slot { covered: self.rules.cover(&path), path, shape, dense, transposed });
    }
}

/// The floating-point parameters and running statistics of a module.
pub(super) fn slots<M: Module>(module: &M, rules: &Rules) -> Vec<Slot> {
    let mut visitor = Slots { walk: Walk::default(), rules, slots: Vec::new() };
    module.visit(&mut visitor);
    visitor.slots
}
