//! A model opened by the built-in runtime.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use opendr_engine::{Error, Result};
use rten::{Model, NodeId, RunOptions, ThreadPool, Value, ValueOrView, ValueView};
use rten_tensor::{AsView as _, Layout as _};
use smallvec::SmallVec;

use crate::onnx_header::OnnxHeader;
use crate::runtime::{Engine, Sink};
use crate::tensor::{ElementType, TensorData, TensorInfo, TensorView};

/// An rten model with the types that the ONNX file declares: rten has neither 64-bit integers nor booleans and
/// represents both as 32-bit integers.
pub(super) struct BuiltinEngine {
    model: Model,
    header: OnnxHeader,
    inputs: Vec<NodeId>,
    outputs: Vec<NodeId>,
    threads: Arc<ThreadPool>,
    /// Inputs converted to 32-bit integers; reused between runs.
    narrowed: Vec<Vec<i32>>,
    /// Outputs converted from 32-bit integers.
    widened: Vec<Widened>,
}

#[derive(Default)]
struct Widened {
    integers: Vec<i64>,
    ground_truths: Vec<bool>,
}

impl BuiltinEngine {
    pub(super) fn new(model: Model, header: OnnxHeader, threads: Arc<ThreadPool>) -> Result<Self> {
        let nodes = |infos: &[TensorInfo]| -> Result<Vec<NodeId>> {
            infos
                .iter()
                .map(|info| {
                    model.find_node(&info.name).ok_or_else(|| {
                        Error::format(format!("the graph of the ONNX model has no value {:?}", info.name))
                    })
                })
                .collect()
        };
        let (inputs, outputs) = (nodes(&header.inputs)?, nodes(&header.outputs)?);
        let narrowed = vec![Vec::new(); inputs.len()];
        let widened = (0..outputs.len()).map(|_| Widened::default()).collect();
        Ok(Self { model, header, inputs, outputs, threads, narrowed, widened })
    }

    fn values(&mut self, inputs: &[TensorView<'_>]) -> Result<Vec<Value>> {
        for (input, narrowed) in inputs.iter().zip(&mut self.narrowed) {
            narrow(input, narrowed)?;
        }
        let inputs = (self.inputs.iter().zip(inputs).zip(&self.narrowed))
            .map(|((&node, input), narrowed)| Ok((node, value_from_tensor(input, narrowed)?)))
            .collect::<Result<Vec<_>>>()?;
        let options = RunOptions::default().with_thread_pool(Some(Arc::clone(&self.threads)));
        // An operator of rten that panics on an unexpected shape must not end the process.
        catch_unwind(AssertUnwindSafe(|| self.model.run(inputs, &self.outputs, Some(options))))
            .map_err(|_| Error::internal("the built-in runtime panicked; try ONNX Runtime"))?
            .map_err(|error| Error::internal("the built-in runtime cannot run the model").with_source(error))
    }
}

impl Engine for BuiltinEngine {
    fn inputs(&self) -> &[TensorInfo] {
        &self.header.inputs
    }

    fn outputs(&self) -> &[TensorInfo] {
        &self.header.outputs
    }

    fn run(&mut self, inputs: &[TensorView<'_>], sink: &mut Sink<'_>) -> Result<()> {
        let mut values = self.values(inputs)?;
        for ((value, info), widened) in values.iter_mut().zip(&self.header.outputs).zip(&mut self.widened) {
            widened.fill(value, info.element_type);
        }
        let outputs = values
            .iter()
            .zip(&self.header.outputs)
            .zip(&self.widened)
            .map(|((value, info), widened)| tensor_from_value(value, info, widened))
            .collect::<Result<SmallVec<[_; 16]>>>()?;
        sink(&outputs)
    }
}

impl Widened {
    /// Makes the elements of `value` contiguous, and converts those that rten holds as 32-bit integers.
    fn fill(&mut self, value: &mut Value, declared: ElementType) {
        match value {
            Value::FloatTensor(tensor) => tensor.make_contiguous(),
            Value::UInt8Tensor(tensor) => tensor.make_contiguous(),
            Value::Int8Tensor(tensor) => tensor.make_contiguous(),
            Value::Int32Tensor(tensor) => {
                tensor.make_contiguous();
                self.integers.clear();
                self.ground_truths.clear();
                match declared {
                    ElementType::I64 => self.integers.extend(tensor.iter().map(|&value| i64::from(value))),
                    ElementType::Bool => self.ground_truths.extend(tensor.iter().map(|&value| value != 0)),
                    _ => {}
                }
            }
            _ => {}
        }
    }
}

fn narrow(input: &TensorView<'_>, narrowed: &mut Vec<i32>) -> Result<()> {
    narrowed.clear();
    match input.data() {
        TensorData::I64(data) => {
            for &value in data {
                narrowed.push(i32::try_from(value).map_err(|_| {
                    Error::unsupported(format!(
                        "the built-in runtime supports integers of 32 bits, but the input contains {value}; use ONNX Runtime"
                    ))
                })?);
            }
        }
        TensorData::Bool(data) => narrowed.extend(data.iter().map(|&value| i32::from(value))),
        _ => {}
    }
    Ok(())
}

fn value_from_tensor<'a>(input: &TensorView<'a>, narrowed: &'a [i32]) -> Result<ValueOrView<'a>> {
    let shape = input.shape();
    let view = match input.data() {
        TensorData::F32(data) => ValueView::from_shape(shape, data).ok(),
        TensorData::I32(data) => ValueView::from_shape(shape, data).ok(),
        TensorData::I64(_) | TensorData::Bool(_) => ValueView::from_shape(shape, narrowed).ok(),
        TensorData::U8(data) => ValueView::from_shape(shape, data).ok(),
        TensorData::I8(data) => ValueView::from_shape(shape, data).ok(),
    };
    view.map(Into::into).ok_or_else(|| {
        Error::invalid_input(format!(
            "the built-in runtime does not support the input {input:?}; use ONNX Runtime"
        ))
    })
}

fn tensor_from_value<'a>(
    value: &'a Value,
    info: &TensorInfo,
    widened: &'a Widened,
) -> Result<TensorView<'a>> {
    let shape = value.shape();
    let view = match (value, info.element_type) {
        (Value::FloatTensor(tensor), ElementType::F32) => {
            tensor.data().map(|data| TensorView::new(&shape, data))
        }
        (Value::UInt8Tensor(tensor), ElementType::U8) => {
            tensor.data().map(|data| TensorView::new(&shape, data))
        }
        (Value::Int8Tensor(tensor), ElementType::I8) => {
            tensor.data().map(|data| TensorView::new(&shape, data))
        }
        (Value::Int32Tensor(tensor), ElementType::I32) => {
            tensor.data().map(|data| TensorView::new(&shape, data))
        }
        (Value::Int32Tensor(_), ElementType::I64) => Some(TensorView::new(&shape, &widened.integers)),
        (Value::Int32Tensor(_), ElementType::Bool) => Some(TensorView::new(&shape, &widened.ground_truths)),
        _ => None,
    };
    view.unwrap_or_else(|| {
        Err(Error::internal(format!("the built-in runtime returned {} for output {info}", value.dtype())))
    })
}
