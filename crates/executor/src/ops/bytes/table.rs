//! Bytes that are dequantised and quantised anew: a table of 256 bytes.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use super::pattern::{dequantised, quantisation};
use crate::io::{Io, Kernel};
use crate::planner::{Id, Planner};
use crate::tensor::Kind;

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto) -> Result<Option<Vec<Id>>> {
    let Some(x) = node.input.first().and_then(|name| dequantised(planner, name)) else { return Ok(None) };
    let all = [f32::NEG_INFINITY, f32::INFINITY];
    let Some((scale, output)) = quantisation(planner, node, all) else { return Ok(None) };
    if scale == x.scale && output.zero == x.zero {
        return Ok(Some(vec![x.bytes]));
    }
    let value = planner.value(x.bytes).clone();
    let table = std::array::from_fn(|byte| {
        let number = if x.zero.is_signed { i32::from(byte as u8 as i8) } else { byte as i32 };
        let rounded = ((number - x.zero.zero) as f32 * x.scale / scale).round_ties_even() as i32;
        rounded.saturating_add(output.zero.zero).clamp(output.low, output.high) as u8
    });
    let kind = if output.zero.is_signed { Kind::I8 } else { Kind::U8 };
    let y = planner.emit_one(TableStep(table), &[x.bytes], kind, value.shape, value.layout)?;
    Ok(Some(vec![y]))
}

struct TableStep([u8; 256]);

impl Kernel for TableStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        const PIECE: usize = 1 << 14;
        let x = io.read::<u8>(0);
        io.compute.pool().run_on_pieces(io.write::<u8>(), PIECE, |index, y| {
            let x = &x[index * PIECE..][..y.len()];
            y.iter_mut().zip(x).for_each(|(y, &x)| *y = self.0[usize::from(x)]);
        });
        Ok(())
    }
}
