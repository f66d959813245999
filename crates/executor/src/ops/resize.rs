//! Resizing of height and width.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use super::inputs::{optional, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

pub(crate) fn resize(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    if planner.kind(x) != Kind::F32 {
        return Err(node.refused("its input"));
    }
    let Geometry { shape, rows, columns, is_linear } = Geometry::new(planner, node, inputs)?;
    let x = planner.channels_last(x)?;
    let step = ResizeStep { rows, columns, input: [dims[2], dims[3]], channels: dims[1], is_linear };
    Ok(vec![planner.emit_one(step, &[x], Kind::F32, shape, Layout::ChannelsLast)?])
}

/// Shape of the output, and what each row and column of it is made of.
pub(crate) struct Geometry {
    pub(crate) shape: Vec<usize>,
    pub(crate) rows: Vec<Point>,
    pub(crate) columns: Vec<Point>,
    pub(crate) is_linear: bool,
}

impl Geometry {
    pub(crate) fn new(planner: &Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Self> {
        let dims = planner.shape(required(node, inputs, 0)?);
        let old = planner.graph.opset < 11;
        if dims.len() != 4 || node.find("axes").is_some() || node.int_or("antialias", 0) != 0 {
            return Err(node.refused("its input, axes, or antialiasing"));
        }
        if node.text("keep_aspect_ratio_policy", "stretch") != "stretch" {
            return Err(node.refused("attribute \"keep_aspect_ratio_policy\""));
        }
        let scales = optional(inputs, if old { 1 } else { 2 }).and_then(|id| planner.constant(id));
        let scales = scales.as_ref().and_then(|scales| scales.floats()).filter(|scales| !scales.is_empty());
        let (shape, scales): (Vec<usize>, Vec<f64>) = match (scales, optional(inputs, 3)) {
            (Some(scales), _) if scales.len() == 4 => {
                let sizes = dims.iter().zip(scales).map(|(&dim, &scale)| {
                    let size = (dim as f64 * f64::from(scale)).floor();
                    ((0.0..16_777_216.0).contains(&size)).then_some(size as usize)
                });
                let sizes: Option<Vec<usize>> = sizes.collect();
                let sizes = sizes.ok_or_else(|| node.damaged(&format!("scales {scales:?}")))?;
                (sizes, scales.iter().map(|&scale| f64::from(scale)).collect())
            }
            (None, Some(sizes)) => {
                let sizes = super::movement::sizes(node, &planner.ints(node, sizes)?)?;
                if sizes.len() != 4 {
                    return Err(node.damaged("four sizes"));
                }
                let scales =
                    sizes.iter().zip(&dims).map(|(&size, &dim)| size as f64 / dim.max(1) as f64).collect();
                (sizes, scales)
            }
            _ => return Err(node.refused("scales that are not constant")),
        };
        count(&shape)?;
        if shape[..2] != dims[..2] || dims.contains(&0) {
            return Err(node.refused("other dimensions than height and width"));
        }
        let place =
            node.text("coordinate_transformation_mode", if old { "asymmetric" } else { "half_pixel" });
        let rounding = node.text("nearest_mode", if old { "floor" } else { "round_prefer_floor" });
        let mut axes = Vec::new();
        for d in 2..4 {
            let (input, output, scale) = (dims[d], shape[d], scales[d]);
            let at = |i: usize| -> Option<f64> {
                let i = i as f64;
                Some(match place.as_str() {
                    "half_pixel" => (i + 0.5) / scale - 0.5,
                    "pytorch_half_pixel" if output == 1 => 0.0,
                    "pytorch_half_pixel" => (i + 0.5) / scale - 0.5,
                    "asymmetric" => i / scale,
                    "align_corners" if output == 1 => 0.0,
                    "align_corners" => i * (input - 1) as f64 / (output - 1) as f64,
                    _ => return None,
                })
            };
            let points = (0..output).map(|i| {
                // Frameworks compute positions in single precision.
                let at = f64::from(at(i)? as f32);
                let last = (input - 1) as f64;
                if node.text("mode", "nearest") == "linear" {
                    let at = at.clamp(0.0, last);
                    let first = at.floor();
                    let next = (first + 1.0).min(last);
                    return Some(([first as usize, next as usize], (at - first) as f32));
                }
                let near = match rounding.as_str() {
                    "floor" => at.floor(),
                    "ceil" => at.ceil(),
                    "round_prefer_ceil" => (at + 0.5).floor(),
                    "round_prefer_floor" => (at - 0.5).ceil(),
                    _ => return None,
                };
                Some(([near.clamp(0.0, last) as usize; 2], 0.0))
            });
            let points: Option<Vec<Point>> = points.collect();
            axes.push(points.ok_or_else(|| node.refused(&format!("mode {place:?} with {rounding:?}")))?);
        }
        let mode = node.text("mode", "nearest");
        if mode != "linear" && mode != "nearest" {
            return Err(node.refused(&format!("mode {mode:?}")));
        }
        let (Some(columns), Some(rows)) = (axes.pop(), axes.pop()) else {
            return Err(node.damaged("its sizes"));
        };
        Ok(Self { shape, rows, columns, is_linear: mode == "linear" })
    }
}

/// Two neighbours and the weight of the second.
pub(crate) type Point = ([usize; 2], f32);

struct ResizeStep {
    rows: Vec<Point>,
    columns: Vec<Point>,
    input: [usize; 2],
    channels: usize,
    is_linear: bool,
}

impl Kernel for ResizeStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<f32>(0), io.write::<f32>());
        let channels = self.channels;
        if y.is_empty() {
            return Ok(());
        }
        let [height, width] = self.input;
        io.compute.pool().run_on_pieces(y, self.columns.len() * channels, |index, y| {
            let (image, oy) = (index / self.rows.len(), index % self.rows.len());
            let ([top, bottom], down) = self.rows[oy];
            let line = |row: usize| &x[(image * height + row) * width * channels..][..width * channels];
            let (above, below) = (line(top), line(bottom));
            for (y, &([left, right], across)) in y.chunks_exact_mut(channels).zip(&self.columns) {
                let at = |line: &'_ [f32], column: usize| {
                    column * channels..column * channels + channels.min(line.len())
                };
                let a = &above[at(above, left)];
                if !self.is_linear {
                    y.copy_from_slice(a);
                    continue;
                }
                let b = &above[at(above, right)];
                let (c, d) = (&below[at(below, left)], &below[at(below, right)]);
                blend(y, [a, b, c, d], across, down);
            }
        });
        Ok(())
    }
}

fn blend(y: &mut [f32], [a, b, c, d]: [&[f32]; 4], across: f32, down: f32) {
    let weights =
        [(1.0 - across) * (1.0 - down), across * (1.0 - down), (1.0 - across) * down, across * down];
    for ((((y, a), b), c), d) in y.iter_mut().zip(a).zip(b).zip(c).zip(d) {
        *y = a * weights[0] + b * weights[1] + c * weights[2] + d * weights[3];
    }
}
