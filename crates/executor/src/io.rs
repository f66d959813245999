//! What a step reads and writes in a run.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::{Arena, Compute, DepthwiseConvolution, LayerCost, Number, Region, Rest, Written};

use crate::constant::Constant;
use crate::tensor::{Data, Tensor};

/// Where a tensor lies.
#[derive(Debug, Clone)]
pub(crate) enum Place {
    /// An optional input that is not there.
    Absent,
    Constant(Arc<Constant>),
    Input(usize),
    Arena(Region),
}

impl Place {
    /// Returns the bytes of the tensor.
    pub(crate) fn bytes(&self, inputs: &[Tensor<'_>]) -> usize {
        match self {
            Self::Absent => 0,
            Self::Constant(constant) => constant.bytes(),
            Self::Input(index) => {
                inputs.get(*index).map_or(0, |input| input.data.len() * input.data.kind().bytes())
            }
            Self::Arena(region) => region.bytes,
        }
    }
}

/// The tensors of a step.
pub(crate) struct Io<'a> {
    pub(crate) reads: &'a [Place],
    pub(crate) inputs: &'a [Tensor<'a>],
    pub(crate) rest: Rest<'a>,
    pub(crate) written: Option<Written<'a>>,
    /// Bytes of each output.
    pub(crate) sizes: &'a [usize],
    pub(crate) compute: &'a Compute,
}

impl<'a> Io<'a> {
    /// Returns whether an optional input is there.
    pub(crate) fn has(&self, slot: usize) -> bool {
        !matches!(self.reads.get(slot), None | Some(Place::Absent))
    }

    /// Returns an input whose element type the plan has checked.
    pub(crate) fn read<T: Number>(&self, slot: usize) -> &'a [T] {
        match self.reads.get(slot) {
            None | Some(Place::Absent) => &[],
            Some(Place::Constant(constant)) => constant.data.get(constant.region()),
            Some(Place::Arena(region)) => self.rest.get(*region),
            Some(Place::Input(index)) => self.inputs.get(*index).map_or(&[], |input| numbers(input.data)),
        }
    }

    /// Returns the only output.
    pub(crate) fn write<T: Number>(&mut self) -> &'a mut [T] {
        let bytes = self.sizes.first().copied().unwrap_or(0) / size_of::<T>();
        let all = self.written.take().map_or(&mut [][..], Written::numbers);
        let length = bytes.min(all.len());
        &mut all[..length]
    }

    /// Returns two outputs.
    pub(crate) fn write_two<T: Number, U: Number>(&mut self) -> (&'a mut [T], &'a mut [U]) {
        let [first, second, ..] = self.sizes else { return (&mut [], &mut []) };
        let Some((a, b)) = self.written.take().map(|written| written.split(*first)) else {
            return (&mut [], &mut []);
        };
        let (a, b) = (a.numbers::<T>(), b.numbers::<U>());
        let (a_length, b_length) = (first / size_of::<T>(), second / size_of::<U>());
        (&mut a[..a_length], &mut b[..b_length])
    }
}

/// Borrows the elements of an input as another type of the same size; the plan has checked the types.
fn numbers<'a, T: Number>(data: Data<'a>) -> &'a [T] {
    match data {
        Data::F32(data) => Arena::view(data),
        Data::I64(data) => Arena::view(data),
        Data::I32(data) => Arena::view(data),
        Data::U8(data) | Data::Bool(data) => Arena::view(data),
        Data::I8(data) => Arena::view(data),
    }
}

/// What computes a step; the plan has checked shapes and types.
pub(crate) trait Kernel: Send + Sync {
    fn run(&self, io: &mut Io<'_>) -> Result<()>;

    /// Returns the arithmetic of products, and the bytes of weights that are not among the inputs.
    fn cost(&self) -> LayerCost {
        LayerCost::default()
    }

    /// Makes the kernel write its output to the channels from `first` on of images with `channels` channels, which lie last. Returns
    /// whether it can.
    fn widen(&mut self, _channels: usize, _first: usize) -> bool {
        false
    }

    /// Returns the depthwise convolution that the kernel computes, if it does.
    fn depthwise(&self) -> Option<&DepthwiseConvolution> {
        None
    }
}
