//! Parameters of a module, in the order of its fields.

use crate::traversal::{AnyModule, FloatParam, Visit};
use crate::weights::Rules;

/// A parameter of a module.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slot {
    /// Path of the parameter, e.g. `backbone.conv.weight`.
    pub path: String,
    pub shape: Vec<usize>,
    /// Whether it is the matrix of a linear layer: `[inputs, outputs]` in Burn, transposed in files.
    pub dense: bool,
    /// Whether it is the kernel of a transposed convolution, `[inputs, outputs, ..]`.
    pub transposed: bool,
    /// Whether the rules cover it.
    pub covered: bool,
}

impl Slot {
    /// Returns the path of the module, and the parameter's name in it.
    pub fn split(&self) -> (&str, &str) {
        self.path.rsplit_once('.').unwrap_or(("", &self.path))
    }

    /// Returns the shape in files.
    pub fn file_shape(&self) -> Vec<usize> {
        match self.shape[..] {
            [inputs, outputs] if self.dense => vec![outputs, inputs],
            _ => self.shape.clone(),
        }
    }

    /// Returns values of a file in the module's layout.
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

/// Position in a traversal of a module.
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

    /// Returns the path of the current parameter, without variants of enums.
    pub fn path(&self) -> String {
        let variant = |container: &String| container.starts_with("Enum:");
        let names = self.names.iter().zip(&self.containers).filter(|(_, container)| !variant(container));
        names.map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(".")
    }

    /// Returns the type of the current module.
    fn container(&self) -> &str {
        self.containers.last().and_then(|container| container.strip_prefix("Struct:")).unwrap_or_default()
    }
}

struct Slots<'a> {
    walk: Walk,
    rules: &'a Rules,
    slots: Vec<Slot>,
}

impl Visit for Slots<'_> {
    fn enter(&mut self, name: &str, container: &str) {
        self.walk.enter(name, container);
    }

    fn exit(&mut self) {
        self.walk.exit();
    }

    fn float(&mut self, param: &dyn FloatParam) {
        let (path, shape) = (self.walk.path(), param.shape());
        let dense = self.walk.container() == "Linear" && path.ends_with("weight");
        let transposed = self.walk.container().starts_with("ConvTranspose");
        self.slots.push(Slot { covered: self.rules.cover(&path), path, shape, dense, transposed });
    }
}

/// Returns the floating-point parameters and running statistics of a module.
pub(super) fn slots(module: &dyn AnyModule, rules: &Rules) -> Vec<Slot> {
    let mut visitor = Slots { walk: Walk::default(), rules, slots: Vec::new() };
    module.visit_each(&mut visitor);
    visitor.slots
}
