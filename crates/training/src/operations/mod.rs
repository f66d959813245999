//! Operations of layers on the kernels of `opendr-kernels`, for tensors on the CPU; on other devices they are Burn's.
//!
//! Images that they return lie with channels last; Burn's operations see a view of them in the usual order of dimensions. An operation
//! copies images that lie otherwise. Gradients are registered with Burn, so that networks mix both kinds of operations.

mod activate;
mod add;
mod batch_norm;
mod convolution;
mod gru;

use std::sync::OnceLock;

use burn::backend::autodiff::NodeId;
use burn::backend::autodiff::grads::Gradients;
use burn::backend::tensor::FloatTensor;
use burn::backend::{Autodiff, Flex};
use burn::tensor::{DType, Tensor, TensorData};
use opendr_kernels::Compute;

pub(crate) use activate::{RELU6, activate};
pub use activate::{relu, relu6};
pub use add::add_act;
pub use batch_norm::{batch_norm, batch_norm_act};
pub use convolution::{conv1d, conv2d};
pub(crate) use gru::gru;

/// A tensor on the CPU.
type Cpu = FloatTensor<Flex>;
/// The backend of tensors on the CPU with gradients.
type Trained = Autodiff<Flex>;
/// A tensor on the CPU with gradients.
type CpuTrained = FloatTensor<Trained>;

/// A tensor that the kernels compute with.
enum Own {
    /// With gradients.
    Trained(CpuTrained),
    /// Without.
    Plain(Cpu),
}

impl Own {
    /// Returns a tensor of 32-bit floats on the CPU; `None` for others.
    fn of<const D: usize>(tensor: &Tensor<D>) -> Option<Self> {
        if tensor.dtype() != DType::F32 {
            return None;
        }
        match tensor.clone().try_into_primitive::<Trained>() {
            Ok(tensor) => Some(Self::Trained(tensor)),
            Err(_) => tensor.clone().try_into_primitive::<Flex>().ok().map(Self::Plain),
        }
    }

    fn primitive(&self) -> &Cpu {
        match self {
            Self::Trained(tensor) => tensor.primitive(),
            Self::Plain(tensor) => tensor,
        }
    }
}

/// Returns the threads of all trainings of the process: `OPENDR_THREADS`, or as many as the machine has.
fn compute() -> &'static Compute {
    static COMPUTE: OnceLock<Compute> = OnceLock::new();
    COMPUTE.get_or_init(|| {
        let wish = std::env::var("OPENDR_THREADS").ok().and_then(|text| text.parse().ok()).unwrap_or(0);
        let threads = if wish > 0 {
            wish
        } else {
            std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get)
        };
        Compute::with_threads(threads)
    })
}

/// Axes of a tensor with channels last, of one whose channels come second.
fn channels_last_axes(rank: usize) -> Vec<usize> {
    [0].into_iter().chain(2..rank).chain([1]).collect()
}

/// Axes of a tensor whose channels come second, of one with channels last.
fn channels_second_axes(rank: usize) -> Vec<usize> {
    [0, rank - 1].into_iter().chain(1..rank - 1).collect()
}

/// Returns a tensor whose numbers lie with channels last, as they are ordered in memory.
fn channels_last(tensor: &Cpu) -> Cpu {
    tensor.permute(&channels_last_axes(tensor.layout().num_dims())).to_contiguous()
}

/// Returns [`channels_last`] in memory that is not shared where the tensor's is not.
fn channels_last_of(tensor: Cpu) -> Cpu {
    let permuted = tensor.permute(&channels_last_axes(tensor.layout().num_dims()));
    drop(tensor);
    contiguous(permuted)
}

/// Returns the tensor with its numbers in the order of its shape, and none beside these, to write.
fn contiguous(tensor: Cpu) -> Cpu {
    let is_whole = tensor.as_slice::<f32>().is_some_and(|all| all.len() == tensor.storage::<f32>().len());
    if is_whole { tensor } else { Cpu::from_data(tensor.into_data()) }
}

/// Returns a view of a tensor with channels last whose channels come second.
fn channels_second(tensor: &Cpu) -> Cpu {
    tensor.permute(&channels_second_axes(tensor.layout().num_dims()))
}

/// Returns the numbers of a tensor that is contiguous.
#[expect(clippy::expect_used, reason = "callers pass contiguous tensors of 32-bit floats")]
fn numbers(tensor: &Cpu) -> &[f32] {
    tensor.as_slice().expect("the tensor is contiguous")
}

/// Returns a tensor of numbers in the order of its shape.
fn tensor(numbers: Vec<f32>, shape: impl Into<Vec<usize>>) -> Cpu {
    Cpu::from_data(TensorData::new(numbers, shape.into()))
}

/// Returns a tensor whose channels come second, of numbers with channels last; `shape` is that of the result.
fn from_channels_last(numbers: Vec<f32>, shape: &[usize]) -> Cpu {
    let in_memory: Vec<usize> = channels_last_axes(shape.len()).into_iter().map(|axis| shape[axis]).collect();
    channels_second(&tensor(numbers, in_memory))
}

/// Registers the gradients of the parents of an operation that have any.
fn register(
    gradients: &mut Gradients,
    parents: impl IntoIterator<Item = Option<NodeId>>,
    all: impl IntoIterator<Item = Option<Cpu>>,
) {
    for (node, gradient) in parents.into_iter().zip(all) {
        if let (Some(node), Some(gradient)) = (node, gradient) {
            gradients.register::<Flex>(node, gradient);
        }
    }
}

/// Returns the sizes of a tensor.
fn shape(tensor: &Cpu) -> Vec<usize> {
    tensor.layout().shape().to_vec()
}
