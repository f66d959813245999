//! A tensor of the graph under construction.

use std::rc::Rc;

use super::array::{Array, Data, Kind};

/// A dimension; `None` when only the runtime knows it.
pub type Dim = Option<usize>;

/// A tensor of the graph under construction: name, element type, dimensions, and elements as far as they are known.
#[derive(Debug, Clone)]
pub struct Wire {
    pub(super) name: Rc<str>,
    kind: Kind,
    dims: Vec<Dim>,
    known: Option<Rc<Array>>,
}

impl Wire {
    pub(super) fn new(name: &str, kind: Kind, dims: Vec<Dim>, known: Option<Array>) -> Self {
        Self { name: name.into(), kind, dims, known: known.map(Rc::new) }
    }

    /// A tensor whose elements are all known; written as an initializer when a node needs it.
    pub fn constant(array: Array) -> Self {
        Self::named_constant("", array)
    }

    /// As [`Wire::constant`], with the name that the initializer shall have.
    pub fn named_constant(name: &str, array: Array) -> Self {
        let dims = array.dims().iter().copied().map(Some).collect();
        Self::new(name, array.kind(), dims, Some(array))
    }

    /// A constant list of integers.
    pub fn ints(values: impl IntoIterator<Item = i64>) -> Self {
        Self::constant(Array::ints(values.into_iter().collect()))
    }

    /// A constant float of rank 0.
    pub fn scalar(value: f32) -> Self {
        Self::constant(Array::scalar(value))
    }

    /// Stands for an optional input that is left out.
    pub fn absent() -> Self {
        Self::new("", Kind::Float, Vec::new(), None)
    }

    /// The name, from which names of tensors that follow are made; empty for a nameless constant.
    pub fn hint(&self) -> String {
        self.name.to_string()
    }

    /// Element type.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Dimensions.
    pub fn dims(&self) -> &[Dim] {
        &self.dims
    }

    /// Number of dimensions.
    pub fn rank(&self) -> usize {
        self.dims.len()
    }

    /// Number of elements, when all dimensions are known and it does not overflow.
    pub fn element_count(&self) -> Option<usize> {
        self.dims.iter().try_fold(1usize, |count, dim| count.checked_mul((*dim)?))
    }

    /// All elements, if they are known.
    pub fn array(&self) -> Option<&Array> {
        self.known.as_deref().filter(|array| array.is_complete())
    }

    /// What is known of the elements, all or some.
    pub(super) fn known(&self) -> Option<&Array> {
        self.known.as_deref()
    }

    /// Identifies a constant that is shared by several nodes.
    pub(super) fn address(&self) -> usize {
        self.known.as_ref().map_or(0, |array| Rc::as_ptr(array).addr())
    }

    /// The elements of a shape, as far as they are known.
    pub fn elements(&self) -> Option<Vec<Option<i64>>> {
        match self.known()?.data() {
            Data::Int(values) => Some(values.iter().copied().map(Some).collect()),
            Data::Partial(values) => Some(values.clone()),
            _ => None,
        }
    }
}
