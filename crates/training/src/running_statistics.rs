//! Running statistics of batch normalisation.

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param};
use burn::tensor::{Tensor, TensorData};

/// Returns the vectors of a training network that are not trained, in the order of its layers: running statistics of batch normalisation.
pub fn running_statistics<M: Module>(network: &M) -> Vec<Vec<f32>> {
    // Burn applies the last update of running statistics when the network is converted.
    drop(network.valid());
    let mut read = Read(Vec::new());
    network.visit(&mut read);
    read.0
}

/// Returns the network with the given [`running_statistics`].
pub fn with_running_statistics<M: Module>(network: M, statistics: &[Vec<f32>]) -> M {
    network.map(&mut Write(statistics.iter()))
}

fn is_statistic<const D: usize>(tensor: &Tensor<D>) -> bool {
    D == 1 && !tensor.is_require_grad()
}

struct Read(Vec<Vec<f32>>);

impl ModuleVisitor for Read {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        let tensor = param.val();
        if is_statistic(&tensor) {
            self.0.push(tensor.into_data().iter::<f32>().collect());
        }
    }
}

struct Write<'a>(std::slice::Iter<'a, Vec<f32>>);

impl ModuleMapper for Write<'_> {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        if !is_statistic(&param.val()) {
            return param;
        }
        let Some(values) = self.0.next() else { return param };
        param.map(|old| {
            let data = TensorData::new(values.clone(), old.dims());
            Tensor::from_data(data, &old.device())
        })
    }
}
