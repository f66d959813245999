//! Matching of weights by the order of the layers.

use std::collections::HashSet;

use opendr_engine::{Error, Result};

use crate::weights::fill::Plan;
use crate::weights::layer::{Layer, Norm, layers};
use crate::weights::slot::Slot;
use crate::weights::{Report, Rules, Weight, WeightTable};

/// Returns the plan that assigns weights by the order of the layers, and its report.
pub(super) fn plan(slots: &[Slot], table: &WeightTable, rules: &Rules) -> Result<(Plan, Report)> {
    let wanted = layers(slots.iter().filter(|slot| slot.covered));
    let given = layers(table.weights().iter());
    let (mut plan, mut used) = (Plan::new(), HashSet::new());
    for (number, (place, source)) in wanted.iter().zip(&given).enumerate() {
        let fit = Pair { place, source, epsilon: rules.epsilon() as f32 }.fit(&mut plan);
        fit.map_err(|error| {
            error.context(format!(
                "layer {} of {} in the file, {:.80?}, for {} of the network",
                number + 1,
                given.len(),
                source.kernel.name(),
                place.kernel.path
            ))
        })?;
        let Layer { kernel, bias, norm } = source;
        used.extend([kernel.name()].into_iter().chain(bias.map(Weight::name)));
        if let Some(Norm { scale, shift, mean, variance }) = norm {
            used.extend([scale, shift, mean, variance].map(|weight| weight.name()));
        }
    }
    let mut report = Report::default();
    for slot in slots.iter().filter(|slot| slot.covered) {
        let list = if plan.contains_key(&slot.path) { &mut report.loaded } else { &mut report.missing };
        list.push(slot.path.clone());
    }
    let left = table.weights().iter().map(Weight::name).filter(|name| !used.contains(name));
    report.unexpected = left.map(str::to_owned).collect();
    Ok((plan, report))
}

/// A layer of the module and the layer of the file that is assigned to it.
struct Pair<'a> {
    place: &'a Layer<'a, Slot>,
    source: &'a Layer<'a, Weight>,
    epsilon: f32,
}

impl Pair<'_> {
    fn fit(&self, plan: &mut Plan) -> Result<()> {
        let Self { place, source, .. } = self;
        let shape = place.kernel.file_shape();
        if shape != source.kernel.shape() {
            return Err(Error::invalid_input(format!(
                "shape {:?} does not fit {shape:?}; the file must be of this architecture and width",
                source.kernel.shape()
            )));
        }
        let outputs = shape[if place.kernel.transposed { 1 } else { 0 }];
        let mut kernel = source.kernel.values().to_vec();
        let mut bias = match source.bias {
            Some(bias) => numbers(bias, outputs)?,
            None => vec![0.0; outputs],
        };
        match (&place.norm, &source.norm) {
            (None, None) => {}
            (Some(place), Some(source)) => self.keep_norm(place, source, &mut bias, plan)?,
            (Some(place), None) => self.make_identity(place, &mut bias, plan),
            (None, Some(source)) => self.fold_norm(source, &mut kernel, &mut bias)?,
        }
        match place.bias {
            Some(slot) => put(plan, slot, bias),
            None if bias.iter().all(|number| *number == 0.0) => {}
            None => {
                return Err(Error::invalid_input("the file has a bias, but the network's layer has none"));
            }
        }
        plan.insert(place.kernel.path.clone(), place.kernel.values_from_file(&kernel));
        Ok(())
    }

    /// Both have a normalisation. A bias that the module's layer lacks is subtracted from the mean.
    fn keep_norm(
        &self,
        place: &Norm<'_, Slot>,
        source: &Norm<'_, Weight>,
        bias: &mut [f32],
        plan: &mut Plan,
    ) -> Result<()> {
        let read = |weight| numbers(weight, bias.len());
        let mut mean = read(source.mean)?;
        put(plan, place.scale, read(source.scale)?);
        put(plan, place.shift, read(source.shift)?);
        put(plan, place.variance, read(source.variance)?);
        if self.place.bias.is_none() {
            mean.iter_mut().zip(bias.iter_mut()).for_each(|(mean, bias)| *mean -= std::mem::take(bias));
        }
        put(plan, place.mean, mean);
        Ok(())
    }

    /// The normalisation is folded into the file's kernel: the module's becomes an identity, which may hold the bias.
    fn make_identity(&self, place: &Norm<'_, Slot>, bias: &mut [f32], plan: &mut Plan) {
        let outputs = bias.len();
        let mut shift = vec![0.0; outputs];
        if self.place.bias.is_none() {
            shift.copy_from_slice(bias);
            bias.fill(0.0);
        }
        put(plan, place.scale, vec![1.0; outputs]);
        put(plan, place.shift, shift);
        put(plan, place.mean, vec![0.0; outputs]);
        put(plan, place.variance, vec![1.0 - self.epsilon; outputs]);
    }

    /// The module has no normalisation: the file's is folded into kernel and bias.
    fn fold_norm(&self, source: &Norm<'_, Weight>, kernel: &mut [f32], bias: &mut [f32]) -> Result<()> {
        if self.place.kernel.transposed {
            return Err(Error::unsupported("a normalisation cannot be folded into a transposed convolution"));
        }
        let [scale, shift, mean, variance] = [source.scale, source.shift, source.mean, source.variance]
            .map(|weight| numbers(weight, bias.len()));
        let (scale, shift, mean, variance) = (scale?, shift?, mean?, variance?);
        let each = kernel.len() / bias.len().max(1);
        for (output, kernel) in kernel.chunks_exact_mut(each.max(1)).enumerate() {
            let factor = scale[output] / (variance[output] + self.epsilon).sqrt();
            kernel.iter_mut().for_each(|number| *number *= factor);
            bias[output] = shift[output] + (bias[output] - mean[output]) * factor;
        }
        Ok(())
    }
}

fn put(plan: &mut Plan, slot: &Slot, values: Vec<f32>) {
    plan.insert(slot.path.clone(), values);
}

/// Returns the values of a bias or a part of a normalisation, one per output.
fn numbers(weight: &Weight, outputs: usize) -> Result<Vec<f32>> {
    match weight.values() {
        values if values.len() == outputs => Ok(values.to_vec()),
        values => Err(Error::invalid_input(format!(
            "{:.80?} has {} values for {outputs} outputs",
            weight.name(),
            values.len()
        ))),
    }
}
