//! Parameters grouped into layers, in order.

use std::collections::HashMap;

use crate::weights::Weight;
use crate::weights::slot::Slot;

/// Item with the name and the axes of a parameter: a weight of a file, or a parameter of a module.
pub(super) trait Named {
    /// Returns the layer, and the parameter's name within it.
    fn split(&self) -> (&str, &str);
    fn axes(&self) -> usize;
}

impl Named for Weight {
    fn split(&self) -> (&str, &str) {
        self.name().rsplit_once('.').unwrap_or(("", self.name()))
    }

    fn axes(&self) -> usize {
        self.shape().len()
    }
}

impl Named for Slot {
    fn split(&self) -> (&str, &str) {
        self.split()
    }

    fn axes(&self) -> usize {
        self.shape.len()
    }
}

/// A convolution or a linear layer.
#[derive(Debug)]
pub(super) struct Layer<'a, T> {
    pub kernel: &'a T,
    pub bias: Option<&'a T>,
    pub norm: Option<Norm<'a, T>>,
}

/// The batch normalisation after a layer.
#[derive(Debug)]
pub(super) struct Norm<'a, T> {
    pub scale: &'a T,
    pub shift: &'a T,
    pub mean: &'a T,
    pub variance: &'a T,
}

/// Returns the layers in the order of their first appearance.
pub(super) fn layers<'a, T: Named>(items: impl Iterator<Item = &'a T>) -> Vec<Layer<'a, T>> {
    let mut groups: Vec<HashMap<&str, &'a T>> = Vec::new();
    let mut numbers: HashMap<&str, usize> = HashMap::new();
    for item in items {
        let (layer, name) = item.split();
        let number = *numbers.entry(layer).or_insert(groups.len());
        if number == groups.len() {
            groups.push(HashMap::new());
        }
        if let Some(group) = groups.get_mut(number) {
            group.insert(name, item);
        }
    }
    let mut layers: Vec<Layer<'a, T>> = Vec::new();
    for group in groups {
        let get = |name: &str| group.get(name).copied();
        if let Some(kernel) = get("weight").filter(|kernel| kernel.axes() >= 2) {
            layers.push(Layer { kernel, bias: get("bias"), norm: None });
        } else if let (Some(scale), Some(shift), Some(mean), Some(variance)) = (
            get("weight").or(get("gamma")),
            get("bias").or(get("beta")),
            get("running_mean"),
            get("running_var"),
        ) && let Some(Layer { norm: norm @ None, .. }) = layers.last_mut()
        {
            *norm = Some(Norm { scale, shift, mean, variance });
        }
    }
    layers
}
