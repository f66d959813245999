//! Training of classifiers on labelled views.

use opendr_engine::{Progress, Random, Result};
use opendr_kernels::{Compute, Matrix, MatrixMut, Product, log_softmax};

use super::{ViewClassifier, ViewClassifierConfig, normalise};
use crate::best_view::BestViewEstimator;
use crate::view_network::{BATCH, LabelledViews, Trainee, ViewLoss, ViewSource, ViewTrainee, fit_views};

/// Training of networks over views.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewTraining {
    /// Sizes of the classifier; side and classes are those of the views.
    pub config: ViewClassifierConfig,
    /// Number of epochs.
    pub epochs: usize,
    /// Seed of initialisation and order.
    pub seed: u64,
}

impl ViewTraining {
    /// Number of epochs and seed.
    pub(crate) fn run(&self) -> (usize, u64) {
        (self.epochs, self.seed)
    }
}

/// Trains a classifier by cross-entropy over the classes. `observer` receives the number of the epoch and its mean loss.
///
/// # Errors
/// Returns `InvalidInput` for fewer views than a batch of 64 and where `progress` is stopped, `Internal` if the training diverges, errors
/// of the source.
pub fn fit_view_classifier(
    source: &mut dyn ViewSource,
    training: &ViewTraining,
    (compute, progress): (&Compute, &dyn Progress),
    observer: &mut dyn FnMut(usize, f32),
) -> Result<ViewClassifier> {
    let (mut trainee, config) = ViewClassifier::trainee(source.views(0, progress)?, training)?;
    let mut observer = |epoch, [loss]: [f32; 1]| observer(epoch, loss);
    fit_views(source, [&mut trainee], training.run(), (compute, progress), &mut observer)?;
    Ok(ViewClassifier::trained(trainee, config))
}

/// Trains a classifier and an estimator of the best view on the same views. `observer` receives the number of the epoch and the mean
/// loss of each.
///
/// # Errors
/// As [`fit_view_classifier`] and [`fit_best_view`](crate::fit_best_view).
pub fn fit_view_networks(
    source: &mut dyn ViewSource,
    training: &ViewTraining,
    (compute, progress): (&Compute, &dyn Progress),
    observer: &mut dyn FnMut(usize, [f32; 2]),
) -> Result<(ViewClassifier, BestViewEstimator)> {
    let views = source.views(0, progress)?;
    let (mut trainee, config) = ViewClassifier::trainee(views, training)?;
    let mut best = BestViewEstimator::trainee(views, training.seed)?;
    let trainees: [&mut dyn Trainee; 2] = [&mut trainee, &mut best];
    fit_views(source, trainees, training.run(), (compute, progress), observer)?;
    Ok((ViewClassifier::trained(trainee, config), BestViewEstimator::trained(best)))
}

impl ViewClassifier {
    fn trainee(
        views: &LabelledViews,
        training: &ViewTraining,
    ) -> Result<(ViewTrainee<ClassLoss>, ViewClassifierConfig)> {
        let config =
            ViewClassifierConfig { side: views.side, classes: views.classes, ..training.config.clone() };
        config.check()?;
        let (classes, dimension) = (config.classes, config.dimension);
        let loss = ClassLoss::new(classes, dimension);
        let mut random = Random::from_key([training.seed, 0xe3b]);
        let trainee = ViewTrainee::new(config.network_config(), loss, classes * dimension, &mut random)?;
        Ok((trainee, config))
    }

    fn trained(trainee: ViewTrainee<ClassLoss>, config: ViewClassifierConfig) -> Self {
        let network = trainee.into_network(|directions| {
            directions.chunks_exact_mut(config.dimension).for_each(|direction| {
                normalise(direction);
            });
        });
        Self { config, network }
    }
}

/// Cross-entropy over the classes, whose directions are its own parameters.
struct ClassLoss {
    dimension: usize,
    directions: Vec<f32>,
    lengths: Vec<f32>,
    logits: Vec<f32>,
    logs: Vec<f32>,
    probabilities: Vec<f32>,
    ddirections: Vec<f32>,
}

impl ClassLoss {
    fn new(classes: usize, dimension: usize) -> Self {
        let row = || vec![0.0; BATCH * classes];
        Self {
            dimension,
            directions: vec![0.0; classes * dimension],
            lengths: vec![0.0; classes],
            logits: row(),
            logs: row(),
            probabilities: row(),
            ddirections: vec![0.0; classes * dimension],
        }
    }

    fn normalise(&mut self, weights: &[f32]) {
        self.directions.copy_from_slice(weights);
        for (direction, length) in self.directions.chunks_exact_mut(self.dimension).zip(&mut self.lengths) {
            *length = normalise(direction);
        }
    }
}

impl ViewLoss for ClassLoss {
    fn run(
        &mut self,
        compute: &Compute,
        (embedded, weights): (&[f32], &[f32]),
        (views, rows): (&LabelledViews, &[usize]),
        (dembedded, dweights): (&mut [f32], &mut [f32]),
    ) -> f32 {
        self.normalise(weights);
        let (classes, dimension) = (self.lengths.len(), self.dimension);
        let directions = Matrix::new(&self.directions, classes, dimension);
        let embedded = Matrix::new(embedded, BATCH, dimension);
        Product::new().run(
            compute,
            embedded,
            directions.transposed(),
            MatrixMut::new(&mut self.logits, BATCH, classes),
        );
        log_softmax(compute.isa(), &self.logits, classes, &mut self.logs, &mut self.probabilities);
        let mut loss = 0.0;
        for (at, label) in rows.iter().map(|row| views.labels[*row]).enumerate() {
            loss -= self.logs[at * classes + label];
            self.probabilities[at * classes + label] -= 1.0;
        }
        self.probabilities.iter_mut().for_each(|gradient| *gradient /= BATCH as f32);
        let dlogits = Matrix::new(&self.probabilities, BATCH, classes);
        Product::new().run(compute, dlogits, directions, MatrixMut::new(dembedded, BATCH, dimension));
        let ddirections = MatrixMut::new(&mut self.ddirections, classes, dimension);
        Product::new().run(compute, dlogits.transposed(), embedded, ddirections);
        // The length of a direction is not trained: the gradient along it is removed.
        let pairs = self.ddirections.chunks_exact(dimension).zip(self.directions.chunks_exact(dimension));
        for ((dweight, (ddirection, direction)), length) in
            dweights.chunks_exact_mut(dimension).zip(pairs).zip(&self.lengths)
        {
            let along: f32 = ddirection.iter().zip(direction).map(|(a, b)| a * b).sum();
            for ((dweight, part), own) in dweight.iter_mut().zip(ddirection).zip(direction) {
                *dweight += (part - along * own) / length;
            }
        }
        loss / BATCH as f32
    }
}
