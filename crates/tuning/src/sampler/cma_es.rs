//! Covariance matrix adaptation.

use opendr_engine::{Random, Result};
use serde_json::{Value, json};

use crate::records::{StudyRecord, TrialRecord};
use crate::sampler::axis::Axis;
use crate::sampler::symmetric_eigen::eigen_from_symmetric;
use crate::sampler::{DrawnParameters, Sampler, stream};
use crate::space::Parameter;

/// System attribute with a trial's generation and its position before rounding.
const NOTE: &str = "opendr:cma_es";
/// Initial standard deviation, as a fraction of each axis.
const FIRST_WIDTH: f64 = 1.0 / 6.0;
/// Number of redraws of a position outside the range before it is clipped.
const REDRAWS: usize = 100;

/// The covariance matrix adaptation evolution strategy (Hansen, "The CMA evolution strategy: a tutorial", 2016), for
/// ordered numbers; unordered choices are drawn at random. Suited to a few hundred trials or more, and to objectives with
/// correlated parameters.
///
/// It keeps no state: each generation is recomputed from the positions stored in the complete trials, so that workers
/// share one evolution.
#[derive(Debug, Clone, Copy)]
pub struct CmaEs {
    seed: u64,
}

impl CmaEs {
    /// Creates the sampler.
    pub fn new(seed: u64) -> Self {
        Self { seed }
    }
}

impl Sampler for CmaEs {
    fn draw(&self, study: &StudyRecord, number: usize, parameters: &[&Parameter]) -> Result<DrawnParameters> {
        let mut random = stream(self.seed, number, parameters);
        let axes: Vec<Axis> = parameters.iter().map(|parameter| Axis::new(&parameter.distribution)).collect();
        let size = axes.iter().filter(|axis| matches!(axis, Axis::Line(_))).count();
        // Conditional parameters evolve separately.
        let note = format!("{NOTE}:{}", parameters.first().map_or("", |parameter| parameter.name.as_str()));
        let (generation, evolution) = Evolution::of(study, &note, size);
        let place = evolution.draw(&mut random);
        let mut units = place.iter();
        let numbers = axes.iter().map(|axis| {
            let unit = if matches!(axis, Axis::Line(_)) { units.next().copied() } else { None };
            axis.number_from_unit(unit.unwrap_or_else(|| random.unit()))
        });
        let numbers = numbers.collect();
        let notes = if size > 0 {
            vec![(note, json!({"generation": generation, "place": place}))]
        } else {
            Vec::new()
        };
        Ok(DrawnParameters { numbers, system_attributes: notes })
    }
}

/// Constants of the evolution.
struct Rates {
    population: usize,
    /// Recombination weights of the better half, with sum 1.
    weights: Vec<f64>,
    effective: f64,
    width: f64,
    damping: f64,
    path: f64,
    one: f64,
    many: f64,
    /// Expected length of a standard normal vector.
    length: f64,
}

/// The distribution of a generation.
struct Evolution {
    size: usize,
    rates: Rates,
    mean: Vec<f64>,
    width: f64,
    covariance: Vec<f64>,
    width_path: Vec<f64>,
    covariance_path: Vec<f64>,
    generation: usize,
}

impl Rates {
    /// Table 1 of the tutorial, with positive weights only.
    fn new(size: usize) -> Self {
        let n = size.max(1) as f64;
        let population = 4 + (3.0 * n.ln()) as usize;
        let raw = |rank: usize| ((population as f64 + 1.0) / 2.0).ln() - (rank as f64 + 1.0).ln();
        let sum: f64 = (0..population / 2).map(raw).sum();
        let weights: Vec<f64> = (0..population / 2).map(|rank| raw(rank) / sum).collect();
        let effective = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let width = (effective + 2.0) / (n + effective + 5.0);
        let one = 2.0 / ((n + 1.3).powi(2) + effective);
        Self {
            population,
            weights,
            effective,
            width,
            damping: 1.0 + 2.0 * (((effective - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + width,
            path: (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n),
            one,
            many: (1.0 - one)
                .min(2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0).powi(2) + effective)),
            length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }
}

impl Evolution {
    fn new(size: usize) -> Self {
        Self {
            size,
            rates: Rates::new(size),
            mean: vec![0.5; size],
            width: FIRST_WIDTH,
            covariance: (0..size * size).map(|at| if at / size == at % size { 1.0 } else { 0.0 }).collect(),
            width_path: vec![0.0; size],
            covariance_path: vec![0.0; size],
            generation: 0,
        }
    }

    /// Returns the generation to sample from, after all complete ones.
    fn of(study: &StudyRecord, note: &str, size: usize) -> (usize, Self) {
        let mut evolution = Self::new(size);
        let noted: Vec<_> = study.complete().filter_map(|trial| noted(trial, note, size)).collect();
        loop {
            let generation = evolution.generation;
            let mut members: Vec<_> = noted
                .iter()
                .filter(|(of, _, _)| *of == generation)
                .take(evolution.rates.population)
                .map(|(_, place, trial)| (study.losses(trial), place))
                .collect();
            if size == 0 || members.len() < evolution.rates.population {
                return (generation, evolution);
            }
            members.sort_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(std::cmp::Ordering::Equal));
            let places: Vec<&[f64]> = members.iter().map(|(_, place)| place.as_slice()).collect();
            evolution.step(&places);
        }
    }

    fn draw(&self, random: &mut Random) -> Vec<f64> {
        let (values, vectors) = eigen_from_symmetric(self.covariance.clone(), self.size);
        let deviations: Vec<f64> = values.iter().map(|value| value.max(0.0).sqrt()).collect();
        let mut place = Vec::new();
        for _ in 0..REDRAWS {
            let normal: Vec<f64> = deviations.iter().map(|deviation| deviation * random.normal()).collect();
            let turned = product(&vectors, &normal);
            place = self.mean.iter().zip(turned).map(|(mean, step)| mean + self.width * step).collect();
            if place.iter().all(|unit| (0.0..=1.0).contains(unit)) {
                break;
            }
        }
        place.iter().map(|unit| unit.clamp(0.0, 1.0)).collect()
    }

    /// Computes the next generation from the positions of this one, best first (equations 6 to 12, 24 to 37 of the tutorial).
    fn step(&mut self, places: &[&[f64]]) {
        let (size, rates) = (self.size, &self.rates);
        let steps: Vec<Vec<f64>> = places
            .iter()
            .map(|place| {
                place.iter().zip(&self.mean).map(|(unit, mean)| (unit - mean) / self.width).collect()
            })
            .collect();
        let best = || rates.weights.iter().zip(&steps);
        let mean_step: Vec<f64> =
            (0..size).map(|axis| best().map(|(weight, step)| weight * step[axis]).sum()).collect();
        let whitened = self.whitened(&mean_step);
        let keep = 1.0 - rates.width;
        let push = (rates.width * (2.0 - rates.width) * rates.effective).sqrt();
        self.width_path.iter_mut().zip(&whitened).for_each(|(path, step)| *path = keep * *path + push * step);
        let length = self.width_path.iter().map(|part| part * part).sum::<f64>().sqrt();
        self.generation += 1;
        // While the step size grows fast, the covariance path is not updated.
        let warm = (1.0 - keep.powi(2 * self.generation as i32)).sqrt();
        let wait = length / warm >= (1.4 + 2.0 / (size as f64 + 1.0)) * rates.length;
        let push = if wait { 0.0 } else { (rates.path * (2.0 - rates.path) * rates.effective).sqrt() };
        let keep = 1.0 - rates.path;
        self.covariance_path
            .iter_mut()
            .zip(&mean_step)
            .for_each(|(path, step)| *path = keep * *path + push * step);
        let lost = if wait { rates.one * rates.path * (2.0 - rates.path) } else { 0.0 };
        let keep = 1.0 + lost - rates.one - rates.many;
        for at in 0..size * size {
            let (row, column) = (at / size, at % size);
            let many: f64 = best().map(|(weight, step)| weight * step[row] * step[column]).sum();
            let one = self.covariance_path[row] * self.covariance_path[column];
            self.covariance[at] = keep * self.covariance[at] + rates.one * one + rates.many * many;
        }
        self.mean.iter_mut().zip(&mean_step).for_each(|(mean, step)| *mean += self.width * step);
        // A step size wider than the space has no further effect.
        self.width *= ((rates.width / rates.damping) * (length / rates.length - 1.0)).exp();
        self.width = self.width.clamp(1e-12, 1.0);
    }

    /// Transforms a vector to a distribution with identity covariance.
    fn whitened(&self, vector: &[f64]) -> Vec<f64> {
        let size = self.size;
        let (values, vectors) = eigen_from_symmetric(self.covariance.clone(), size);
        let along = |k: usize| (0..size).map(|row| vectors[row * size + k] * vector[row]).sum::<f64>();
        let scaled: Vec<f64> = (0..size).map(|k| along(k) / values[k].max(1e-300).sqrt()).collect();
        product(&vectors, &scaled)
    }
}

/// Multiplies a square matrix by a vector.
fn product(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    let row = |row: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum();
    matrix.chunks_exact(vector.len().max(1)).map(row).collect()
}

/// Returns generation and position of a trial that stored them.
fn noted<'a>(trial: &'a TrialRecord, note: &str, size: usize) -> Option<(usize, Vec<f64>, &'a TrialRecord)> {
    let noted = trial.system_attributes.get(note)?;
    let generation = usize::try_from(noted.get("generation")?.as_u64()?).ok()?;
    let place: Vec<f64> = noted.get("place")?.as_array()?.iter().map(Value::as_f64).collect::<Option<_>>()?;
    let fits = place.len() == size && place.iter().all(|unit| (0.0..=1.0).contains(unit));
    fits.then_some((generation, place, trial))
}
