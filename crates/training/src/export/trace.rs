//! Recording of one forward pass.

use std::collections::{BTreeMap, HashMap};

use burn::backend::capture::TensorId;
use burn::backend::ir::OperationIr;
use burn::tensor::{Device, TensorData};
use opendr_engine::{Error, Result};

use crate::traversal::{AnyModule, CapturedParam, Visit};

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
    /// Records `run`, which moves a network to the device, names its parameters and runs it.
    pub(super) fn record(run: &mut dyn FnMut(&Device, &mut Self) -> Result<()>) -> Result<Self> {
        // Each recording has its own device, so that Burn's caches return no tensors of an earlier one.
        let device = Device::capture();
        let (mut trace, mut done) = (Self::default(), Ok(()));
        let captured = device.capture_scope(|scope| {
            done = run(&device, &mut trace);
            // Inputs are created without values inside of the scope, so the scope has no boundary to check.
            scope.complete([], [])
        });
        done?;
        let captured = captured.map_err(|error| Error::internal(error.to_string()))?;
        trace.operations = captured.graph.operations;
        trace.operations.retain(|operation| !matches!(operation, OperationIr::Init(_)));
        trace.values = captured.values;
        Ok(trace)
    }

    /// Names the parameters of a network on the device of the recording.
    pub(super) fn name_parameters(&mut self, network: &dyn AnyModule) {
        let mut parameters = Parameters::default();
        network.visit_each(&mut parameters);
        self.names = parameters.names;
    }
}

/// Initialises every lazy parameter; it would be recorded as a random number otherwise.
pub(super) fn initialise(network: &dyn AnyModule) {
    network.visit_each(&mut Parameters::default());
}

/// Collects the paths of the parameters; reading a parameter makes Burn initialise it.
#[derive(Default)]
struct Parameters {
    path: Vec<String>,
    names: HashMap<TensorId, String>,
}

impl Visit for Parameters {
    fn enter(&mut self, name: &str, _: &str) {
        self.path.push(name.to_owned());
    }

    fn exit(&mut self) {
        self.path.pop();
    }

    fn any(&mut self, param: &dyn CapturedParam) {
        if let Some(id) = param.tensor_id() {
            self.names.insert(id, self.path.join("."));
        }
    }
}
