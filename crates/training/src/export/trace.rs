//! Recording of one forward pass.

use std::collections::{BTreeMap, HashMap};

use burn::backend::capture::{CaptureBackend, TensorId};
use burn::backend::ir::OperationIr;
use burn::module::{Module, ModuleVisitor, Param};
use burn::tensor::{Bool, Device, Int, Tensor, TensorData};
use opendr_engine::{Error, Result};

use super::input::Inputs;
use super::output::Outputs;

/// Operations in the order of recording; every tensor has its own id.
#[derive(Debug, Default)]
pub(super) struct Trace {
    pub(super) operations: Vec<OperationIr>,
    pub(super) inputs: Vec<TensorId>,
    pub(super) outputs: Vec<TensorId>,
    /// Elements of the parameters, and of tensors that the forward pass creates from data.
    pub(super) values: BTreeMap<TensorId, TensorData>,
    /// Paths of the parameters in the network.
    pub(super) names: HashMap<TensorId, String>,
}

impl Trace {
    /// Records `forward` with `batch` as the size of open axes.
    pub(super) fn record<M: Module, I: Inputs, O: Outputs>(
        network: &M,
        inputs: &I,
        batch: usize,
        forward: &impl Fn(&M, I::Tensors) -> O,
    ) -> Result<Self> {
        // Each recording has its own device, so that Burn's caches return no tensors of an earlier one.
        let device = Device::capture();
        let mut recorded = Ok(Self::default());
        let captured = device.capture_scope(|scope| {
            recorded = Self::run(&network.clone().to_device(&device), inputs, batch, &device, forward);
            // Inputs are created without values inside of the scope, so the scope has no boundary to check.
            scope.complete([], [])
        });
        let mut trace = recorded?;
        let captured = captured.map_err(|error| Error::internal(error.to_string()))?;
        trace.operations = captured.graph.operations;
        trace.operations.retain(|operation| !matches!(operation, OperationIr::Init(_)));
        trace.values = captured.values;
        Ok(trace)
    }

    fn run<M: Module, I: Inputs, O: Outputs>(
        network: &M,
        inputs: &I,
        batch: usize,
        device: &Device,
        forward: &impl Fn(&M, I::Tensors) -> O,
    ) -> Result<Self> {
        let mut parameters = Parameters::default();
        network.visit(&mut parameters);
        let mut trace = Self { names: parameters.names, ..Self::default() };
        let tensors = inputs.tensors(batch, device, &mut trace.inputs)?;
        forward(network, tensors).ids(&mut trace.outputs)?;
        Ok(trace)
    }
}

/// Initialises every lazy parameter; it would be recorded as a random number otherwise.
pub(super) fn initialise<M: Module>(network: &M) {
    network.visit(&mut Parameters::default());
}

/// Collects the paths of the parameters; reading a parameter makes Burn initialise it.
#[derive(Default)]
struct Parameters {
    path: Vec<String>,
    names: HashMap<TensorId, String>,
}

impl Parameters {
    fn name(&mut self, id: TensorId) {
        self.names.insert(id, self.path.join("."));
    }
}

impl ModuleVisitor for Parameters {
    fn enter_module(&mut self, name: &str, _: &str) {
        self.path.push(name.to_owned());
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.path.pop();
    }

    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        if let Ok(tensor) = param.val().try_into_primitive::<CaptureBackend>() {
            self.name(tensor.id());
        }
    }

    fn visit_int<const D: usize>(&mut self, param: &Param<Tensor<D, Int>>) {
        if let Ok(tensor) = param.val().try_into_primitive::<CaptureBackend>() {
            self.name(tensor.id());
        }
    }

    fn visit_bool<const D: usize>(&mut self, param: &Param<Tensor<D, Bool>>) {
        if let Ok(tensor) = param.val().try_into_primitive::<CaptureBackend>() {
            self.name(tensor.id());
        }
    }
}
