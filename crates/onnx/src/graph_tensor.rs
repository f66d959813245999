//! Tensors of a graph under construction.

use std::rc::Rc;

use super::array::{Array, Data, ElementType};

/// Size of a dimension; `None` when it is only known at run time.
pub type Dim = Option<usize>;

/// A tensor of a graph under construction: name, element type, dimensions, and elements as far as they are known.
#[derive(Debug, Clone)]
pub struct GraphTensor {
    pub(super) name: Rc<str>,
    kind: ElementType,
    dims: Vec<Dim>,
    known: Option<Rc<Array>>,
}

impl GraphTensor {
    pub(super) fn new(name: &str, kind: ElementType, dims: Vec<Dim>, known: Option<Array>) -> Self {
        Self { name: name.into(), kind, dims, known: known.map(Rc::new) }
    }

    /// Creates a constant; written as an initializer when a node needs it.
    pub fn constant(array: Array) -> Self {
        Self::named_constant("", array)
    }

    /// Creates a constant whose initializer has the given name.
    pub fn named_constant(name: &str, array: Array) -> Self {
        let dims = array.dims().iter().copied().map(Some).collect();
        Self::new(name, array.kind(), dims, Some(array))
    }

    /// Creates a constant list of integers.
    pub fn ints(values: impl IntoIterator<Item = i64>) -> Self {
        Self::constant(Array::ints(values.into_iter().collect()))
    }

    /// Creates a constant float of rank 0.
    pub fn scalar(value: f32) -> Self {
        Self::constant(Array::scalar(value))
    }

    /// Creates a placeholder for an omitted optional input.
    pub fn absent() -> Self {
        Self::new("", ElementType::Float, Vec::new(), None)
    }

    /// Returns the name, from which names of following tensors are derived; empty for an unnamed constant.
    pub fn hint(&self) -> String {
        self.name.to_string()
    }

    /// Returns the element type.
    pub fn kind(&self) -> ElementType {
        self.kind
    }

    /// Returns the dimensions.
    pub fn dims(&self) -> &[Dim] {
        &self.dims
    }

    /// Returns the number of dimensions.
    pub fn rank(&self) -> usize {
        self.dims.len()
    }

    /// Returns the number of elements, if all dimensions are known and it does not overflow.
    pub fn element_count(&self) -> Option<usize> {
        self.dims.iter().try_fold(1usize, |count, dim| count.checked_mul((*dim)?))
    }

    /// Returns the elements, if all are known.
    pub fn array(&self) -> Option<&Array> {
        self.known.as_deref().filter(|array| array.is_complete())
    }

    /// Returns the known elements, all or some.
    pub(super) fn known(&self) -> Option<&Array> {
        self.known.as_deref()
    }

    /// Returns an identifier of a constant that several nodes share.
    pub(super) fn address(&self) -> usize {
        self.known.as_ref().map_or(0, |array| Rc::as_ptr(array).addr())
    }

    /// Returns the elements of a shape, as far as they are known.
    pub fn elements(&self) -> Option<Vec<Option<i64>>> {
        match self.known()?.data() {
            Data::Int(values) => Some(values.iter().copied().map(Some).collect()),
            Data::Partial(values) => Some(values.clone()),
            _ => None,
        }
    }
}
