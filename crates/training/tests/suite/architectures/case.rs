//! A network, exported twice, with Burn's outputs.

use burn::module::{Module, ModuleMapper, Param};
use burn::tensor::{Device, Distribution, Tensor};
use burn_store::{ModuleSnapshot, SafetensorsStore};
use opendr_engine::Result;
use opendr_training::export::{self, Input, Outputs};

/// Shape and values of a tensor.
#[derive(Debug, Clone)]
pub struct Values {
    pub shape: Vec<usize>,
    pub values: Vec<f32>,
}

/// A model, an input and Burn's outputs.
pub struct Run {
    pub model: Result<Vec<u8>>,
    pub input: Values,
    pub outputs: Vec<Values>,
}

/// One architecture.
pub struct Case {
    pub name: &'static str,
    /// Exported for a batch of two.
    pub fixed: Run,
    /// Exported with an open batch, run with a batch of three.
    pub open: Run,
    /// Parameters and statistics, as a safetensors file.
    pub parameters: Vec<u8>,
}

/// Tensors, or tuples, arrays and vectors of them.
pub trait OutputValues: Outputs {
    fn values(self, to: &mut Vec<Values>);
}

impl<const D: usize> OutputValues for Tensor<D> {
    fn values(self, to: &mut Vec<Values>) {
        to.push(values(self));
    }
}

impl<A: OutputValues> OutputValues for Vec<A> {
    fn values(self, to: &mut Vec<Values>) {
        self.into_iter().for_each(|answer| answer.values(to));
    }
}

impl<A: OutputValues, const N: usize> OutputValues for [A; N] {
    fn values(self, to: &mut Vec<Values>) {
        self.into_iter().for_each(|answer| answer.values(to));
    }
}

macro_rules! impl_answers {
    ($($name:ident),+) => {
        #[allow(non_snake_case)]
        impl<$($name: OutputValues),+> OutputValues for ($($name,)+) {
            fn values(self, to: &mut Vec<Values>) {
                let ($($name,)+) = self;
                $($name.values(to);)+
            }
        }
    };
}

impl_answers!(A, B);
impl_answers!(A, B, C);
impl_answers!(A, B, C, D);
impl_answers!(A, B, C, D, E);
impl_answers!(A, B, C, D, E, F);

pub fn values<const D: usize>(tensor: Tensor<D>) -> Values {
    Values { shape: tensor.dims().to_vec(), values: tensor.into_data().try_to_vec_as().unwrap() }
}

/// Perturbs parameters that are initialised to ones or zeros (scales, shifts, biases).
struct Scatter;

impl ModuleMapper for Scatter {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        match D {
            1 => param.map(|tensor| {
                let noise =
                    Tensor::random(tensor.shape(), Distribution::Uniform(-0.3, 0.3), &tensor.device());
                (tensor + noise).detach().require_grad()
            }),
            _ => param,
        }
    }
}

/// Creates a network with random weights and statistics, exports it twice and runs it.
pub fn case<const D: usize, M: Module, A: OutputValues>(
    name: &'static str,
    shape: [usize; D],
    outputs: &[&str],
    make: impl Fn(&Device) -> M,
    forward: impl Fn(&M, Tensor<D>) -> A,
) -> Case {
    let device = Device::flex();
    device.seed(7);
    let training = device.clone().autodiff();
    let network = make(&training).map(&mut Scatter);
    let random = |batch, device: &Device| {
        let mut shape = shape;
        shape[0] = batch;
        Tensor::<D>::random(shape, Distribution::Normal(0.2, 1.0), device)
    };
    // Collect the statistics of batch normalisations.
    for _ in 0..3 {
        forward(&network, random(4, &training));
    }
    let plain = network.valid();
    let run = |batch, open: bool| {
        let mut shape = shape;
        shape[0] = batch;
        let input = Input::new("input", shape);
        let input = if open { input.open(0) } else { input };
        let model = export::onnx(&network, input, outputs, &forward);
        let input = random(batch, &device);
        let mut burn_outputs = Vec::new();
        forward(&plain, input.clone()).values(&mut burn_outputs);
        Run { model, input: values(input), outputs: burn_outputs }
    };
    let mut store = SafetensorsStore::from_bytes(None);
    plain.save_into(&mut store).unwrap();
    Case { name, fixed: run(2, false), open: run(3, true), parameters: store.get_bytes().unwrap() }
}
