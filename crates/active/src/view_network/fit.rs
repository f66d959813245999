//! Training of networks on labelled views.

use opendr_engine::environment::EnvironmentSource;
use opendr_engine::{Error, Progress, Random, Result};
use opendr_kernels::{Adam, AdamOptions, Compute, Initialisation, Network, Tape, WeightDecay};

use super::{LabelledViews, ViewNetwork, ViewNetworkConfig, normalised_planes};
use crate::environment_rig::EnvironmentRig;
use crate::parameter_bytes;

/// Number of views of a step.
pub(crate) const BATCH: usize = 64;
const RATE: f32 = 1e-3;

/// Provides the views of each epoch.
pub trait ViewSource {
    /// Returns the views of an epoch, at least 64 unless `progress` is stopped.
    ///
    /// # Errors
    /// Returns errors of what provides them.
    fn views(&mut self, epoch: usize, progress: &dyn Progress) -> Result<&LabelledViews>;
}

/// The same views in each epoch.
impl ViewSource for LabelledViews {
    fn views(&mut self, _: usize, _: &dyn Progress) -> Result<&LabelledViews> {
        Ok(self)
    }
}

/// Views of environments, others in every second epoch.
pub struct FreshViews {
    rigs: Vec<EnvironmentRig>,
    first: u64,
    episodes: u64,
    /// Number of the pair of epochs and its views.
    collected: Option<(usize, LabelledViews)>,
}

/// Seeds of the episodes that provide views begin at multiples of this number.
const VIEW_SEEDS: u64 = 1 << 40;

impl FreshViews {
    /// Creates a source of the views of `episodes` episodes at a time in `workers` environments. Sources of different seeds have no
    /// episode in common, and none with calibrations and evaluations.
    ///
    /// # Errors
    /// Returns errors of the environments, and `InvalidInput` for environments of other spaces.
    pub fn of(source: &dyn EnvironmentSource, workers: u32, seed: u64, episodes: u64) -> Result<Self> {
        let rigs = (0..workers).map(|_| EnvironmentRig::new(source.make()?));
        Ok(Self::new(rigs.collect::<Result<_>>()?, VIEW_SEEDS * (1 + seed), episodes))
    }

    /// Creates a source of the views of `episodes` episodes at a time, one thread per environment. Seeds start at `first`.
    pub fn new(rigs: Vec<EnvironmentRig>, first: u64, episodes: u64) -> Self {
        Self { rigs, first, episodes, collected: None }
    }
}

impl ViewSource for FreshViews {
    fn views(&mut self, epoch: usize, progress: &dyn Progress) -> Result<&LabelledViews> {
        let Self { rigs, first, episodes, collected } = self;
        let pair = epoch / 2;
        let views = match collected.take() {
            Some((of, views)) if of == pair => views,
            _ => LabelledViews::collect(rigs, *first + pair as u64 * *episodes, *episodes, progress)?,
        };
        Ok(&collected.insert((pair, views)).1)
    }
}

/// A loss over the outputs of a network.
pub(crate) trait ViewLoss {
    /// Returns the mean loss of a batch: of the network's outputs and the loss's own parameters, for rows of the views. Writes the
    /// gradient of the outputs, and adds that of the parameters.
    fn run(
        &mut self,
        compute: &Compute,
        outputs: (&[f32], &[f32]),
        batch: (&LabelledViews, &[usize]),
        gradients: (&mut [f32], &mut [f32]),
    ) -> f32;
}

/// A network in training.
pub(crate) struct ViewTrainee<L> {
    config: ViewNetworkConfig,
    network: Network,
    parameters: Vec<f32>,
    gradients: Vec<f32>,
    doutputs: Vec<f32>,
    adam: Adam,
    tape: Tape,
    loss: L,
}

impl<L: ViewLoss> ViewTrainee<L> {
    /// Creates a network with `own` parameters of the loss, drawn from a normal distribution.
    pub(crate) fn new(config: ViewNetworkConfig, loss: L, own: usize, random: &mut Random) -> Result<Self> {
        let network = config.network()?;
        let split = network.parameters();
        let mut parameters = vec![0.0; split + own];
        let begin = Initialisation::Orthogonal { hidden: std::f32::consts::SQRT_2, output: 1.0 };
        network.initialise(begin, random, &mut parameters[..split]);
        parameters[split..].iter_mut().for_each(|weight| *weight = random.normal() as f32);
        let options = AdamOptions { weight_decay: WeightDecay::Decoupled(1e-3), ..AdamOptions::default() };
        Ok(Self {
            adam: Adam::new(parameters.len(), options),
            gradients: vec![0.0; parameters.len()],
            doutputs: vec![0.0; BATCH * config.outputs],
            tape: Tape::default(),
            config,
            network,
            parameters,
            loss,
        })
    }

    /// Returns the trained network; `finish` changes the parameters of the loss at last.
    pub(crate) fn into_network(mut self, finish: impl FnOnce(&mut [f32])) -> ViewNetwork {
        finish(&mut self.parameters[self.network.parameters()..]);
        parameter_bytes::round(&mut self.parameters);
        ViewNetwork::new(self.config, self.network, self.parameters)
    }
}

/// A network in training, whatever its loss.
pub(crate) trait Trainee {
    /// Returns the mean loss of a batch, whose views are `rows`, after a step of the optimiser.
    fn step(&mut self, compute: &Compute, input: &[f32], batch: (&LabelledViews, &[usize]), rate: f32)
    -> f32;
}

impl<L: ViewLoss> Trainee for ViewTrainee<L> {
    fn step(
        &mut self,
        compute: &Compute,
        input: &[f32],
        batch: (&LabelledViews, &[usize]),
        rate: f32,
    ) -> f32 {
        let Self { network, parameters, gradients, doutputs, adam, tape, loss, .. } = self;
        gradients.fill(0.0);
        let (weights, own) = parameters.split_at(network.parameters());
        let (dnetwork, down) = gradients.split_at_mut(network.parameters());
        let outputs = network.forward(compute, weights, input, tape);
        let mean = loss.run(compute, (outputs, own), batch, (doutputs, down));
        network.backward(compute, weights, doutputs, tape, Some(dnetwork), false);
        adam.step(compute, rate, parameters, gradients);
        mean
    }
}

/// Trains networks side by side on the same views. `observer` receives the number of the epoch and the mean loss of each.
///
/// # Errors
/// Returns `InvalidInput` for fewer views than a batch of 64 and where `progress` is stopped, `Internal` if a training diverges, errors of the source.
pub(crate) fn fit_views<const N: usize>(
    source: &mut dyn ViewSource,
    mut trainees: [&mut dyn Trainee; N],
    (epochs, seed): (usize, u64),
    (compute, progress): (&Compute, &dyn Progress),
    observer: &mut dyn FnMut(usize, [f32; N]),
) -> Result<()> {
    let mut random = Random::from_key([seed, 0xe3c]);
    let (mut input, mut order) = (Vec::new(), Vec::new());
    for epoch in 0..epochs {
        let views = source.views(epoch, progress)?;
        if views.len() < BATCH {
            return Err(Error::invalid_input(format!(
                "{} views to train on; give at least {BATCH}",
                views.len()
            )));
        }
        let size = 3 * views.side * views.side;
        input.resize(BATCH * size, 0.0);
        order.clear();
        order.extend(0..views.len());
        random.shuffle(&mut order);
        let (mut sums, batches) = ([0.0; N], views.len() / BATCH);
        for (batch, rows) in order.chunks_exact(BATCH).enumerate() {
            if progress.stopped() {
                return Err(Error::invalid_input("the training was stopped before its end"));
            }
            for (to, row) in input.chunks_exact_mut(size).zip(rows) {
                normalised_planes(views.view(*row), to);
            }
            let done = (epoch * batches + batch) as f32 / (epochs * batches) as f32;
            for (sum, trainee) in sums.iter_mut().zip(&mut trainees) {
                *sum += trainee.step(compute, &input, (views, rows), RATE * (1.0 - done));
            }
        }
        let losses = sums.map(|sum| sum / batches as f32);
        if let Some(loss) = losses.iter().find(|loss| !loss.is_finite()) {
            return Err(Error::internal(format!(
                "the loss of epoch {epoch} is {loss}: the training diverged"
            )));
        }
        observer(epoch, losses);
    }
    Ok(())
}
