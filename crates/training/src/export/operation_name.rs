//! Names of operations in messages.

use burn::backend::ir::OperationIr;

/// Returns the operation with the sizes of its tensors: `Conv2d of [1, 3, 8, 8], [4, 3, 3, 3] to [1, 4, 6, 6]`.
pub(super) fn operation_name(operation: &OperationIr) -> String {
    let sizes = |tensors: Vec<String>| tensors.join(", ");
    let inputs = sizes(operation.inputs().map(|tensor| format!("{:?}", tensor.shape.as_slice())).collect());
    let outputs = sizes(operation.outputs().map(|tensor| format!("{:?}", tensor.shape.as_slice())).collect());
    format!("{} of {inputs} to {outputs}", variant(operation))
}

/// Returns the innermost variant: `Conv2d` of `Module(Conv2d(Conv2dOpIr { .. }))`.
fn variant(operation: &OperationIr) -> String {
    if let OperationIr::Custom(custom) = operation {
        return custom.id.clone();
    }
    let debug = format!("{operation:?}");
    let outer = debug.split("Ir {").next().unwrap_or_default();
    let variants: Vec<&str> = outer.split(['(', ' ', ',']).filter(|part| !part.is_empty()).collect();
    variants
        .len()
        .checked_sub(2)
        .and_then(|inner| variants.get(inner))
        .copied()
        .unwrap_or("operation")
        .to_owned()
}
