//! Inputs of a network.

use std::marker::PhantomData;

use burn::backend::capture::{CaptureBackend, TensorId};
use burn::tensor::kind::Basic;
use burn::tensor::{Bool, Device, Float, Int, Tensor};
use opendr_engine::{Error, Result};
use opendr_onnx::ElementType;

/// Input of a model: `Input::new("image", [1, 3, 300, 300])`.
#[derive(Debug, Clone)]
pub struct Input<const D: usize, K = Float> {
    name: String,
    shape: [usize; D],
    open: Option<usize>,
    kind: PhantomData<K>,
}

impl<const D: usize> Input<D> {
    /// Creates an input of floats.
    pub fn new(name: impl Into<String>, shape: [usize; D]) -> Self {
        Self { name: name.into(), shape, open: None, kind: PhantomData }
    }
}

impl<const D: usize> Input<D, Int> {
    /// Creates an input of integers.
    pub fn int(name: impl Into<String>, shape: [usize; D]) -> Self {
        Self { name: name.into(), shape, open: None, kind: PhantomData }
    }
}

impl<const D: usize, K> Input<D, K> {
    /// Makes the size along `axis` dynamic, whatever `shape` says. It is called `batch` in the file, and all inputs with a
    /// dynamic axis share its size.
    #[must_use]
    pub fn open(mut self, axis: usize) -> Self {
        self.open = Some(axis);
        self
    }
}

/// An input without its static types.
#[derive(Debug)]
pub struct Declared {
    pub(super) name: String,
    pub(super) kind: ElementType,
    pub(super) shape: Vec<usize>,
    pub(super) open: Option<usize>,
}

/// Element types of inputs and outputs: floats, integers, booleans.
pub trait ElementKind: Basic + Sized {
    /// The element type in ONNX.
    const ONNX: ElementType;

    /// Returns the id of the tensor in the recording.
    #[doc(hidden)]
    fn id<const D: usize>(tensor: Tensor<D, Self>) -> Result<TensorId>;
}

macro_rules! impl_element_kind {
    ($($kind:ident),*) => {$(
        impl ElementKind for $kind {
            const ONNX: ElementType = ElementType::$kind;

            fn id<const D: usize>(tensor: Tensor<D, Self>) -> Result<TensorId> {
                let tensor = tensor.try_into_primitive::<CaptureBackend>().map_err(|_| {
                    Error::internal(
                        "the forward pass uses a tensor on another device than its input; create tensors on `input.device()`",
                    )
                })?;
                Ok(tensor.id())
            }
        }
    )*};
}

impl_element_kind!(Float, Int, Bool);

/// One [`Input`], or a tuple of up to six.
pub trait Inputs {
    /// Tensors passed to `forward`.
    type Tensors;

    /// Returns the inputs in order.
    #[doc(hidden)]
    fn declared(&self) -> Vec<Declared>;

    /// Creates tensors without values, of size `batch` along the open axes, and appends their ids.
    #[doc(hidden)]
    fn tensors(&self, batch: usize, device: &Device, ids: &mut Vec<TensorId>) -> Result<Self::Tensors>;
}

impl<const D: usize, K: ElementKind> Inputs for Input<D, K> {
    type Tensors = Tensor<D, K>;

    fn declared(&self) -> Vec<Declared> {
        vec![Declared {
            name: self.name.clone(),
            kind: K::ONNX,
            shape: self.shape.to_vec(),
            open: self.open.filter(|&axis| axis < D),
        }]
    }

    fn tensors(&self, batch: usize, device: &Device, ids: &mut Vec<TensorId>) -> Result<Self::Tensors> {
        let mut shape = self.shape;
        if let Some(axis) = self.open {
            let dim = shape.get_mut(axis).ok_or_else(|| {
                Error::internal(format!("input {:?} has {D} axes and no axis {axis}", self.name))
            })?;
            *dim = batch;
        }
        let tensor = Tensor::<D, K>::empty(shape, device);
        ids.push(K::id(tensor.clone())?);
        Ok(tensor)
    }
}

macro_rules! impl_inputs {
    ($($name:ident),+) => {
        #[allow(non_snake_case)]
        impl<$($name: Inputs),+> Inputs for ($($name,)+) {
            type Tensors = ($($name::Tensors,)+);

            fn declared(&self) -> Vec<Declared> {
                let ($($name,)+) = self;
                let mut declared = Vec::new();
                $(declared.extend($name.declared());)+
                declared
            }

            fn tensors(&self, batch: usize, device: &Device, ids: &mut Vec<TensorId>) -> Result<Self::Tensors> {
                let ($($name,)+) = self;
                Ok(($($name.tensors(batch, device, ids)?,)+))
            }
        }
    };
}

impl_inputs!(A);
impl_inputs!(A, B);
impl_inputs!(A, B, C);
impl_inputs!(A, B, C, D);
impl_inputs!(A, B, C, D, E);
impl_inputs!(A, B, C, D, E, F);
