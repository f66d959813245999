//! Tensors that planning knows, or that a run has computed for a later stage.

use std::collections::HashMap;
use std::sync::Arc;

use opendr_engine::{Error, Result};
use opendr_kernels::{Arena, Number, Region};
use opendr_onnx::proto::{NodeProto, TensorProto};

use crate::attributes::Attributes;
use crate::tensor::{Data, Kind, Tensor, count};

/// Maximum number of bytes of the tensors of a run.
pub(crate) const MAX_BYTES: usize = 1 << 32;

/// Tensors by name.
pub(crate) type Constants = HashMap<String, Arc<Constant>>;

/// A tensor of its own memory.
#[derive(Debug)]
pub(crate) struct Constant {
    pub(crate) kind: Kind,
    pub(crate) shape: Vec<usize>,
    pub(crate) data: Arena,
    /// Whether another plan of the graph may have other elements or another shape.
    pub(crate) varies: bool,
}

impl Constant {
    pub(crate) fn region(&self) -> Region {
        Region { start: 0, bytes: self.shape.iter().product::<usize>() * self.kind.bytes() }
    }

    /// Returns the value of a condition.
    ///
    /// # Errors
    /// `Format` where it is no boolean, or several.
    pub(crate) fn truth(&self, node: &NodeProto) -> Result<bool> {
        match (self.kind, self.numbers::<u8>()) {
            (Kind::Bool, [value]) => Ok(*value != 0),
            _ => Err(node.damaged("its condition is no boolean")),
        }
    }

    pub(crate) fn floats(&self) -> Option<&[f32]> {
        (self.kind == Kind::F32).then(|| self.data.get(self.region()))
    }

    pub(crate) fn ints(&self) -> Option<Vec<i64>> {
        match self.kind {
            Kind::I64 => Some(self.data.get::<i64>(self.region()).to_vec()),
            Kind::I32 => {
                Some(self.data.get::<i32>(self.region()).iter().map(|&value| i64::from(value)).collect())
            }
            _ => None,
        }
    }

    pub(crate) fn from_ints(shape: Vec<usize>, values: &[i64]) -> Self {
        Self::of(Kind::I64, shape, values)
    }

    pub(crate) fn from_floats(shape: Vec<usize>, values: &[f32]) -> Self {
        Self::of(Kind::F32, shape, values)
    }

    /// Creates a tensor of numbers of the type that `kind` names.
    pub(crate) fn of<T: Number>(kind: Kind, shape: Vec<usize>, values: &[T]) -> Self {
        Self { kind, shape, data: Arena::from_numbers(values), varies: false }
    }

    /// Creates a tensor of zeros.
    ///
    /// # Errors
    /// `Format` or `Unsupported` when it is too large for memory.
    pub(crate) fn zeros(kind: Kind, shape: Vec<usize>) -> Result<Self> {
        let bytes = count(&shape)?.saturating_mul(kind.bytes());
        if bytes > MAX_BYTES {
            return Err(too_many(bytes));
        }
        Ok(Self { kind, shape, data: Arena::new(bytes), varies: false })
    }

    /// Copies a tensor of a run.
    pub(crate) fn copied(tensor: &Tensor<'_>) -> Self {
        let (kind, shape) = (tensor.data.kind(), tensor.shape.to_vec());
        let copy = match tensor.data {
            Data::F32(data) => Self::of(kind, shape, data),
            Data::I64(data) => Self::of(kind, shape, data),
            Data::I32(data) => Self::of(kind, shape, data),
            Data::U8(data) | Data::Bool(data) => Self::of(kind, shape, data),
            Data::I8(data) => Self::of(kind, shape, data),
        };
        copy.of_run()
    }

    /// Returns the tensor as one that a run has computed: another run may compute another one.
    pub(crate) fn of_run(self) -> Self {
        Self { varies: true, ..self }
    }

    /// Returns the tensor; `None` for 16-bit floats.
    pub(crate) fn tensor(&self) -> Option<Tensor<'_>> {
        Some(Tensor { shape: &self.shape, data: Data::read(self.kind, &self.data, self.region())? })
    }

    pub(crate) fn numbers<T: Number>(&self) -> &[T] {
        self.data.get(self.region())
    }

    pub(crate) fn numbers_mut<T: Number>(&mut self) -> &mut [T] {
        let region = self.region();
        self.data.split(region).0.numbers()
    }

    pub(crate) fn bytes(&self) -> usize {
        self.region().bytes
    }

    /// Returns whether type, shape and elements are the same.
    pub(crate) fn is_equal(&self, other: &Self) -> bool {
        self.kind == other.kind && self.shape == other.shape && self.numbers::<u8>() == other.numbers::<u8>()
    }

    /// Reads an initializer, whose memory it keeps where it can.
    pub(crate) fn from_tensor(mut tensor: TensorProto) -> Result<Self> {
        let raw = std::mem::take(&mut tensor.raw_data);
        let name = &tensor.name;
        if !tensor.external_data.is_empty() || tensor.data_location != 0 {
            return Err(Error::unsupported(format!(
                "the ONNX model keeps its weights {name:?} in another file; save it as one file"
            )));
        }
        let damaged = || {
            Error::format(format!(
                "damaged ONNX model: the size of the weights {name:?} does not match their shape"
            ))
        };
        let kind = Kind::from_onnx(tensor.data_type, name)?;
        let dims = tensor.dims.iter().map(|&dim| usize::try_from(dim).ok()).collect::<Option<Vec<_>>>();
        let shape = dims.ok_or_else(damaged)?;
        let elements = count(&shape)?;
        let data = if !raw.is_empty() {
            if raw.len() != elements * kind.bytes() {
                return Err(damaged());
            }
            match kind {
                Kind::U8 | Kind::I8 => Arena::from_bytes(raw),
                Kind::Bool => decoded(&raw, |[byte]: [u8; 1]| u8::from(byte != 0)),
                // The order of the file is that of memory.
                _ if cfg!(target_endian = "little") => Arena::from_bytes(raw),
                Kind::F32 => decoded(&raw, f32::from_le_bytes),
                Kind::I64 => decoded(&raw, i64::from_le_bytes),
                Kind::I32 => decoded(&raw, i32::from_le_bytes),
                Kind::F16 => decoded(&raw, u16::from_le_bytes),
            }
        } else {
            let ints = &tensor.int32_data;
            let length = match kind {
                Kind::F32 => tensor.float_data.len(),
                Kind::I64 => tensor.int64_data.len(),
                _ => ints.len(),
            };
            if length != elements {
                return Err(damaged());
            }
            match kind {
                Kind::F32 => Arena::from_numbers(&tensor.float_data),
                Kind::I64 => Arena::from_numbers(&tensor.int64_data),
                Kind::I32 => Arena::from_numbers(ints),
                Kind::F16 => Arena::from_numbers(&ints.iter().map(|&value| value as u16).collect::<Vec<_>>()),
                Kind::Bool => {
                    Arena::from_numbers(&ints.iter().map(|&value| u8::from(value != 0)).collect::<Vec<_>>())
                }
                Kind::U8 | Kind::I8 => {
                    Arena::from_numbers(&ints.iter().map(|&value| value as u8).collect::<Vec<_>>())
                }
            }
        };
        Ok(Self { kind, shape, data, varies: false })
    }
}

/// Reads the elements of a file's tensor.
fn decoded<T: Number, const BYTES: usize>(raw: &[u8], element: impl Fn([u8; BYTES]) -> T) -> Arena {
    let mut arena = Arena::new(raw.len());
    let region = Region { start: 0, bytes: raw.len() };
    let elements = arena.split(region).0.numbers::<T>();
    for (to, &bytes) in elements.iter_mut().zip(raw.as_chunks().0) {
        *to = element(bytes);
    }
    arena
}

/// What a plan knows of an input of the graph.
#[derive(Debug, Clone)]
pub(crate) struct Given {
    pub(crate) kind: Kind,
    pub(crate) shape: Vec<usize>,
    /// The elements, where they determine the plan.
    pub(crate) value: Option<Arc<Constant>>,
}

impl Given {
    /// Creates what is known where the elements are.
    pub(crate) fn value(value: &Arc<Constant>) -> Self {
        Self { kind: value.kind, shape: value.shape.clone(), value: Some(Arc::clone(value)) }
    }

    /// Returns whether a tensor has this type and shape, and these elements where they matter.
    pub(crate) fn fits(&self, tensor: &Tensor<'_>, value: Option<&Arc<Constant>>) -> bool {
        match (&self.value, value) {
            (Some(own), Some(value)) => Arc::ptr_eq(own, value) || own.is_equal(value),
            (None, None) => self.shape == tensor.shape && self.kind == tensor.data.kind(),
            _ => false,
        }
    }
}

/// Returns the error for tensors that memory cannot be expected to have.
pub(crate) fn too_many(bytes: usize) -> Error {
    Error::unsupported(format!("the ONNX model needs {bytes} bytes for its tensors"))
}
