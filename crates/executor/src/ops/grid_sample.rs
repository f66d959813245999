//! Samples of images at positions that the network computes.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use super::inputs::required;
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

/// What lies outside the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outside {
    Zeros,
    Border,
    Reflection,
}

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let (x, grid) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    let (dims, grid_dims) = (planner.shape(x), planner.shape(grid));
    let (&[batch, channels, height, width], &[grids, rows, columns, 2]) = (&dims[..], &grid_dims[..]) else {
        return Err(node.refused(&format!("an input of {} dimensions", dims.len())));
    };
    let kinds = [planner.kind(x), planner.kind(grid)];
    if grids != batch || height * width == 0 || kinds != [Kind::F32; 2] {
        return Err(node.damaged("its input or grid"));
    }
    let is_nearest = match node.text("mode", "linear").as_str() {
        "linear" | "bilinear" => false,
        "nearest" => true,
        other => return Err(node.refused(&format!("mode {other:?}"))),
    };
    let outside = match node.text("padding_mode", "zeros").as_str() {
        "zeros" => Outside::Zeros,
        "border" => Outside::Border,
        "reflection" => Outside::Reflection,
        other => return Err(node.refused(&format!("padding mode {other:?}"))),
    };
    let shape = vec![batch, channels, rows, columns];
    count(&shape)?;
    let (x, grid) = (planner.channels_last(x)?, planner.plain(grid)?);
    let step = GridSampleStep {
        size: [width, height],
        channels,
        pixels: rows * columns,
        is_nearest,
        is_aligned: node.int_or("align_corners", 0) != 0,
        outside,
    };
    Ok(vec![planner.emit_one(step, &[x, grid], Kind::F32, shape, Layout::ChannelsLast)?])
}

struct GridSampleStep {
    /// Width and height of the input.
    size: [usize; 2],
    channels: usize,
    /// Samples per image.
    pixels: usize,
    is_nearest: bool,
    is_aligned: bool,
    outside: Outside,
}

impl Kernel for GridSampleStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, grid, y) = (io.read::<f32>(0), io.read::<f32>(1), io.write::<f32>());
        let [width, height] = self.size;
        let channels = self.channels.max(1);
        let per_piece = ((1 << 12) / channels).max(1);
        io.compute.pool().run_on_pieces(y, per_piece * channels, |piece, y| {
            for (i, y) in y.chunks_mut(channels).enumerate() {
                let index = piece * per_piece + i;
                let image =
                    &x[index / self.pixels * width * height * channels..][..width * height * channels];
                let at = |axis: usize| self.position(grid[2 * index + axis], self.size[axis]);
                let [px, py] = [at(0), at(1)];
                y.fill(0.0);
                let mut add = |ix: f32, iy: f32, weight: f32| {
                    let (Some(ix), Some(iy)) = (self.inside(ix, width), self.inside(iy, height)) else {
                        return;
                    };
                    let pixel = &image[(iy * width + ix) * channels..][..channels];
                    y.iter_mut().zip(pixel).for_each(|(y, x)| *y += weight * x);
                };
                if self.is_nearest {
                    add(px.round_ties_even(), py.round_ties_even(), 1.0);
                    continue;
                }
                let (left, top) = (px.floor(), py.floor());
                let (right_share, bottom_share) = (px - left, py - top);
                add(left, top, (1.0 - right_share) * (1.0 - bottom_share));
                add(left + 1.0, top, right_share * (1.0 - bottom_share));
                add(left, top + 1.0, (1.0 - right_share) * bottom_share);
                add(left + 1.0, top + 1.0, right_share * bottom_share);
            }
        });
        Ok(())
    }
}

impl GridSampleStep {
    /// Returns the position in pixels of a coordinate from -1 to 1.
    fn position(&self, at: f32, size: usize) -> f32 {
        let size = size as f32;
        let at =
            if self.is_aligned { (at + 1.0) / 2.0 * (size - 1.0) } else { ((at + 1.0) * size - 1.0) / 2.0 };
        match self.outside {
            Outside::Zeros => at,
            Outside::Border => at.clamp(0.0, size - 1.0),
            Outside::Reflection => {
                let [low, high] = if self.is_aligned { [0.0, size - 1.0] } else { [-0.5, size - 0.5] };
                reflected(at, low, high).clamp(0.0, size - 1.0)
            }
        }
    }

    /// Returns the index of a pixel; `None` outside the image.
    fn inside(&self, at: f32, size: usize) -> Option<usize> {
        match self.outside {
            Outside::Zeros => (at >= 0.0 && at < size as f32).then_some(at as usize),
            // The weight of a pixel beyond the border is 0; NaN becomes 0.
            Outside::Border | Outside::Reflection => Some((at.max(0.0) as usize).min(size - 1)),
        }
    }
}

/// Reflects a position at both ends until it lies between them.
fn reflected(at: f32, low: f32, high: f32) -> f32 {
    let span = high - low;
    if span <= 0.0 {
        return low;
    }
    let rest = (at - low).abs() % (2.0 * span);
    low + if rest > span { 2.0 * span - rest } else { rest }
}
