//! The built-in runtime: the graph executor on our own kernels, available without any installed library.

use std::sync::{Arc, Mutex, PoisonError, Weak};

use opendr_engine::{Device, Error, ErrorKind, Result};
use opendr_executor::{Data, Executor, LayerProfile, Tensor};
use opendr_kernels::{Compute, Isa, WorkerPool};
use smallvec::SmallVec;

use crate::onnx_header::OnnxHeader;
use crate::runtime::{Engine, Runtime, SessionOptions, Sink};
use crate::tensor::{ElementType, TensorData, TensorInfo, TensorView};

/// The built-in runtime: the graph executor. Runs on the CPU only; always available. It refuses models with operators that it
/// lacks.
#[derive(Debug, Clone, Copy, Default)]
pub struct Builtin;

impl Runtime for Builtin {
    fn name(&self) -> &'static str {
        "builtin"
    }

    fn version(&self) -> String {
        format!("{} ({})", env!("CARGO_PKG_VERSION"), Isa::best())
    }

    fn devices(&self) -> Vec<Device> {
        vec![Device::Cpu]
    }

    fn open(&self, bytes: &[u8], options: &SessionOptions) -> Result<Box<dyn Engine>> {
        if !matches!(options.device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "the built-in runtime does not support device {}, only cpu; install ONNX Runtime for other devices",
                options.device
            )));
        }
        let header = OnnxHeader::read(bytes)?;
        let executor = Executor::open(bytes, compute(options.thread_count()?)).map_err(with_advice)?;
        let narrow = vec![Vec::new(); header.inputs.len()];
        let truths = vec![Vec::new(); header.outputs.len()];
        Ok(Box::new(ExecutorEngine { executor, header, narrow, truths }))
    }

    fn describe(&self) -> String {
        format!("built-in (graph executor, {})", Isa::best())
    }
}

/// Adds to an error about what the executor lacks that another runtime may have it.
fn with_advice(error: Error) -> Error {
    if error.kind() != ErrorKind::Unsupported {
        return error;
    }
    Error::unsupported(format!(
        "{}; ONNX Runtime may run it: \"opendr runtime install\" installs it",
        error.message()
    ))
}

static POOLS: Mutex<Vec<(usize, Weak<WorkerPool>)>> = Mutex::new(Vec::new());

/// Returns the kernels on a pool that all sessions with the same number of threads share.
pub(crate) fn compute(threads: usize) -> Compute {
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    pools.retain(|(_, pool)| pool.strong_count() > 0);
    let found = pools.iter().find(|(count, _)| *count == threads).and_then(|(_, pool)| pool.upgrade());
    let pool = found.unwrap_or_else(|| {
        let pool = Arc::new(WorkerPool::new(threads));
        pools.push((threads, Arc::downgrade(&pool)));
        pool
    });
    Compute::new(Isa::best(), pool)
}

struct ExecutorEngine {
    executor: Executor,
    header: OnnxHeader,
    /// Booleans of inputs as bytes; reused between runs.
    narrow: Vec<Vec<u8>>,
    /// Booleans of outputs.
    truths: Vec<Vec<bool>>,
}

impl Engine for ExecutorEngine {
    fn inputs(&self) -> &[TensorInfo] {
        &self.header.inputs
    }

    fn outputs(&self) -> &[TensorInfo] {
        &self.header.outputs
    }

    fn run(&mut self, inputs: &[TensorView<'_>], sink: &mut Sink<'_>) -> Result<()> {
        self.run_by(inputs, sink, Executor::run)
    }

    fn profile(&mut self, inputs: &[TensorView<'_>], sink: &mut Sink<'_>) -> Result<Vec<LayerProfile>> {
        self.run_by(inputs, sink, Executor::profile)
    }
}

impl ExecutorEngine {
    /// Calls `run` with the inputs as the executor has them, and `sink` with its outputs as sessions have them.
    fn run_by<R>(
        &mut self,
        inputs: &[TensorView<'_>],
        sink: &mut Sink<'_>,
        run: impl FnOnce(&mut Executor, &[Tensor<'_>], &mut dyn FnMut(&[Tensor<'_>]) -> Result<()>) -> Result<R>,
    ) -> Result<R> {
        for (input, narrow) in inputs.iter().zip(&mut self.narrow) {
            if let TensorData::Bool(data) = input.data() {
                narrow.clear();
                narrow.extend(data.iter().map(|&value| u8::from(value)));
            }
        }
        let shapes: SmallVec<[&[usize]; 8]> = inputs.iter().map(TensorView::shape).collect();
        let tensors: SmallVec<[Tensor<'_>; 8]> = inputs
            .iter()
            .zip(&shapes)
            .zip(&self.narrow)
            .map(|((input, shape), narrow)| Tensor { shape, data: data(input, narrow) })
            .collect();
        let (truths, infos) = (&mut self.truths, &self.header.outputs);
        let mut has_run = false;
        let ran = run(&mut self.executor, &tensors, &mut |outputs| {
            has_run = true;
            for ((output, info), truths) in outputs.iter().zip(infos).zip(truths.iter_mut()) {
                if let (Data::Bool(data), ElementType::Bool) = (output.data, info.element_type) {
                    truths.clear();
                    truths.extend(data.iter().map(|&value| value != 0));
                }
            }
            let views = outputs
                .iter()
                .zip(truths.iter())
                .map(|(output, truths)| view(output, truths))
                .collect::<Result<SmallVec<[_; 16]>>>()?;
            sink(&views)
        });
        // Errors of the sink stay as they are.
        if has_run { ran } else { ran.map_err(with_advice) }
    }
}

fn data<'a>(input: &TensorView<'a>, narrow: &'a [u8]) -> Data<'a> {
    match input.data() {
        TensorData::F32(data) => Data::F32(data),
        TensorData::I32(data) => Data::I32(data),
        TensorData::I64(data) => Data::I64(data),
        TensorData::U8(data) => Data::U8(data),
        TensorData::I8(data) => Data::I8(data),
        TensorData::Bool(_) => Data::Bool(narrow),
    }
}

fn view<'a>(output: &Tensor<'a>, truths: &'a [bool]) -> Result<TensorView<'a>> {
    match output.data {
        Data::F32(data) => TensorView::new(output.shape, data),
        Data::I64(data) => TensorView::new(output.shape, data),
        Data::I32(data) => TensorView::new(output.shape, data),
        Data::U8(data) => TensorView::new(output.shape, data),
        Data::I8(data) => TensorView::new(output.shape, data),
        Data::Bool(_) => TensorView::new(output.shape, truths),
    }
}
