//! Scaled dot-product attention.

use opendr_engine::Result;
use opendr_onnx::proto::{AttributeProto, NodeProto};

use super::broadcast::Rows;
use super::concat::concat;
use super::inputs::{optional, required};
use super::matmul::batched;
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::remap::transposed;
use crate::tensor::{Kind, count};

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let debug = node.output.get(3).is_some_and(|name| !name.is_empty());
    if optional(inputs, 6).is_some() || debug || ![0, 1].contains(&node.int_or("softmax_precision", 0)) {
        return Err(node.refused("lengths of padded keys, its fourth output, or its precision"));
    }
    let query = required(node, inputs, 0)?;
    let is_flat = planner.rank(query) == 3;
    let q = heads(planner, node, query, "q_num_heads")?;
    let [k, v] = [1, 2].map(|slot| required(node, inputs, slot));
    let (mut k, mut v) =
        (heads(planner, node, k?, "kv_num_heads")?, heads(planner, node, v?, "kv_num_heads")?);
    let mut past = 0;
    if let (Some(past_k), Some(past_v)) = (optional(inputs, 4), optional(inputs, 5)) {
        past = planner.shape(past_k).get(2).copied().unwrap_or(0);
        k = joined(planner, past_k, k)?;
        v = joined(planner, past_v, v)?;
    }
    let (
        &[batch, q_heads, steps, size],
        &[k_batch, kv_heads, keys, k_size],
        &[v_batch, v_heads, v_keys, v_size],
    ) = (planner.shape(q).as_slice(), planner.shape(k).as_slice(), planner.shape(v).as_slice())
    else {
        return Err(node.damaged("query, key and value of different ranks"));
    };
    let fits = [k_batch, v_batch] == [batch; 2]
        && [v_heads, v_keys, k_size] == [kv_heads, keys, size]
        && kv_heads > 0
        && q_heads % kv_heads == 0;
    if !fits || [q, k, v].iter().any(|&id| planner.kind(id) != Kind::F32) {
        return Err(node.damaged("query, key and value do not match"));
    }
    // Queries of several heads share keys and values.
    let shared = q_heads / kv_heads;
    let offsets = |size: usize| (0..batch * q_heads).map(|head| head * size).collect::<Vec<_>>();
    let shared_offsets = |size: usize| {
        let of_head = |head: usize| (head / q_heads * kv_heads + head % q_heads / shared) * size;
        (0..batch * q_heads).map(of_head).collect::<Vec<_>>()
    };
    let flipped = transposed(&planner.shape(k), &[0, 1, 3, 2], 4);
    let k_flipped = vec![batch, kv_heads, size, keys];
    let k_flipped = planner.emit_one(flipped, &[k], Kind::F32, k_flipped, Layout::Plain)?;
    let scores = vec![batch, q_heads, steps, keys];
    count(&scores)?;
    let starts = [offsets(steps * size), shared_offsets(size * keys)];
    let raw = batched(planner, [q, k_flipped], [steps, size, keys], starts, scores.clone())?;
    let shares = shares(planner, node, raw, optional(inputs, 3), [size, past])?;
    let starts = [offsets(steps * keys), shared_offsets(keys * v_size)];
    let shape = vec![batch, q_heads, steps, v_size];
    let mut y = batched(planner, [shares, v], [steps, keys, v_size], starts, shape.clone())?;
    if is_flat {
        let order = transposed(&shape, &[0, 2, 1, 3], 4);
        let joined = q_heads.checked_mul(v_size).ok_or_else(|| node.damaged("its heads are too large"))?;
        y = planner.emit_one(order, &[y], Kind::F32, vec![batch, steps, joined], Layout::Plain)?;
    }
    Ok(vec![y, k, v])
}

/// Returns a value with the heads before the steps.
fn heads(planner: &mut Planner<'_>, node: &NodeProto, x: Id, key: &str) -> Result<Id> {
    let x = planner.plain(x)?;
    let &[batch, steps, hidden] = planner.shape(x).as_slice() else { return Ok(x) };
    let heads = usize::try_from(node.int_or(key, 0)).ok().filter(|&heads| heads > 0 && hidden % heads == 0);
    let heads = heads.ok_or_else(|| node.damaged(&format!("attribute {key:?}")))?;
    let (size, bytes) = (hidden / heads, planner.kind(x).bytes());
    let order = transposed(&[batch, steps, heads, size], &[0, 2, 1, 3], bytes);
    let kind = planner.kind(x);
    planner.emit_one(order, &[x], kind, vec![batch, heads, steps, size], Layout::Plain)
}

/// Appends the steps of a value to earlier ones.
fn joined(planner: &mut Planner<'_>, past: Id, x: Id) -> Result<Id> {
    let axis = AttributeProto { name: "axis".to_owned(), i: 2, ..AttributeProto::default() };
    let node = NodeProto { op_type: "Concat".to_owned(), attribute: vec![axis], ..NodeProto::default() };
    let joined = concat(planner, &node, &[Some(past), Some(x)])?;
    let joined = joined.first().copied().ok_or_else(|| node.damaged("its output"))?;
    planner.plain(joined)
}

/// Returns the share of each key for each query: the softmax of scaled, capped and masked products.
fn shares(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    raw: Id,
    mask: Option<Id>,
    [size, past]: [usize; 2],
) -> Result<Id> {
    let dims = planner.shape(raw);
    let mask = match mask {
        Some(mask) => Some(planner.plain(mask)?),
        None => None,
    };
    let mask_dims = mask.map_or_else(Vec::new, |mask| planner.shape(mask));
    let broadcasts = mask_dims.len() <= dims.len()
        && mask_dims.iter().rev().zip(dims.iter().rev()).all(|(own, dim)| own == dim || *own == 1);
    let kind = mask.map(|mask| planner.kind(mask));
    if !broadcasts || kind.is_some_and(|kind| !matches!(kind, Kind::F32 | Kind::Bool)) {
        return Err(node.refused("its mask"));
    }
    let bound = |key: &str| usize::try_from(node.int_or(key, -1)).ok();
    let is_causal = node.int_or("is_causal", 0) != 0;
    let step = SharesStep {
        scale: node.find("scale").map_or_else(|| 1.0 / (size as f32).sqrt(), |scale| scale.f),
        cap: node.float("softcap", 0.0),
        is_bool: kind == Some(Kind::Bool),
        rows: Rows::new(&dims, &[dims.clone(), mask_dims]),
        queries: dims[2],
        keys: dims[3],
        past,
        before: bound("left_window_size"),
        after: if is_causal { Some(0) } else { bound("right_window_size") },
    };
    let ids = planner.emit(step, &[Some(raw), mask], &[(Kind::F32, dims, Layout::Plain)])?;
    ids.first().copied().ok_or_else(|| node.damaged("its output"))
}

struct SharesStep {
    scale: f32,
    /// Bound of the scaled products; 0 for none.
    cap: f32,
    is_bool: bool,
    /// Reach of the mask.
    rows: Rows,
    queries: usize,
    keys: usize,
    /// Number of keys before the first query.
    past: usize,
    /// Number of keys before and after its own that a query sees.
    before: Option<usize>,
    after: Option<usize>,
}

impl Kernel for SharesStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<f32>(0), io.write::<f32>());
        let has_mask = io.has(1);
        let (floats, truths) =
            if self.is_bool { (&[][..], io.read::<u8>(1)) } else { (io.read::<f32>(1), &[][..]) };
        if y.is_empty() {
            return Ok(());
        }
        for (y, &x) in y.iter_mut().zip(x) {
            let scaled = x * self.scale;
            *y = if self.cap > 0.0 { self.cap * (scaled / self.cap).tanh() } else { scaled };
        }
        // The rows of the mask may be longer than those of the scores, which are joined where the mask allows it.
        let length = self.rows.length.max(1);
        if has_mask {
            for (row, y) in y.chunks_mut(length).enumerate() {
                let at = |i: usize| if self.rows.is_row[1] { i } else { 0 };
                if self.is_bool {
                    let mask = self.rows.of(truths, row, 1, y.len());
                    y.iter_mut()
                        .enumerate()
                        .filter(|(i, _)| mask[at(*i)] == 0)
                        .for_each(|(_, y)| *y = f32::NEG_INFINITY);
                } else {
                    let mask = self.rows.of(floats, row, 1, y.len());
                    y.iter_mut().enumerate().for_each(|(i, y)| *y += mask[at(i)]);
                }
            }
        }
        let isa = io.compute.isa();
        io.compute.pool().run_on_pieces(y, self.keys, |row, y| {
            let own = self.past + row % self.queries;
            let first = self.before.map_or(0, |before| own.saturating_sub(before)).min(y.len());
            let end =
                self.after.map_or(y.len(), |after| own.saturating_add(after).saturating_add(1).min(y.len()));
            y[..first].fill(f32::NEG_INFINITY);
            y[end.max(first)..].fill(f32::NEG_INFINITY);
            softmax(isa, y);
        });
        Ok(())
    }
}

/// Divides exponentials by their sum; a row without keys becomes 0.
fn softmax(isa: opendr_kernels::Isa, row: &mut [f32]) {
    let largest = row.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    if largest == f32::NEG_INFINITY {
        row.fill(0.0);
        return;
    }
    row.iter_mut().for_each(|x| *x -= largest);
    opendr_kernels::exp_in_place(isa, row);
    let sum: f32 = row.iter().sum();
    row.iter_mut().for_each(|x| *x /= sum);
}
