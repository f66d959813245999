//! Training of the estimator of the best view.

use opendr_engine::{Error, Progress, Random, Result};
use opendr_kernels::Compute;

use super::estimator::{BestViewEstimate, BestViewEstimator, COMPONENTS, NUMBERS, length};
use crate::fusion::log_sum;
use crate::view_network::{LabelledViews, ViewLoss, ViewNetworkConfig, ViewSource, ViewTrainee, fit_views};

/// Kernels of the convolutions, and neurons of the hidden layer.
const KERNELS: [usize; 3] = [16, 32, 48];
const HIDDEN: usize = 128;

/// Negative log-likelihood of the true direction.
pub(crate) struct BestViewLoss;

impl ViewLoss for BestViewLoss {
    fn run(
        &mut self,
        _: &Compute,
        (outputs, _): (&[f32], &[f32]),
        (views, rows): (&LabelledViews, &[usize]),
        (doutputs, _): (&mut [f32], &mut [f32]),
    ) -> f32 {
        const OUTPUTS: usize = NUMBERS * COMPONENTS;
        let (all, dall) = (outputs.as_chunks::<OUTPUTS>().0, doutputs.as_chunks_mut::<OUTPUTS>().0);
        let count = rows.len() as f32;
        let mut sum = 0.0;
        for ((outputs, doutputs), row) in all.iter().zip(dall).zip(rows) {
            let best = views.best[*row];
            let logs = BestViewEstimate::of(outputs).logs(best);
            let log = log_sum(logs.into_iter());
            sum -= log;
            let weights = log_sum(outputs.as_chunks::<NUMBERS>().0.iter().map(|[.., weight]| *weight));
            for (([x, y, z, weight], to), own) in
                outputs.as_chunks::<NUMBERS>().0.iter().zip(doutputs.as_chunks_mut::<NUMBERS>().0).zip(logs)
            {
                // The share of this component in the likelihood.
                let share = (own - log).exp();
                let kappa = length([*x, *y, *z]);
                let mean = share * mean_length(kappa) / kappa.max(1e-6);
                for ((to, eta), best) in to.iter_mut().zip([x, y, z]).zip(best) {
                    *to = (mean * eta - share * best) / count;
                }
                to[3] = ((weight - weights).exp() - share) / count;
            }
        }
        sum / count
    }
}

/// Length of the mean of directions with concentration `kappa`, 0 to 1: `coth(kappa) - 1 / kappa`.
fn mean_length(kappa: f32) -> f32 {
    if kappa < 1e-2 { kappa / 3.0 } else { 1.0 / kappa.tanh() - 1.0 / kappa }
}

impl BestViewEstimator {
    /// Creates an estimator for views, with random parameters.
    ///
    /// # Errors
    /// `InvalidInput` for views without the direction to the best one.
    pub(crate) fn trainee(views: &LabelledViews, seed: u64) -> Result<ViewTrainee<BestViewLoss>> {
        if !views.has_best() {
            return Err(Error::invalid_input(
                "views without the direction to the best one; use an environment that reports best_azimuth and best_elevation",
            ));
        }
        let outputs = NUMBERS * COMPONENTS;
        let config =
            ViewNetworkConfig { side: views.side, kernels: KERNELS.to_vec(), hidden: HIDDEN, outputs };
        ViewTrainee::new(config, BestViewLoss, 0, &mut Random::from_key([seed, 0xbe57]))
    }

    pub(crate) fn trained(trainee: ViewTrainee<BestViewLoss>) -> Self {
        Self::new(trainee.into_network(|_| {}))
    }
}

/// Trains by maximum likelihood for a number of epochs, from a seed. `observer` receives the number of the epoch and its mean loss.
///
/// # Errors
/// Returns `InvalidInput` for views without the direction to the best one, for fewer than a batch of 64, and where `progress` is
/// stopped, `Internal` if the training diverges.
pub fn fit_best_view(
    source: &mut dyn ViewSource,
    (epochs, seed): (usize, u64),
    (compute, progress): (&Compute, &dyn Progress),
    observer: &mut dyn FnMut(usize, f32),
) -> Result<BestViewEstimator> {
    let mut trainee = BestViewEstimator::trainee(source.views(0, progress)?, seed)?;
    let mut observer = |epoch, [loss]: [f32; 1]| observer(epoch, loss);
    fit_views(source, [&mut trainee], (epochs, seed), (compute, progress), &mut observer)?;
    Ok(BestViewEstimator::trained(trainee))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_equal_finite_differences() {
        let (mut random, count) = (Random::new(3), 5);
        let outputs: Vec<f32> = (0..12 * count).map(|_| 2.0 * random.normal() as f32).collect();
        let direction = |random: &mut Random| {
            let vector = std::array::from_fn(|_| random.normal() as f32);
            let length = length(vector);
            vector.map(|part| part / length)
        };
        let best = (0..count).map(|_| direction(&mut random)).collect();
        let views = LabelledViews { best, ..LabelledViews::default() };
        let rows: Vec<usize> = (0..count).collect();
        let mut gradients = vec![0.0; outputs.len()];
        let loss = |outputs: &[f32], gradients: &mut [f32]| {
            let compute = Compute::single();
            f64::from(BestViewLoss.run(&compute, (outputs, &[]), (&views, &rows), (gradients, &mut [])))
        };
        loss(&outputs, &mut gradients);
        for at in 0..outputs.len() {
            let moved = |by: f32| {
                let mut outputs = outputs.clone();
                outputs[at] += by;
                loss(&outputs, &mut vec![0.0; outputs.len()])
            };
            let difference = (moved(0.01) - moved(-0.01)) / 0.02;
            assert!(
                (difference - f64::from(gradients[at])).abs() < 2e-3,
                "{at}: {difference} {}",
                gradients[at]
            );
        }
    }
}
