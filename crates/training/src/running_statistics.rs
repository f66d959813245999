//! Running statistics of batch normalisation: the vectors of a training network that are not trained.

use std::slice::Iter;

use burn::tensor::Tensor;

use crate::traversal::{AnyModule, Change, FloatParam};

/// Returns the statistics in the order of the layers. The network's last update must have been applied.
pub fn running_statistics(network: &dyn AnyModule) -> Vec<Vec<f32>> {
    let mut all = Vec::new();
    network.visit_each(&mut |param: &dyn FloatParam| {
        if is_statistic(param) {
            all.push(param.value().into_data().iter::<f32>().collect());
        }
    });
    all
}

/// Sets [`running_statistics`].
pub struct SetStatistics<'a>(pub Iter<'a, Vec<f32>>);

impl Change for SetStatistics<'_> {
    fn float(&mut self, param: &dyn FloatParam) -> Option<Tensor<1>> {
        let values = is_statistic(param).then(|| self.0.next())?;
        values.map(|values| param.tensor(values.clone()))
    }
}

fn is_statistic(param: &dyn FloatParam) -> bool {
    param.shape().len() == 1 && !param.is_trained()
}
