//! A model opened by ONNX Runtime.

use opendr_engine::{Device, Error, Result};
use ort::session::{Session, SessionInputValue};
use ort::value::{DynValue, Outlet, TensorElementType, TensorRef, ValueType};
use smallvec::SmallVec;

use super::message::message_of;
use crate::runtime::{Engine, Sink};
use crate::tensor::{Element, ElementType, MAX_RANK, TensorData, TensorInfo, TensorView};

pub(super) struct OnnxRuntimeEngine {
    session: Session,
    device: Device,
    inputs: Vec<TensorInfo>,
    outputs: Vec<TensorInfo>,
}

impl OnnxRuntimeEngine {
    pub(super) fn new(session: Session, device: Device) -> Result<Self> {
        let infos = |outlets: &[Outlet]| outlets.iter().map(info_from_outlet).collect::<Result<Vec<_>>>();
        let (inputs, outputs) = (infos(session.inputs())?, infos(session.outputs())?);
        Ok(Self { session, device, inputs, outputs })
    }
}

impl Engine for OnnxRuntimeEngine {
    fn inputs(&self) -> &[TensorInfo] {
        &self.inputs
    }

    fn outputs(&self) -> &[TensorInfo] {
        &self.outputs
    }

    fn device(&self) -> Device {
        self.device
    }

    fn run(&mut self, inputs: &[TensorView<'_>], sink: &mut Sink<'_>) -> Result<()> {
        let inputs = inputs.iter().map(value_from_tensor).collect::<Result<SmallVec<[_; 4]>>>()?;
        let values = self.session.run(&inputs[..]).map_err(|error| {
            Error::internal("ONNX Runtime cannot run the model").with_source(message_of(&error))
        })?;
        let outputs = (self.outputs.iter().enumerate())
            .map(|(index, info)| tensor_from_value(&values[index], info))
            .collect::<Result<SmallVec<[_; 16]>>>()?;
        sink(&outputs)
    }
}

fn info_from_outlet(outlet: &Outlet) -> Result<TensorInfo> {
    let refuse = |what: &str| {
        Err(Error::unsupported(format!(
            "{:?} of the ONNX model is {what}; a session supports tensors of f32, i32, i64, u8, i8 and bool",
            outlet.name()
        )))
    };
    let ValueType::Tensor { ty, shape, .. } = outlet.dtype() else { return refuse("not a tensor") };
    let element_type = match ty {
        TensorElementType::Float32 => ElementType::F32,
        TensorElementType::Int32 => ElementType::I32,
        TensorElementType::Int64 => ElementType::I64,
        TensorElementType::Uint8 => ElementType::U8,
        TensorElementType::Int8 => ElementType::I8,
        TensorElementType::Bool => ElementType::Bool,
        other => return refuse(&format!("a tensor of {other}")),
    };
    if shape.len() > MAX_RANK {
        return refuse(&format!("a tensor of {} dimensions", shape.len()));
    }
    let dims = shape.iter().map(|&dim| usize::try_from(dim).ok()).collect();
    Ok(TensorInfo { name: outlet.name().to_owned(), element_type, dims })
}

fn value_from_tensor<'a>(tensor: &'a TensorView<'a>) -> Result<SessionInputValue<'a>> {
    let shape = tensor.shape();
    let value = match tensor.data() {
        TensorData::F32(data) => TensorRef::from_array_view((shape, data)).map(Into::into),
        TensorData::I32(data) => TensorRef::from_array_view((shape, data)).map(Into::into),
        TensorData::I64(data) => TensorRef::from_array_view((shape, data)).map(Into::into),
        TensorData::U8(data) => TensorRef::from_array_view((shape, data)).map(Into::into),
        TensorData::I8(data) => TensorRef::from_array_view((shape, data)).map(Into::into),
        TensorData::Bool(data) => TensorRef::from_array_view((shape, data)).map(Into::into),
    };
    value.map_err(|error: ort::Error| {
        Error::invalid_input(format!("ONNX Runtime does not accept {tensor:?}"))
            .with_source(message_of(&error))
    })
}

fn tensor_from_value<'a>(value: &'a DynValue, info: &TensorInfo) -> Result<TensorView<'a>> {
    match info.element_type {
        ElementType::F32 => typed::<f32>(value),
        ElementType::I32 => typed::<i32>(value),
        ElementType::I64 => typed::<i64>(value),
        ElementType::U8 => typed::<u8>(value),
        ElementType::I8 => typed::<i8>(value),
        ElementType::Bool => typed::<bool>(value),
    }
}

fn typed<T: Element + ort::value::PrimitiveTensorElementType>(value: &DynValue) -> Result<TensorView<'_>> {
    let (shape, data) = value.try_extract_tensor::<T>().map_err(|error| {
        Error::internal("ONNX Runtime returned an output of another type than declared")
            .with_source(message_of(&error))
    })?;
    let shape: SmallVec<[usize; MAX_RANK]> =
        shape.iter().map(|&dim| usize::try_from(dim).unwrap_or(0)).collect();
    TensorView::new(&shape, data)
}
