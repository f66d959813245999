//! What of the last layer's inputs is adapted.

use opendr_engine::environment::TrackingLayout;
use opendr_engine::{Error, Result};

use super::AdaptablePolicy;
use crate::matrix::Dense;

/// Directions of a last layer that reproduce the numbers of the reference, and a constant.
///
/// The inputs of a last layer (the activations of the last hidden layer, and 1) depend on errors and reference at once. A step along
/// them would change the feedback gains, too. Adapted are therefore only combinations that follow a number of the reference (least
/// squares over observations of the training, whose errors are spread): the change of a command is a feedforward.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceFeatures {
    /// Inputs of the last layer, with the 1 of its bias.
    size: usize,
    /// Features: the constant, then those of the reference.
    count: usize,
    /// `[size, count]`; a feature of 1 changes the command by about 1.
    directions: Vec<f32>,
    /// Share of each reference number's variance that the last layer reproduces.
    explained: Vec<f32>,
}

/// Share of the inputs' mean variance that is added to every direction, so that directions of noise do not count.
const RIDGE: f64 = 1e-4;

impl ReferenceFeatures {
    /// Creates the constant alone: loads are learned, and no function of the reference.
    ///
    /// # Errors
    /// `Unsupported` for a policy without a dense last layer, and those of the policy.
    pub fn constant<P: AdaptablePolicy>(policy: &mut P, layout: &TrackingLayout) -> Result<Self> {
        let size = size_of(policy, layout)?;
        let mut inputs = Inputs::new(policy, layout);
        inputs.evaluate(policy, &vec![0.0; layout.len])?;
        let slope = inputs.slopes().iter().sum::<f32>() / layout.axes as f32;
        let mut directions = vec![0.0; size];
        directions[size - 1] = unit(slope)?;
        Ok(Self { size, count: 1, directions, explained: Vec::new() })
    }

    /// Finds the features in `observations`, rows as the policy was trained on: errors are to vary independently of the reference.
    ///
    /// # Errors
    /// `InvalidInput` without a row, `Unsupported` for a policy without a dense last layer, and those of the policy.
    pub fn of<P: AdaptablePolicy>(
        policy: &mut P,
        observations: &[f32],
        layout: &TrackingLayout,
    ) -> Result<Self> {
        let size = size_of(policy, layout)?;
        let rows = observations.chunks_exact(layout.len);
        if rows.len() < 2 || !rows.remainder().is_empty() {
            return Err(Error::invalid_input(format!(
                "{} numbers are no rows of {}; give observations of the training",
                observations.len(),
                layout.len
            )));
        }
        let numbers = standardised(observations, layout);
        let share = 1.0 / rows.len() as f64;
        let mut inputs = Inputs::new(policy, layout);
        let mut covariance = vec![0.0; size * size];
        let mut products = vec![0.0; size * numbers.len().max(1)];
        let (mut row_inputs, mut slope) = (vec![0.0; size], 0.0);
        for row in rows {
            inputs.evaluate(policy, row)?;
            inputs.write(&mut row_inputs);
            slope += share * f64::from(inputs.slopes().iter().sum::<f32>()) / layout.axes as f64;
            for (at, input) in row_inputs.iter().enumerate() {
                let weight = share * f64::from(*input);
                let own = &mut covariance[at * size..(at + 1) * size];
                own.iter_mut().zip(&row_inputs).for_each(|(sum, other)| *sum += weight * f64::from(*other));
                for (to, [place, mean, deviation]) in products[at * numbers.len()..].iter_mut().zip(&numbers)
                {
                    *to += weight * (f64::from(row[*place as usize]) - mean) / deviation;
                }
            }
        }
        let unit = f64::from(unit(slope as f32)?);
        let mean = (0..size).map(|at| covariance[at * size + at]).sum::<f64>() / size as f64;
        (0..size).for_each(|at| covariance[at * size + at] += RIDGE * mean + 1e-12);
        let count = numbers.len() + 1;
        let mut directions = vec![0.0; size * count];
        directions[(size - 1) * count] = unit as f32;
        let mut explained = Vec::new();
        if !numbers.is_empty() {
            let right = Dense::new(size, numbers.len(), &products)?;
            let solved = Dense::new(size, size, &covariance)?.solve(&right).ok_or_else(|| {
                Error::invalid_input("the last layer's inputs are constant; give observations that vary")
            })?;
            for (at, row) in solved.numbers.chunks_exact(numbers.len()).enumerate() {
                let own = &mut directions[at * count + 1..(at + 1) * count];
                own.iter_mut().zip(row).for_each(|(to, number)| *to = (unit * number) as f32);
            }
            explained = (0..numbers.len())
                .map(|at| {
                    (0..size).map(|input| solved.at(input, at) * right.at(input, at)).sum::<f64>() as f32
                })
                .collect();
        }
        Ok(Self { size, count, directions, explained })
    }

    /// Returns the number of features.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the share of the variance of each number of the reference that varies which the last layer reproduces, 0 to 1.
    pub fn explained(&self) -> &[f32] {
        &self.explained
    }

    /// Whether they belong to a last layer of so many parameters and outputs.
    pub(super) fn fits(&self, parameters: usize, outputs: usize) -> bool {
        self.size * outputs == parameters
    }

    /// Writes the features of the inputs of a last layer.
    pub(super) fn write(&self, inputs: &[f32], features: &mut [f32]) {
        features.fill(0.0);
        for (input, directions) in inputs.iter().zip(self.directions.chunks_exact(self.count)) {
            features.iter_mut().zip(directions).for_each(|(feature, own)| *feature += input * own);
        }
    }

    /// Sets the last layer to `base` and the features times `weights`, `[axes, count]`; returns the distance from `base`.
    pub(super) fn apply(&self, base: &[f32], weights: &[f32], parameters: &mut [f32]) -> f32 {
        let outputs = parameters.len() / self.size;
        let mut square = 0.0;
        for (input, directions) in self.directions.chunks_exact(self.count).enumerate() {
            for (axis, weights) in weights.chunks_exact(self.count).enumerate() {
                let change: f32 = directions.iter().zip(weights).map(|(own, weight)| own * weight).sum();
                square += change * change;
                parameters[input * outputs + axis] = base[input * outputs + axis] + change;
            }
        }
        square.sqrt()
    }
}

/// The inputs of a last layer and the slopes of the commands behind it.
pub(super) struct Inputs {
    gradients: Vec<f32>,
    ones: Vec<f32>,
    action: Vec<f32>,
    range: std::ops::Range<usize>,
    outputs: usize,
}

impl Inputs {
    pub fn new<P: AdaptablePolicy>(policy: &P, layout: &TrackingLayout) -> Self {
        Self {
            gradients: vec![0.0; policy.parameters().len()],
            ones: vec![1.0; layout.axes],
            action: vec![0.0; layout.axes],
            range: policy.last_layer(),
            outputs: policy.outputs(),
        }
    }

    fn evaluate<P: AdaptablePolicy>(&mut self, policy: &mut P, observation: &[f32]) -> Result<()> {
        policy.act(observation, &mut self.action)?;
        self.of_last_act(policy)
    }

    /// Takes those of the policy's last act.
    pub fn of_last_act<P: AdaptablePolicy>(&mut self, policy: &mut P) -> Result<()> {
        self.gradients[self.range.clone()].fill(0.0);
        policy.backward(&self.ones, &mut self.gradients)
    }

    /// Returns the derivative of each command by its output of the network.
    pub fn slopes(&self) -> &[f32] {
        let first = self.range.end - self.outputs;
        &self.gradients[first..first + self.ones.len()]
    }

    /// Writes the inputs, with the 1 of the bias; zeros where no command changes any more.
    ///
    /// The gradients are the outer product of inputs and slopes.
    pub fn write(&self, inputs: &mut [f32]) {
        let (axes, slopes) = (self.ones.len(), self.slopes());
        let larger = |best: usize, at: usize| if slopes[at].abs() > slopes[best].abs() { at } else { best };
        let axis = (1..axes).fold(0, larger);
        if slopes[axis] == 0.0 {
            return inputs.fill(0.0);
        }
        let own = self.gradients[self.range.clone()].chunks_exact(self.outputs);
        inputs.iter_mut().zip(own).for_each(|(input, row)| *input = row[axis] / slopes[axis]);
    }
}

/// Inputs of the last layer.
fn size_of<P: AdaptablePolicy>(policy: &P, layout: &TrackingLayout) -> Result<usize> {
    let (parameters, outputs) = (policy.last_layer().len(), policy.outputs());
    if outputs < layout.axes || parameters == 0 || !parameters.is_multiple_of(outputs) {
        return Err(Error::unsupported(format!(
            "a last layer of {parameters} parameters and {outputs} outputs is no dense one of {} commands; such a policy cannot be adapted",
            layout.axes
        )));
    }
    Ok(parameters / outputs)
}

fn unit(slope: f32) -> Result<f32> {
    if slope > 0.0 && slope.is_finite() {
        return Ok(1.0 / slope);
    }
    Err(Error::unsupported(
        "the commands of the policy do not depend on its last layer (they are at their limits); such a policy cannot be adapted",
    ))
}

/// Place, mean and deviation of each number of the reference that varies.
fn standardised(observations: &[f32], layout: &TrackingLayout) -> Vec<[f64; 3]> {
    let [first, count] = layout.reference;
    let rows = || observations.chunks_exact(layout.len);
    let share = 1.0 / rows().len() as f64;
    let mean = |of: &dyn Fn(f64) -> f64, place: usize| {
        rows().map(|row| share * of(f64::from(row[place]))).sum::<f64>()
    };
    let moments = (first..first + count).map(|place| {
        let average = mean(&|number| number, place);
        [place as f64, average, mean(&|number| (number - average).powi(2), place).sqrt()]
    });
    moments.filter(|[.., deviation]| *deviation > 1e-6).collect()
}
