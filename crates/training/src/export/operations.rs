//! Lowering of a recording to an ONNX graph: the choice of the function that writes an operation.

use burn::backend::ir::{ModuleOperationIr, OperationIr};
use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::proto::GraphProto;

use super::lowering::Lowering;
use super::operation_name::operation_name;
use super::{
    activation, arithmetic, attention, comparison, convolution, creation, function, indexing, matrix,
    normalization, pooling, rearrangement, recurrent, reduction, resampling, sorting,
};

impl Lowering<'_> {
    /// Writes all operations and the outputs of the graph.
    ///
    /// # Errors
    /// `Unsupported` with the name of an operation that has no lowering.
    pub(super) fn lower(mut self, outputs: &[&str]) -> Result<GraphProto> {
        for operation in &self.trace.operations {
            // Inputs are recorded as tensors without values.
            if operation.outputs().all(|tensor| self.wires.contains_key(&tensor.id)) {
                continue;
            }
            let context = || format!("cannot export {}", operation_name(operation));
            if !self.operation(operation).context(context)? {
                return Err(Error::unsupported(format!(
                    "{} has no lowering to ONNX; use other operations in the layer, or add one to \
                     crates/training/src/export",
                    operation_name(operation)
                )));
            }
        }
        for (&id, name) in self.trace.outputs.iter().zip(outputs) {
            let wire = self.wire_of(id)?;
            let open: Vec<&str> = self.sizes.of_id(id).iter().map(|size| size.open_name()).collect();
            self.builder.output(name, &wire, "", &open)?;
        }
        Ok(self.builder.finish("network"))
    }

    fn operation(&mut self, operation: &OperationIr) -> Result<bool> {
        match operation {
            OperationIr::BaseFloat(base) | OperationIr::BaseInt(base) | OperationIr::BaseBool(base) => {
                Ok(rearrangement::lower(self, base)?
                    || indexing::lower(self, base)?
                    || creation::lower(self, base)?
                    || comparison::lower(self, base)?
                    || reduction::lower_base(self, base)?)
            }
            OperationIr::NumericFloat(_, numeric) | OperationIr::NumericInt(_, numeric) => {
                Ok(arithmetic::lower(self, numeric)?
                    || reduction::lower(self, numeric)?
                    || comparison::lower_numeric(self, numeric)?
                    || sorting::lower(self, numeric)?
                    || creation::lower_numeric(self, numeric)?)
            }
            OperationIr::Bool(bool) => comparison::lower_bool(self, bool),
            OperationIr::Int(int) => function::lower_int(self, int),
            OperationIr::Float(_, float) => Ok(function::lower(self, float)?
                || matrix::lower(self, float)?
                || resampling::lower_grid(self, float)?),
            OperationIr::Activation(activation) => activation::lower(self, activation),
            OperationIr::Module(module) => self.module(module),
            OperationIr::Custom(custom) => recurrent::lower(self, custom),
            OperationIr::Init(_) | OperationIr::Drop(_) => Ok(true),
            OperationIr::Distributed(_) => Ok(false),
        }
    }

    fn module(&mut self, module: &ModuleOperationIr) -> Result<bool> {
        Ok(convolution::lower(self, module)?
            || pooling::lower(self, module)?
            || normalization::lower(self, module)?
            || matrix::lower_module(self, module)?
            || resampling::lower(self, module)?
            || indexing::lower_module(self, module)?
            || attention::lower(self, module)?)
    }
}
