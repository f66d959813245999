//! Log-probabilities of actions and their gradients.

use opendr_engine::Random;
use opendr_kernels::{
    Isa, categorical_backward, entropy, gaussian_backward, gaussian_entropy, gaussian_log_density,
    log_softmax,
};

use super::Head;
use super::head::LOG_STD_BOUNDS;

/// Log-probabilities and entropies of the actions of a batch, with reused work memory.
#[derive(Debug, Clone, Default)]
pub(crate) struct Likelihood {
    /// Sampled actions: choices counted from 0, continuous actions before clipping.
    pub actions: Vec<f32>,
    /// Log-probability or log-density of each row's action.
    pub log_probabilities: Vec<f32>,
    /// Entropy of each row, in nats.
    pub entropies: Vec<f32>,
    /// Gradient of the network's outputs.
    pub doutputs: Vec<f32>,
    logs: Vec<f32>,
    probabilities: Vec<f32>,
}

impl Likelihood {
    /// Samples an action for each row of `outputs`, with its log-probability. The head is categorical, binary or Gaussian.
    pub fn sample(&mut self, isa: Isa, head: &Head, outputs: &[f32], log_std: &[f32], random: &mut Random) {
        let rows = outputs.len() / head.outputs();
        self.actions.resize(rows * head.action_len(), 0.0);
        match head {
            Head::Categorical { counts, .. } => {
                self.softmax(isa, outputs, counts);
                let mut rest = &self.probabilities[..];
                for (action, count) in self.actions.iter_mut().zip(counts.iter().cycle()) {
                    let (own, behind) = rest.split_at(*count as usize);
                    *action = choice_at(own, random.unit()) as f32;
                    rest = behind;
                }
            }
            Head::Binary(_) => {
                for (action, score) in self.actions.iter_mut().zip(outputs) {
                    *action = f32::from(random.unit() < f64::from(logistic(*score)));
                }
            }
            _ => {
                for (action, (mean, log_std)) in
                    self.actions.iter_mut().zip(outputs.iter().zip(log_std.iter().cycle()))
                {
                    *action = mean + log_std.exp() * random.normal() as f32;
                }
            }
        }
        let actions = std::mem::take(&mut self.actions);
        self.weigh(head, outputs, log_std, &actions);
        self.actions = actions;
    }

    /// Computes log-probabilities and entropies of rows of `actions`.
    pub fn evaluate(&mut self, isa: Isa, head: &Head, outputs: &[f32], log_std: &[f32], actions: &[f32]) {
        if let Head::Categorical { counts, .. } = head {
            self.softmax(isa, outputs, counts);
        }
        self.weigh(head, outputs, log_std, actions);
    }

    fn softmax(&mut self, isa: Isa, scores: &[f32], counts: &[u32]) {
        self.logs.resize(scores.len(), 0.0);
        self.probabilities.resize(scores.len(), 0.0);
        let first = counts.first().map_or(1, |count| *count as usize);
        if counts.iter().all(|count| *count as usize == first) {
            return log_softmax(isa, scores, first, &mut self.logs, &mut self.probabilities);
        }
        let (mut at, mut counts) = (0, counts.iter().cycle());
        while at < scores.len() {
            let own = at..at + counts.next().map_or(1, |count| *count as usize);
            let (logs, probabilities) = (&mut self.logs[own.clone()], &mut self.probabilities[own.clone()]);
            log_softmax(isa, &scores[own.clone()], own.len(), logs, probabilities);
            at = own.end;
        }
    }

    fn weigh(&mut self, head: &Head, outputs: &[f32], log_std: &[f32], actions: &[f32]) {
        self.log_probabilities.clear();
        self.entropies.clear();
        let rows = outputs.chunks_exact(head.outputs()).zip(actions.chunks_exact(head.action_len()));
        match head {
            Head::Categorical { counts, .. } => {
                let mut at = 0;
                for (_, actions) in rows {
                    let (mut log, mut spread) = (0.0, 0.0);
                    for (action, count) in actions.iter().zip(counts) {
                        let own = at..at + *count as usize;
                        log += self.logs[at + *action as usize];
                        spread += entropy(&self.logs[own.clone()], &self.probabilities[own.clone()]);
                        at = own.end;
                    }
                    self.log_probabilities.push(log);
                    self.entropies.push(spread);
                }
            }
            Head::Binary(_) => {
                for (scores, actions) in rows {
                    let (mut log, mut spread) = (0.0, 0.0);
                    for (score, action) in scores.iter().zip(actions) {
                        log += action * score - softplus(*score);
                        spread += softplus(*score) - score * logistic(*score);
                    }
                    self.log_probabilities.push(log);
                    self.entropies.push(spread);
                }
            }
            Head::SquashedGaussian(bounds) => {
                for (outputs, actions) in rows {
                    let (means, log_stds) = outputs.split_at(bounds.low.len());
                    let (log, spread) = squashed(means, log_stds, actions);
                    self.log_probabilities.push(log);
                    self.entropies.push(spread);
                }
            }
            _ => {
                let spread = gaussian_entropy(log_std);
                for (means, actions) in rows {
                    self.log_probabilities.push(gaussian_log_density(means, log_std, actions));
                    self.entropies.push(spread);
                }
            }
        }
    }

    /// Writes the gradient of the network's outputs into `doutputs` and adds that of the log standard deviations to `dlog_std`. The
    /// loss has the gradients `dlogs` by the log-probabilities of the last evaluation and `dentropy` by each entropy.
    pub fn backward(
        &mut self,
        head: &Head,
        outputs: &[f32],
        log_std: &[f32],
        actions: &[f32],
        [dlogs, dlog_std]: [&mut [f32]; 2],
        dentropy: f32,
    ) {
        self.doutputs.resize(outputs.len(), 0.0);
        let width = head.outputs();
        match head {
            Head::Categorical { counts, .. } => {
                let mut at = 0;
                for (dlog, actions) in dlogs.iter().zip(actions.chunks_exact(counts.len())) {
                    for (action, count) in actions.iter().zip(counts) {
                        let own = at..at + *count as usize;
                        categorical_backward(
                            &self.logs[own.clone()],
                            &self.probabilities[own.clone()],
                            *action as usize,
                            [*dlog, dentropy],
                            &mut self.doutputs[own.clone()],
                        );
                        at = own.end;
                    }
                }
            }
            Head::Binary(_) => {
                let scores = outputs.iter().zip(actions).zip(&mut self.doutputs);
                for (at, ((score, action), doutput)) in scores.enumerate() {
                    let share = logistic(*score);
                    *doutput =
                        dlogs[at / width] * (action - share) - dentropy * score * share * (1.0 - share);
                }
            }
            Head::SquashedGaussian(_) => {
                let rows = outputs.chunks_exact(width).zip(actions.chunks_exact(width / 2));
                for ((outputs, actions), (dlog, doutputs)) in
                    rows.zip(dlogs.iter().zip(self.doutputs.chunks_exact_mut(width)))
                {
                    squashed_backward(outputs, actions, [*dlog, dentropy], doutputs);
                }
            }
            _ => {
                let rows = outputs.chunks_exact(width).zip(actions.chunks_exact(width));
                for ((means, actions), (dlog, dmeans)) in
                    rows.zip(dlogs.iter().zip(self.doutputs.chunks_exact_mut(width)))
                {
                    gaussian_backward([means, log_std, actions], *dlog, dmeans, dlog_std);
                }
                let whole = dentropy * dlogs.len() as f32;
                dlog_std.iter_mut().for_each(|dlog_std| *dlog_std += whole);
            }
        }
    }
}

/// Returns the choice whose interval of the cumulative distribution contains a number.
fn choice_at(probabilities: &[f32], number: f64) -> usize {
    let mut sum = 0.0;
    for (place, probability) in probabilities.iter().enumerate() {
        sum += f64::from(*probability);
        if number < sum {
            return place;
        }
    }
    // Rounding may leave the sum below 1; choices of probability 0 are still never sampled.
    probabilities.iter().rposition(|probability| *probability > 0.0).unwrap_or(0)
}

/// Returns the probability of 1 for a logit.
fn logistic(score: f32) -> f32 {
    1.0 / (1.0 + (-score).exp())
}

/// ln(1 + e^x), which does not overflow.
fn softplus(x: f32) -> f32 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}

/// Largest magnitude of a demonstrated action with a finite inverse tanh.
const INNERMOST: f32 = 1.0 - 1e-6;

fn clamped(log_std: f32) -> f32 {
    log_std.clamp(LOG_STD_BOUNDS[0], LOG_STD_BOUNDS[1])
}

/// Returns the log-density of squashed actions in [-1, 1], and the entropy before squashing.
fn squashed(means: &[f32], log_stds: &[f32], actions: &[f32]) -> (f32, f32) {
    let (mut log, mut spread) = (0.0, 0.0);
    for (axis, action) in actions.iter().enumerate() {
        let action = action.clamp(-INNERMOST, INNERMOST);
        let log_std = [clamped(log_stds[axis])];
        log += gaussian_log_density(&means[axis..=axis], &log_std, &[action.atanh()]);
        log -= (1.0 - action * action + 1e-6).ln();
        spread += gaussian_entropy(&log_std);
    }
    (log, spread)
}

fn squashed_backward(outputs: &[f32], actions: &[f32], [dlog, dentropy]: [f32; 2], doutputs: &mut [f32]) {
    let (means, log_stds) = outputs.split_at(actions.len());
    let (dmeans, dlog_stds) = doutputs.split_at_mut(actions.len());
    for (axis, action) in actions.iter().enumerate() {
        let before = action.clamp(-INNERMOST, INNERMOST).atanh();
        let log_std = clamped(log_stds[axis]);
        let mut dlog_std = [dentropy];
        let own = axis..=axis;
        gaussian_backward(
            [&means[own.clone()], &[log_std], &[before]],
            dlog,
            &mut dmeans[own],
            &mut dlog_std,
        );
        // A clamped value has no gradient.
        dlog_stds[axis] = if log_std == log_stds[axis] { dlog_std[0] } else { 0.0 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::policy::Bounds;

    fn bounds(axes: usize) -> Bounds {
        Bounds { low: vec![-1.0; axes], high: vec![1.0; axes] }
    }

    /// Compares gradients with finite differences, for a weighted sum of log-probabilities and entropies.
    fn assert_gradients(head: &Head, outputs: &[f32], log_std: &[f32], actions: &[f32]) {
        let (mut dlogs, dentropy) = ([1.5, -0.5], 0.25);
        let loss = |outputs: &[f32], log_std: &[f32]| {
            let mut likelihood = Likelihood::default();
            likelihood.evaluate(Isa::best(), head, outputs, log_std, actions);
            let (logs, spreads) = (&likelihood.log_probabilities, &likelihood.entropies);
            1.5 * logs[0] - 0.5 * logs[1] + dentropy * (spreads[0] + spreads[1])
        };
        let mut likelihood = Likelihood::default();
        let mut dlog_std = vec![0.0; log_std.len()];
        likelihood.evaluate(Isa::best(), head, outputs, log_std, actions);
        likelihood.backward(head, outputs, log_std, actions, [&mut dlogs, &mut dlog_std], dentropy);
        let moved = |values: &[f32], at: usize, by: f32| {
            let mut values = values.to_vec();
            values[at] += by;
            values
        };
        let step = 1.0 / 256.0;
        for (at, gradient) in likelihood.doutputs.iter().enumerate() {
            let [up, down] = [step, -step].map(|by| loss(&moved(outputs, at, by), log_std));
            let difference = (up - down) / (2.0 * step);
            assert!((gradient - difference).abs() < 2e-3, "{head:?} {at}: {gradient} {difference}");
        }
        for (at, gradient) in dlog_std.iter().enumerate() {
            let [up, down] = [step, -step].map(|by| loss(outputs, &moved(log_std, at, by)));
            let difference = (up - down) / (2.0 * step);
            assert!((gradient - difference).abs() < 2e-3, "{head:?} {at}: {gradient} {difference}");
        }
    }

    #[test]
    fn gradients_are_differences() {
        let outputs = [0.3, -0.5, 1.0, 0.2, -0.1, 0.6, 0.7, -0.9, 0.4, 0.1];
        let mixed = Head::Categorical { counts: vec![2, 3], start: 0 };
        assert_gradients(&mixed, &outputs, &[], &[1.0, 2.0, 0.0, 0.0]);
        let even = Head::Categorical { counts: vec![5], start: 0 };
        assert_gradients(&even, &outputs, &[], &[3.0, 0.0]);
        assert_gradients(&Head::Binary(3), &outputs[..6], &[], &[1.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
        let gaussian = Head::Gaussian(bounds(2));
        assert_gradients(&gaussian, &outputs[..4], &[-0.3, 0.2], &[0.5, -1.0, 0.1, 0.7]);
        let squashed = Head::SquashedGaussian(bounds(2));
        assert_gradients(&squashed, &outputs[..8], &[], &[0.5, -0.9, 0.1, 0.7]);
    }

    #[test]
    fn samples_come_as_often_as_they_should() {
        let (head, mut random) = (Head::Categorical { counts: vec![2, 3], start: 0 }, Random::new(2));
        let scores = [0.0, 1.0, 2.0, 0.0, -1.0];
        let mut likelihood = Likelihood::default();
        let mut counts = [[0.0f32; 3]; 2];
        for _ in 0..20_000 {
            likelihood.sample(Isa::best(), &head, &scores, &[], &mut random);
            (0..2).for_each(|axis| counts[axis][likelihood.actions[axis] as usize] += 1.0 / 20_000.0);
        }
        for (axis, scores) in [&scores[..2], &scores[2..]].into_iter().enumerate() {
            let sum: f32 = scores.iter().map(|score| score.exp()).sum();
            for (place, score) in scores.iter().enumerate() {
                assert!((counts[axis][place] - score.exp() / sum).abs() < 0.015, "{counts:?}");
            }
        }
        assert_eq!(choice_at(&[0.0, 0.5, 0.499_999, 0.0], 0.999_999_9), 2);
    }
}
