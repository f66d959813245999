//! Inputs and outputs that a model declares.

use opendr_engine::{Error, Result};
use opendr_onnx::proto::{DimensionValue, TypeValue, ValueInfoProto};

use crate::tensor::Kind;

/// A declared input or output.
#[derive(Debug, Clone)]
pub(crate) struct Declared {
    pub(crate) name: String,
    pub(crate) kind: Kind,
    pub(crate) dims: Vec<Option<usize>>,
}

pub(crate) fn declared<'a>(infos: impl Iterator<Item = &'a ValueInfoProto>) -> Result<Vec<Declared>> {
    infos
        .map(|info| {
            let name = info.name.clone();
            let Some(TypeValue::Tensor(tensor)) = info.r#type.as_ref().and_then(|kind| kind.value.as_ref())
            else {
                return Err(Error::unsupported(format!("{name:?} of the ONNX model is not a tensor")));
            };
            let kind = Kind::from_onnx(tensor.elem_type, &name)?;
            if kind == Kind::F16 {
                return Err(Error::unsupported(format!("{name:?} of the ONNX model has 16-bit floats")));
            }
            let dims = tensor.shape.iter().flat_map(|shape| &shape.dim);
            let dims = dims.map(|dim| match &dim.value {
                Some(DimensionValue::Value(size)) => usize::try_from(*size).ok(),
                _ => None,
            });
            Ok(Declared { name, kind, dims: dims.collect() })
        })
        .collect()
}
