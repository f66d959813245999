//! Steps, computed constants and layouts of values.

use std::sync::Arc;

use opendr_engine::{Error, Result};
use opendr_kernels::{ALIGNMENT, Arena, Region};

use crate::constant::Constant;
use crate::io::{Io, Kernel, Place};
use crate::planner::{Planner, Step};
use crate::remap;
use crate::tensor::{Kind, count};
use crate::value::{Id, Layout, Source};

/// Bytes of a constant that planning may compute, and of all of them.
const MAX_CONSTANT: usize = 1 << 28;
const MAX_CONSTANTS: usize = 1 << 31;

impl Planner<'_> {
    /// Adds a step, or computes it where it depends on constants only. Outputs are given by type, shape and layout.
    pub(crate) fn emit(
        &mut self,
        kernel: impl Kernel + 'static,
        reads: &[Option<Id>],
        outputs: &[(Kind, Vec<usize>, Layout)],
    ) -> Result<Vec<Id>> {
        let sizes = outputs
            .iter()
            .map(|(kind, shape, _)| Ok(count(shape)? * kind.bytes()))
            .collect::<Result<Vec<usize>>>()?;
        let offsets: Vec<usize> = sizes
            .iter()
            .scan(0, |offset, size| {
                let at = *offset;
                *offset += size.next_multiple_of(ALIGNMENT);
                Some(at)
            })
            .collect();
        let bytes = sizes.iter().map(|size| size.next_multiple_of(ALIGNMENT)).sum();
        let known = reads.iter().flatten().all(|&id| matches!(self.values[id].source, Source::Constant(_)));
        if known && outputs.len() == 1 {
            return self.evaluate(&kernel, reads, &outputs[0], &sizes);
        }
        let buffer = self.buffers.len();
        self.buffers.push(bytes);
        self.steps.push(Step {
            kernel: Box::new(kernel),
            reads: reads.to_vec(),
            buffer,
            written: sizes.iter().sum(),
            sizes,
            node: self.branching.unwrap_or(self.node),
        });
        let mut ids = Vec::new();
        for ((kind, shape, layout), offset) in outputs.iter().zip(offsets) {
            ids.push(self.add(*kind, shape.clone(), *layout, Source::Buffer(buffer, offset)));
        }
        Ok(ids)
    }

    fn evaluate(
        &mut self,
        kernel: &dyn Kernel,
        reads: &[Option<Id>],
        (kind, shape, layout): &(Kind, Vec<usize>, Layout),
        sizes: &[usize],
    ) -> Result<Vec<Id>> {
        let bytes = sizes[0];
        self.computed = self.computed.saturating_add(bytes);
        if bytes > MAX_CONSTANT || self.computed > MAX_CONSTANTS {
            return Err(Error::unsupported(format!("the ONNX model computes a constant of {bytes} bytes")));
        }
        let mut varies = self.varying.get();
        let reads: Vec<Place> = reads
            .iter()
            .map(|id| match id.map(|id| &self.values[id].source) {
                Some(Source::Constant(constant)) => {
                    varies |= constant.varies;
                    Place::Constant(Arc::clone(constant))
                }
                _ => Place::Absent,
            })
            .collect();
        let mut data = Arena::new(bytes);
        let (written, rest) = data.split(Region { start: 0, bytes });
        kernel.run(&mut Io {
            reads: &reads,
            inputs: &[],
            rest,
            written: Some(written),
            sizes,
            compute: self.compute,
        })?;
        let constant = Arc::new(Constant { kind: *kind, shape: shape.clone(), data, varies });
        let id = self.add(*kind, shape.clone(), *layout, Source::Constant(constant));
        Ok(vec![id])
    }

    /// Adds a step with one output.
    pub(crate) fn emit_one(
        &mut self,
        kernel: impl Kernel + 'static,
        reads: &[Id],
        kind: Kind,
        shape: Vec<usize>,
        layout: Layout,
    ) -> Result<Id> {
        let reads: Vec<Option<Id>> = reads.iter().copied().map(Some).collect();
        let ids = self.emit(kernel, &reads, &[(kind, shape, layout)])?;
        ids.first().copied().ok_or_else(|| Error::internal("a step without an output"))
    }

    /// Adds images of floats with channels last, of which these steps write parts.
    pub(crate) fn add_joined(&mut self, steps: &[usize], shape: &[usize]) -> Result<Id> {
        let bytes = count(shape)? * Kind::F32.bytes();
        let buffer = self.buffers.len();
        self.buffers.push(bytes.next_multiple_of(ALIGNMENT));
        for &step in steps {
            let step = &mut self.steps[step];
            (step.buffer, step.sizes) = (buffer, vec![bytes]);
        }
        Ok(self.add(Kind::F32, shape.to_vec(), Layout::ChannelsLast, Source::Buffer(buffer, 0)))
    }

    /// Adds a step that writes a part of a value.
    pub(crate) fn emit_part(&mut self, kernel: impl Kernel + 'static, reads: &[Id], whole: Id) {
        let Source::Buffer(buffer, _) = self.values[whole].source else { return };
        let bytes = |id: Id| self.values[id].shape.iter().product::<usize>() * self.values[id].kind.bytes();
        self.steps.push(Step {
            kernel: Box::new(kernel),
            reads: reads.iter().copied().map(Some).collect(),
            buffer,
            written: reads.iter().map(|&id| bytes(id)).sum(),
            sizes: vec![bytes(whole)],
            node: self.branching.unwrap_or(self.node),
        });
    }

    /// Returns the same elements, in the same order of memory, with another shape.
    pub(crate) fn alias(&mut self, id: Id, shape: Vec<usize>, layout: Layout) -> Id {
        let value = self.values[id].clone();
        let source = match value.source {
            Source::Constant(constant) if layout == Layout::Plain => {
                let (kind, varies) = (constant.kind, constant.varies);
                let data = copy(&constant);
                Source::Constant(Arc::new(Constant { kind, shape: shape.clone(), data, varies }))
            }
            other => other,
        };
        self.add(value.kind, shape, layout, source)
    }

    /// Returns the same elements, in the order of the shape, with another shape.
    ///
    /// Where they lie with channels last, a copy in the order of the shape is planned, but only made for what reads it: operators on
    /// the other shape that the images allow as they lie read these, see [`Planner::images`].
    pub(crate) fn reshaped(&mut self, id: Id, shape: Vec<usize>) -> Result<Id> {
        let images = if self.is_channels_last(id) { Some(id) } else { self.values[id].reshaped };
        if let Some(images) = images.filter(|&images| self.values[images].shape == shape) {
            return Ok(images);
        }
        let dims = &self.values[id].shape;
        let keeps_channels = dims.len() > 2 && shape.len() > 2 && dims[..2] == shape[..2];
        if keeps_channels && self.is_channels_last(id) && !self.is_constant(id) {
            return Ok(self.alias(id, shape, Layout::ChannelsLast));
        }
        let plain = self.plain(id)?;
        let reshaped = self.alias(plain, shape, Layout::Plain);
        self.values[reshaped].reshaped = images;
        Ok(reshaped)
    }

    /// Returns the value with channels last of which a value is a reshape with one image for each index of dimension `along`, and
    /// dimensions of 1 before it.
    pub(crate) fn images(&self, id: Id, along: usize) -> Option<Id> {
        let value = &self.values[id];
        let images = value.reshaped?;
        let count = *self.values[images].shape.first()?;
        let (before, rest) = value.shape.split_at_checked(along)?;
        (rest.first() == Some(&count) && before.iter().all(|&dim| dim == 1)).then_some(images)
    }

    /// Returns a part of a value that a step writes, from a byte on; `None` for other values, and where the part is not aligned.
    pub(crate) fn view(&mut self, id: Id, bytes: usize, shape: Vec<usize>, layout: Layout) -> Option<Id> {
        let value = self.values[id].clone();
        let Source::Buffer(buffer, offset) = value.source else { return None };
        let start = offset + bytes;
        start
            .is_multiple_of(ALIGNMENT)
            .then(|| self.add(value.kind, shape, layout, Source::Buffer(buffer, start)))
    }

    /// Returns the value in the order of its shape.
    pub(crate) fn plain(&mut self, id: Id) -> Result<Id> {
        self.relaid(id, Layout::Plain)
    }

    /// Returns the value with channels last; only of rank 3 or more.
    pub(crate) fn channels_last(&mut self, id: Id) -> Result<Id> {
        self.relaid(id, Layout::ChannelsLast)
    }

    fn relaid(&mut self, id: Id, layout: Layout) -> Result<Id> {
        let value = self.values[id].clone();
        if value.layout == layout {
            return Ok(id);
        }
        if let Some(other) = value.other {
            return Ok(other);
        }
        let rank = value.shape.len();
        let pixels: usize = value.shape.iter().skip(2).product();
        let same = rank < 3 || value.shape[1] == 1 || pixels == 1;
        let other = if same {
            self.alias(id, value.shape.clone(), layout)
        } else {
            // Dimensions of the result in the order of memory, by those of the source.
            let mut order: Vec<usize> = (0..rank).collect();
            match layout {
                Layout::ChannelsLast => order[1..].rotate_left(1),
                Layout::Plain => order[1..].rotate_right(1),
            }
            let remap = remap::transposed(&value.physical(), &order, value.kind.bytes());
            self.emit_one(remap, &[id], value.kind, value.shape.clone(), layout)?
        };
        self.values[id].other = Some(other);
        self.values[other].other = Some(id);
        Ok(other)
    }
}

fn copy(constant: &Constant) -> Arena {
    Arena::from_numbers(constant.data.get::<u8>(constant.region()))
}
