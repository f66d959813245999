//! Constant folding: evaluation of operators with known inputs, so that shape arithmetic leaves no nodes.
//!
//! A function that returns `None` declines: the operator is then written into the graph and left to the runtime. No
//! function fails or panics, whatever the operands.

mod arithmetic;
mod indexing;
mod movement;
mod reduction;

pub use movement::slice_range;

use super::array::Array;
use super::operator::Operator;

/// Returns the outputs of `operator`, if it can be evaluated and all required inputs are known. An absent optional
/// input is `None`.
pub fn evaluate(operator: &Operator, inputs: &[Option<&Array>]) -> Option<Vec<Array>> {
    let input = |i: usize| inputs.get(i).copied().flatten();
    let ints = |i: usize| input(i).and_then(Array::as_ints);
    let x = input(0)?;
    let result = match operator.name() {
        "Identity" => x.clone(),
        "Reshape" => movement::reshape(x, ints(1)?)?,
        "Squeeze" => movement::squeeze(x, ints(1)?)?,
        "Unsqueeze" => movement::unsqueeze(x, ints(1)?)?,
        "Transpose" => movement::transpose(x, operator.get_ints("perm")?)?,
        "Expand" => movement::expand(x, ints(1)?)?,
        "Tile" => movement::tile(x, ints(1)?)?,
        "Slice" => movement::slice(x, ints(1)?, ints(2)?, ints(3)?, ints(4)?)?,
        "Gather" => movement::gather(x, input(1)?, operator.get_int("axis").unwrap_or(0))?,
        "Concat" => {
            let parts: Option<Vec<&Array>> = inputs.iter().copied().collect();
            movement::concat(&parts?, operator.get_int("axis")?)?
        }
        "Split" => return movement::split(x, ints(1)?, operator.get_int("axis").unwrap_or(0)),
        "ScatterND" => movement::scatter_nd(x, input(1)?, input(2)?)?,
        "Range" => arithmetic::range(x, input(1)?, input(2)?)?,
        "Cast" => arithmetic::cast(x, operator.get_int("to")?)?,
        "Where" => arithmetic::select(x, input(1)?, input(2)?)?,
        "ReduceSum" => reduction::reduce(operator, x, ints(1)?)?,
        "ReduceMax" | "ReduceMin" | "ReduceProd" | "ReduceMean" => {
            reduction::reduce(operator, x, operator.get_ints("axes")?)?
        }
        name => match input(1) {
            Some(y) => arithmetic::binary(name, x, y)?,
            None => arithmetic::unary(name, x)?,
        },
    };
    Some(vec![result])
}

#[cfg(test)]
mod tests;
