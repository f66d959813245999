//! Parzen estimators: mixtures of kernels.

use opendr_engine::Random;

use crate::normal::{log_mass, mass};
use crate::sampler::axis::{Axis, Line};

/// Number of trials above which older ones have less weight.
const FULL_WEIGHT: usize = 25;
/// Divisor for the minimum kernel width on an axis.
const MIN_WIDTH_DIVISOR: f64 = 100.0;

/// A density over several axes: one kernel per observation and one as wide as the axes, each a product of one density
/// per axis.
pub struct Mixture<'a> {
    axes: &'a [Axis],
    /// Weights with sum 1; the last is that of the wide kernel.
    weights: Vec<f64>,
    /// Densities by axis.
    densities: Vec<Density>,
}

/// Densities of all kernels over one axis.
enum Density {
    /// Normal distributions truncated to [0, 1].
    Normals(Vec<Normal>),
    /// Probability of each choice, by kernel.
    Choices(Vec<Vec<f64>>),
}

#[derive(Clone, Copy)]
struct Normal {
    centre: f64,
    width: f64,
    /// Log-probability of [0, 1] before truncation.
    log_inside: f64,
}

impl<'a> Mixture<'a> {
    /// Creates the density of `observations`, each with one number per axis, oldest first.
    pub fn new(axes: &'a [Axis], observations: &[Vec<f64>]) -> Self {
        let mut weights = weights(observations.len());
        weights.push(1.0);
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        let density = |(at, axis): (usize, &Axis)| {
            let column: Vec<f64> = observations.iter().map(|row| row[at]).collect();
            match axis {
                Axis::Line(line) => Density::Normals(normals(line, &column)),
                Axis::Choices(count) => Density::Choices(choices(*count, &column)),
            }
        };
        let densities = axes.iter().enumerate().map(density).collect();
        Self { axes, weights, densities }
    }

    /// Draws numbers from the density.
    pub fn draw(&self, random: &mut Random) -> Vec<f64> {
        let kernel = drawn_index(&self.weights, random);
        let draw = |(axis, density): (&Axis, &Density)| match density {
            Density::Normals(normals) => axis.number_from_unit(normals[kernel].draw(random)),
            Density::Choices(kernels) => drawn_index(&kernels[kernel], random) as f64,
        };
        self.axes.iter().zip(&self.densities).map(draw).collect()
    }

    /// Returns the log-density at `numbers`, up to a constant common to all densities over these axes.
    pub fn log_density(&self, numbers: &[f64]) -> f64 {
        let mut logs: Vec<f64> = self.weights.iter().map(|weight| weight.ln()).collect();
        for ((axis, density), number) in self.axes.iter().zip(&self.densities).zip(numbers) {
            match (axis, density) {
                (Axis::Line(line), Density::Normals(normals)) => match line.bin(*number) {
                    Some(bin) => add(&mut logs, normals.iter().map(|normal| normal.log_mass(bin))),
                    None => {
                        let unit = line.unit_from_number(*number);
                        add(&mut logs, normals.iter().map(|normal| normal.log_density(unit)));
                    }
                },
                (_, Density::Choices(kernels)) => {
                    let choice = *number as usize;
                    add(
                        &mut logs,
                        kernels.iter().map(|kernel| kernel.get(choice).copied().unwrap_or(0.0).ln()),
                    );
                }
                _ => {}
            }
        }
        let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if largest == f64::NEG_INFINITY {
            return largest;
        }
        largest + logs.iter().map(|log| (log - largest).exp()).sum::<f64>().ln()
    }
}

impl Normal {
    fn new(centre: f64, width: f64) -> Self {
        Self { centre, width, log_inside: mass(-centre / width, (1.0 - centre) / width).ln() }
    }

    /// Draws a position in [0, 1] by rejection. The centre is inside and the width at most 1, so at least one in three draws is accepted.
    fn draw(&self, random: &mut Random) -> f64 {
        loop {
            let place = self.centre + self.width * random.normal();
            if (0.0..=1.0).contains(&place) {
                return place;
            }
        }
    }

    fn log_density(&self, place: f64) -> f64 {
        let distance = (place - self.centre) / self.width;
        -0.5 * distance * distance - (std::f64::consts::TAU.sqrt() * self.width).ln() - self.log_inside
    }

    fn log_mass(&self, (start, end): (f64, f64)) -> f64 {
        log_mass((start - self.centre) / self.width, (end - self.centre) / self.width) - self.log_inside
    }
}

fn add(sums: &mut [f64], terms: impl Iterator<Item = f64>) {
    sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
}

/// Returns the weights: 1 for the newest; older ones fall linearly to one over the count.
fn weights(count: usize) -> Vec<f64> {
    let ramp = count.saturating_sub(FULL_WEIGHT);
    let last = 1.0 / count.max(1) as f64;
    let weight = |at: usize| match at {
        at if at >= ramp => 1.0,
        _ if ramp == 1 => last,
        at => last + (1.0 - last) * at as f64 / (ramp - 1) as f64,
    };
    (0..count).map(weight).collect()
}

/// Creates kernels as wide as the larger gap to their neighbours.
fn normals(line: &Line, numbers: &[f64]) -> Vec<Normal> {
    let places: Vec<f64> =
        numbers.iter().map(|number| line.unit_from_number(*number).clamp(0.0, 1.0)).collect();
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|a, b| places[*a].total_cmp(&places[*b]));
    let narrowest = 1.0 / MIN_WIDTH_DIVISOR.min(places.len() as f64 + 2.0);
    let mut widths = vec![1.0; places.len()];
    for (at, trial) in order.iter().enumerate() {
        let place = places[*trial];
        let before = at.checked_sub(1).map(|before| place - places[order[before]]);
        let after = order.get(at + 1).map(|after| places[*after] - place);
        // A single kernel extends to the farther end.
        let gap = match (before, after) {
            (None, None) => place.max(1.0 - place),
            (before, after) => before.unwrap_or(0.0).max(after.unwrap_or(0.0)),
        };
        widths[*trial] = gap.clamp(narrowest, 1.0);
    }
    let kernels = places.iter().zip(&widths).map(|(place, width)| Normal::new(*place, *width));
    kernels.chain([Normal::new(0.5, 1.0)]).collect()
}

/// Creates kernels that prefer their choice, more strongly with more observations.
fn choices(count: usize, numbers: &[f64]) -> Vec<Vec<f64>> {
    let kernels = numbers.len() + 1;
    let rest = 1.0 / kernels as f64;
    let sum = 1.0 + rest * count as f64;
    let kernel = |chosen: &f64| {
        let weight = |choice: usize| if choice == *chosen as usize { 1.0 + rest } else { rest };
        (0..count).map(|choice| weight(choice) / sum).collect()
    };
    numbers.iter().map(kernel).chain([vec![1.0 / count as f64; count]]).collect()
}

/// Draws an index with probabilities `weights`, whose sum is 1.
fn drawn_index(weights: &[f64], random: &mut Random) -> usize {
    let mut left = random.unit();
    let last = weights.len().saturating_sub(1);
    weights
        .iter()
        .take(last)
        .position(|weight| {
            left -= weight;
            left < 0.0
        })
        .unwrap_or(last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Distribution;

    #[test]
    fn older_trials_weigh_less() {
        assert_eq!(weights(3), [1.0; 3]);
        assert_eq!(weights(25), [1.0; 25]);
        assert_eq!(weights(26)[..2], [1.0 / 26.0, 1.0]);
        let many = weights(50);
        assert_eq!((many[0], many[24], many[25]), (0.02, 1.0, 1.0));
        assert!((many[12] - 0.51).abs() < 1e-12);
    }

    #[test]
    fn densities_sum_to_one() {
        let axes = [
            Axis::new(&Distribution::float(-1.0, 3.0).unwrap()),
            Axis::new(&Distribution::log_int(1, 6).unwrap()),
            Axis::new(&Distribution::categorical(["a", "b", "c"]).unwrap()),
        ];
        let mixture = Mixture::new(&axes, &[vec![0.5, 2.0, 1.0], vec![2.5, 6.0, 1.0], vec![-1.0, 1.0, 2.0]]);
        let mut sum = 0.0;
        let cells = 200;
        for cell in 0..cells {
            let x = -1.0 + 4.0 * (f64::from(cell) + 0.5) / f64::from(cells);
            for int in 1..=6 {
                for choice in 0..3 {
                    let numbers = [x, f64::from(int), f64::from(choice)];
                    sum += mixture.log_density(&numbers).exp() / f64::from(cells);
                }
            }
        }
        assert!((sum - 1.0).abs() < 1e-4, "{sum}");
    }

    #[test]
    fn draws_follow_the_density() {
        let axes = [Axis::new(&Distribution::int(0, 4).unwrap()), Axis::Choices(2)];
        let mixture = Mixture::new(&axes, &[vec![1.0, 0.0], vec![3.0, 1.0], vec![3.0, 1.0]]);
        let mut counts = [[0.0; 2]; 5];
        let mut random = Random::new(5);
        for _ in 0..40_000 {
            let numbers = mixture.draw(&mut random);
            counts[numbers[0] as usize][numbers[1] as usize] += 1.0 / 40_000.0;
        }
        for (int, row) in counts.iter().enumerate() {
            for (choice, share) in row.iter().enumerate() {
                let wanted = mixture.log_density(&[int as f64, choice as f64]).exp();
                assert!((share - wanted).abs() < 0.01, "{int} {choice}: {share} {wanted}");
            }
        }
    }
}
