//! Training of classifiers on labelled views.

use opendr_engine::{Error, Random, Result};
use opendr_kernels::{
    Adam, AdamOptions, Compute, Initialisation, Matrix, MatrixMut, Product, Tape, WeightDecay, log_softmax,
};

use super::{LabelledViews, ViewClassifier, ViewClassifierConfig, normalise, normalised_planes};

/// Training of a classifier.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewTraining {
    /// Sizes of the classifier.
    pub config: ViewClassifierConfig,
    /// Number of epochs.
    pub epochs: usize,
    /// Seed of initialisation and order.
    pub seed: u64,
}

const BATCH: usize = 64;
const RATE: f32 = 1e-3;

/// Trains by cross-entropy over the classes. `observer` receives the number of the epoch and its mean loss; it returns whether
/// to stop.
///
/// # Errors
/// Returns `InvalidInput` for fewer views than a batch of 64, `Internal` if the training diverges.
pub fn fit_view_classifier(
    views: &LabelledViews,
    training: &ViewTraining,
    compute: &Compute,
    observer: &mut dyn FnMut(usize, f32) -> bool,
) -> Result<ViewClassifier> {
    let config = ViewClassifierConfig { side: views.side, classes: views.classes, ..training.config.clone() };
    if views.len() < BATCH {
        return Err(Error::invalid_input(format!(
            "{} views to train on; give at least {BATCH}",
            views.len()
        )));
    }
    let mut random = Random::from_key([training.seed, 0xe3b]);
    let network = config.network()?;
    let (classes, dimension) = (config.classes, config.dimension);
    let split = network.parameters();
    let mut parameters = vec![0.0; split + classes * dimension];
    let begin = Initialisation::Orthogonal { hidden: std::f32::consts::SQRT_2, output: 1.0 };
    network.initialise(begin, &mut random, &mut parameters[..split]);
    parameters[split..].iter_mut().for_each(|weight| *weight = random.normal() as f32);
    let options = AdamOptions { weight_decay: WeightDecay::Decoupled(1e-3), ..AdamOptions::default() };
    let mut adam = Adam::new(parameters.len(), options);
    let mut gradients = vec![0.0; parameters.len()];
    let mut pass = Pass::new(classes, dimension);
    let size = network.inputs();
    let (mut tape, mut input) = (Tape::default(), vec![0.0; BATCH * size]);
    let mut order: Vec<usize> = (0..views.len()).collect();
    let batches = views.len() / BATCH;
    for epoch in 0..training.epochs {
        random.shuffle(&mut order);
        let mut sum = 0.0;
        for (batch, rows) in order.chunks_exact(BATCH).enumerate() {
            for (to, row) in input.chunks_exact_mut(size).zip(rows) {
                normalised_planes(views.view(*row), to);
            }
            gradients.fill(0.0);
            let (weights, directions) = parameters.split_at(split);
            let embedded = network.forward(compute, weights, &input, &mut tape);
            let labels = rows.iter().map(|row| views.labels[*row]);
            let (dnetwork, ddirections) = gradients.split_at_mut(split);
            sum += pass.run(compute, (embedded, directions), labels, ddirections);
            network.backward(compute, weights, &pass.dembedded, &mut tape, Some(dnetwork), false);
            let done = (epoch * batches + batch) as f32 / (training.epochs * batches) as f32;
            adam.step(compute, RATE * (1.0 - done), &mut parameters, &gradients);
        }
        let loss = sum / batches as f32;
        if !loss.is_finite() {
            return Err(Error::internal(format!(
                "the loss of epoch {epoch} is {loss}: the training diverged"
            )));
        }
        if observer(epoch, loss) {
            break;
        }
    }
    parameters[split..].chunks_exact_mut(dimension).for_each(|direction| {
        normalise(direction);
    });
    Ok(ViewClassifier::new(config, network, parameters))
}

/// The loss with its gradients.
struct Pass {
    dimension: usize,
    directions: Vec<f32>,
    lengths: Vec<f32>,
    logits: Vec<f32>,
    logs: Vec<f32>,
    probabilities: Vec<f32>,
    dembedded: Vec<f32>,
    ddirections: Vec<f32>,
}

impl Pass {
    fn new(classes: usize, dimension: usize) -> Self {
        let row = || vec![0.0; BATCH * classes];
        Self {
            dimension,
            directions: vec![0.0; classes * dimension],
            lengths: vec![0.0; classes],
            logits: row(),
            logs: row(),
            probabilities: row(),
            dembedded: vec![0.0; BATCH * dimension],
            ddirections: vec![0.0; classes * dimension],
        }
    }

    fn normalise(&mut self, weights: &[f32]) {
        self.directions.copy_from_slice(weights);
        for (direction, length) in self.directions.chunks_exact_mut(self.dimension).zip(&mut self.lengths) {
            *length = normalise(direction);
        }
    }

    /// The mean loss; writes the gradient of the embeddings, and adds that of the weights.
    fn run(
        &mut self,
        compute: &Compute,
        (embedded, weights): (&[f32], &[f32]),
        labels: impl Iterator<Item = usize>,
        dweights: &mut [f32],
    ) -> f32 {
        self.normalise(weights);
        let (classes, dimension) = (self.lengths.len(), self.dimension);
        let directions = Matrix::new(&self.directions, classes, dimension);
        let rows = Matrix::new(embedded, BATCH, dimension);
        Product::new().run(
            compute,
            rows,
            directions.transposed(),
            MatrixMut::new(&mut self.logits, BATCH, classes),
        );
        log_softmax(compute.isa(), &self.logits, classes, &mut self.logs, &mut self.probabilities);
        let mut loss = 0.0;
        for (row, label) in labels.enumerate() {
            loss -= self.logs[row * classes + label];
            self.probabilities[row * classes + label] -= 1.0;
        }
        self.probabilities.iter_mut().for_each(|gradient| *gradient /= BATCH as f32);
        let dlogits = Matrix::new(&self.probabilities, BATCH, classes);
        Product::new().run(
            compute,
            dlogits,
            directions,
            MatrixMut::new(&mut self.dembedded, BATCH, dimension),
        );
        let ddirections = MatrixMut::new(&mut self.ddirections, classes, dimension);
        Product::new().run(compute, dlogits.transposed(), rows, ddirections);
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
