//! Resizing of height and width, or of a length.

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
    if node.text("mode", "nearest") == "cubic" {
        let Axes { shape, input, positions: [rows, columns] } = Axes::new(planner, node, inputs)?;
        let rows = Cubic::of_axis(node, &rows, input[0])?;
        let columns = Cubic::of_axis(node, &columns, input[1])?;
        let x = planner.channels_last(x)?;
        let step = CubicStep(Lines { rows, columns, input, channels: dims[1] });
        return Ok(vec![planner.emit_one(step, &[x], Kind::F32, shape, Layout::ChannelsLast)?]);
    }
    let Geometry { shape, input, rows, columns, is_linear } = Geometry::new(planner, node, inputs)?;
    let x = planner.channels_last(x)?;
    let lines = Lines { rows, columns, input, channels: dims[1] };
    let step = ResizeStep { lines, is_linear };
    Ok(vec![planner.emit_one(step, &[x], Kind::F32, shape, Layout::ChannelsLast)?])
}

/// Returns whether positions and inputs are those of `Upsample` and of the first `Resize`.
fn is_old(planner: &Planner<'_>, node: &NodeProto) -> bool {
    planner.graph.opset < 11 || node.op_type == "Upsample"
}

/// Shape of the output, number of rows and columns of the input, and the positions in it of those of the output. A sequence
/// `[batch, channels, length]` is an image of one row.
struct Axes {
    shape: Vec<usize>,
    input: [usize; 2],
    positions: [Vec<f64>; 2],
}

impl Axes {
    fn new(planner: &Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Self> {
        let dims = planner.shape(required(node, inputs, 0)?);
        let (rank, old) = (dims.len(), is_old(planner, node));
        if !(3..=4).contains(&rank) || node.find("axes").is_some() || node.int_or("antialias", 0) != 0 {
            return Err(node.refused("its input, axes, or antialiasing"));
        }
        if node.text("keep_aspect_ratio_policy", "stretch") != "stretch" {
            return Err(node.refused("attribute \"keep_aspect_ratio_policy\""));
        }
        let scales = match optional(inputs, if old { 1 } else { 2 }) {
            Some(id) => Some(planner.known(node, id)?),
            None => None,
        };
        // `Upsample` had its scales as an attribute at first.
        let attribute = node.find("scales").map(|scales| scales.floats.as_slice());
        let scales = scales.as_ref().and_then(|scales| scales.floats()).or(attribute);
        let scales = scales.filter(|scales| !scales.is_empty());
        let (shape, scales): (Vec<usize>, Vec<f64>) = match (scales, optional(inputs, 3)) {
            (Some(scales), _) if scales.len() == rank => {
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
                if sizes.len() != rank {
                    return Err(node.damaged(&format!("{} sizes for {rank} dimensions", sizes.len())));
                }
                let scales =
                    sizes.iter().zip(&dims).map(|(&size, &dim)| size as f64 / dim.max(1) as f64).collect();
                (sizes, scales)
            }
            _ => return Err(node.damaged("neither a scale nor a size for each dimension")),
        };
        count(&shape)?;
        if shape[..2] != dims[..2] || dims.contains(&0) {
            return Err(node.refused("other dimensions than height and width, or the length"));
        }
        let place =
            node.text("coordinate_transformation_mode", if old { "asymmetric" } else { "half_pixel" });
        let positions = |d: usize| -> Result<Vec<f64>> {
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
            // Frameworks compute positions in single precision.
            let positions: Option<Vec<f64>> = (0..output).map(|i| Some(f64::from(at(i)? as f32))).collect();
            positions.ok_or_else(|| node.refused(&format!("mode {place:?}")))
        };
        let columns = positions(rank - 1)?;
        let (rows, height) = if rank == 4 { (positions(2)?, dims[2]) } else { (vec![0.0], 1) };
        Ok(Self { shape, input: [height, dims[rank - 1]], positions: [rows, columns] })
    }
}

/// Shape of the output, and what each row and column of it is made of.
pub(crate) struct Geometry {
    pub(crate) shape: Vec<usize>,
    /// Number of rows and columns of the input.
    pub(crate) input: [usize; 2],
    pub(crate) rows: Vec<Point>,
    pub(crate) columns: Vec<Point>,
    pub(crate) is_linear: bool,
}

impl Geometry {
    pub(crate) fn new(planner: &Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Self> {
        let Axes { shape, input, positions: [rows, columns] } = Axes::new(planner, node, inputs)?;
        let mode = node.text("mode", "nearest");
        // The name of two dimensions in the first `Upsample`.
        let mode = if mode == "bilinear" { "linear".to_owned() } else { mode };
        if mode != "linear" && mode != "nearest" {
            return Err(node.refused(&format!("mode {mode:?}")));
        }
        let old = is_old(planner, node);
        let rounding = node.text("nearest_mode", if old { "floor" } else { "round_prefer_floor" });
        let points = |positions: &[f64], input: usize| -> Result<Vec<Point>> {
            let last = (input - 1) as f64;
            let points = positions.iter().map(|&at| {
                if mode == "linear" {
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
            points.ok_or_else(|| node.refused(&format!("nearest mode {rounding:?}")))
        };
        let (rows, columns) = (points(&rows, input[0])?, points(&columns, input[1])?);
        Ok(Self { shape, input, rows, columns, is_linear: mode == "linear" })
    }
}

/// Four neighbours of a position along an axis and their weights.
#[derive(Clone, Copy)]
struct Cubic {
    places: [usize; 4],
    weights: [f32; 4],
}

impl Cubic {
    /// Returns the neighbours of each position; those outside of `0..input` are at the edge, or excluded if the node states so.
    fn of_axis(node: &NodeProto, positions: &[f64], input: usize) -> Result<Vec<Self>> {
        let a = f64::from(node.float("cubic_coeff_a", -0.75));
        let excludes = node.int_or("exclude_outside", 0) != 0;
        let last = input as f64 - 1.0;
        let cubics = positions.iter().map(|&at| {
            let whole = at.floor();
            let share = at - whole;
            let near = |x: f64| ((a + 2.0) * x - (a + 3.0)) * x * x + 1.0;
            let far = |x: f64| ((a * x - 5.0 * a) * x + 8.0 * a) * x - 4.0 * a;
            let mut weights = [far(share + 1.0), near(share), near(1.0 - share), far(2.0 - share)];
            let places = [-1.0, 0.0, 1.0, 2.0].map(|step| whole + step);
            if excludes {
                for (weight, place) in weights.iter_mut().zip(places) {
                    if !(0.0..=last).contains(&place) {
                        *weight = 0.0;
                    }
                }
                let sum: f64 = weights.iter().sum();
                weights = weights.map(|weight| weight / sum);
            }
            Self {
                places: places.map(|place| place.clamp(0.0, last) as usize),
                weights: weights.map(|weight| weight as f32),
            }
        });
        let cubics: Vec<Self> = cubics.collect();
        let is_finite = cubics.iter().flat_map(|cubic| cubic.weights).all(f32::is_finite);
        if is_finite { Ok(cubics) } else { Err(node.damaged("its positions or \"cubic_coeff_a\"")) }
    }
}

/// What each row and column of the output is made of, and the size of an input image and its number of channels.
struct Lines<P> {
    rows: Vec<P>,
    columns: Vec<P>,
    input: [usize; 2],
    channels: usize,
}

impl<P: Sync> Lines<P> {
    /// Calls `fill` for each row of the output: with what it is made of, the input image, and the row.
    fn for_each(&self, io: &mut Io<'_>, fill: impl Fn(&P, &[f32], &mut [f32]) + Sync) {
        let (x, y) = (io.read::<f32>(0), io.write::<f32>());
        if y.is_empty() {
            return;
        }
        let image = self.input.iter().product::<usize>() * self.channels;
        io.compute.pool().run_on_pieces(y, self.columns.len() * self.channels, |index, y| {
            let (at, row) = (index / self.rows.len(), index % self.rows.len());
            fill(&self.rows[row], &x[at * image..][..image], y);
        });
    }

    /// Returns a row of an input image.
    fn line<'x>(&self, image: &'x [f32], row: usize) -> &'x [f32] {
        let length = self.input[1] * self.channels;
        &image[row * length..][..length]
    }
}

struct CubicStep(Lines<Cubic>);

impl Kernel for CubicStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let Self(lines) = self;
        let channels = lines.channels;
        lines.for_each(io, |row, image, y| {
            y.fill(0.0);
            for (place, down) in row.places.into_iter().zip(row.weights) {
                let line = lines.line(image, place);
                for (y, column) in y.chunks_exact_mut(channels).zip(&lines.columns) {
                    for (place, across) in column.places.into_iter().zip(column.weights) {
                        let weight = down * across;
                        let values = &line[place * channels..][..channels];
                        y.iter_mut().zip(values).for_each(|(y, value)| *y += weight * value);
                    }
                }
            }
        });
        Ok(())
    }
}

/// Two neighbours and the weight of the second.
pub(crate) type Point = ([usize; 2], f32);

struct ResizeStep {
    lines: Lines<Point>,
    is_linear: bool,
}

impl Kernel for ResizeStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let Self { lines, is_linear } = self;
        let channels = lines.channels;
        lines.for_each(io, |&([top, bottom], down), image, y| {
            let (above, below) = (lines.line(image, top), lines.line(image, bottom));
            for (y, &([left, right], across)) in y.chunks_exact_mut(channels).zip(&lines.columns) {
                let at = |line: &'_ [f32], column: usize| {
                    column * channels..column * channels + channels.min(line.len())
                };
                let a = &above[at(above, left)];
                if !is_linear {
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
