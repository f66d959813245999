//! Softmax, categorical distributions and cross-entropy, row by row.

use crate::elementary::exp_in_place;
use crate::isa::Isa;

/// Writes log-probabilities and probabilities of rows of `columns` scores.
///
/// # Panics
/// When the lengths differ, or are not a multiple of `columns`.
pub fn log_softmax(
    isa: Isa,
    scores: &[f32],
    columns: usize,
    log_probabilities: &mut [f32],
    probabilities: &mut [f32],
) {
    check(columns, [scores.len(), log_probabilities.len(), probabilities.len()]);
    let rows = scores.chunks_exact(columns).zip(log_probabilities.chunks_exact_mut(columns));
    for (scores, shifted) in rows {
        let largest = scores.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        for (shifted, &score) in shifted.iter_mut().zip(scores) {
            *shifted = score - largest;
        }
    }
    probabilities.copy_from_slice(log_probabilities);
    exp_in_place(isa, probabilities);
    let rows = log_probabilities.chunks_exact_mut(columns).zip(probabilities.chunks_exact_mut(columns));
    for (logs, probabilities) in rows {
        let sum: f32 = probabilities.iter().sum();
        let log_sum = sum.ln();
        logs.iter_mut().for_each(|log| *log -= log_sum);
        probabilities.iter_mut().for_each(|probability| *probability /= sum);
    }
}

/// Computes the gradient of the scores from that of the log-probabilities: `dx = d - p sum(d)`.
///
/// # Panics
/// When the lengths differ, or are not a multiple of `columns`.
pub fn log_softmax_backward(probabilities: &[f32], columns: usize, dlogs: &[f32], dscores: &mut [f32]) {
    check(columns, [probabilities.len(), dlogs.len(), dscores.len()]);
    let rows = probabilities.chunks_exact(columns).zip(dlogs.chunks_exact(columns));
    for ((probabilities, dlogs), dscores) in rows.zip(dscores.chunks_exact_mut(columns)) {
        let sum: f32 = dlogs.iter().sum();
        for ((dscore, &dlog), &probability) in dscores.iter_mut().zip(dlogs).zip(probabilities) {
            *dscore = dlog - probability * sum;
        }
    }
}

/// Returns the entropy of a row, in nats; outcomes of probability 0 contribute 0.
pub fn entropy(log_probabilities: &[f32], probabilities: &[f32]) -> f32 {
    let terms = log_probabilities.iter().zip(probabilities);
    -terms.map(|(&log, &p)| if p > 0.0 { p * log } else { 0.0 }).sum::<f32>()
}

/// Computes the gradient of the scores of a row, for the gradient `dlog` of the log-probability of `chosen` and
/// `dentropy` of the entropy, as in a policy gradient.
///
/// # Panics
/// When the lengths differ, or `chosen` is not a column.
pub fn categorical_backward(
    log_probabilities: &[f32],
    probabilities: &[f32],
    chosen: usize,
    [dlog, dentropy]: [f32; 2],
    dscores: &mut [f32],
) {
    check(dscores.len(), [log_probabilities.len(), probabilities.len()]);
    let entropy = entropy(log_probabilities, probabilities);
    for ((dscore, &log), &p) in dscores.iter_mut().zip(log_probabilities).zip(probabilities) {
        let surprise = if p > 0.0 { p * (log + entropy) } else { 0.0 };
        *dscore = -dlog * p - dentropy * surprise;
    }
    dscores[chosen] += dlog;
}

/// Returns the mean cross-entropy of rows of scores and target classes, and computes its gradient by the scores.
///
/// # Panics
/// When the lengths do not match, or a target is not a column.
pub fn cross_entropy(
    isa: Isa,
    scores: &[f32],
    columns: usize,
    targets: &[usize],
    log_probabilities: &mut [f32],
    dscores: &mut [f32],
) -> f32 {
    assert_eq!(targets.len() * columns, scores.len(), "there must be one target per row");
    log_softmax(isa, scores, columns, log_probabilities, dscores);
    let scale = 1.0 / targets.len().max(1) as f32;
    let mut loss = 0.0;
    let rows = log_probabilities.chunks_exact(columns).zip(dscores.chunks_exact_mut(columns));
    for ((logs, dscores), &target) in rows.zip(targets) {
        loss -= f64::from(logs[target]);
        dscores[target] -= 1.0;
        dscores.iter_mut().for_each(|dscore| *dscore *= scale);
    }
    (loss * f64::from(scale)) as f32
}

fn check<const N: usize>(columns: usize, lengths: [usize; N]) {
    assert_eq!(lengths, [lengths[0]; N], "all slices must have equal lengths");
    assert!(
        columns > 0 && lengths[0].is_multiple_of(columns),
        "the lengths must be multiples of {columns} columns: {lengths:?}"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact_logs(scores: &[f64]) -> Vec<f64> {
        let largest = scores.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = scores.iter().map(|score| (score - largest).exp()).sum();
        scores.iter().map(|score| score - largest - sum.ln()).collect()
    }

    /// Compares a gradient at `at` with central differences of `loss`.
    fn assert_gradient(at: &[f32], gradient: &[f32], loss: impl Fn(&[f64]) -> f64) {
        let at: Vec<f64> = at.iter().map(|&at| f64::from(at)).collect();
        for (index, &gradient) in gradient.iter().enumerate() {
            let moved = |by: f64| {
                let mut at = at.clone();
                at[index] += by;
                loss(&at)
            };
            let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!((f64::from(gradient) - difference).abs() < 1e-6, "{index}: {gradient}, not {difference}");
        }
    }

    const SCORES: [f32; 6] = [0.3, -1.2, 2.0, 5.0, 5.0, -40.0];

    #[test]
    fn large_and_small_scores_stay_finite() {
        for isa in Isa::available() {
            let (mut logs, mut probabilities) = ([0.0; 6], [0.0; 6]);
            log_softmax(isa, &[1e30, 0.0, -1e30, -3e38, 3e38, 0.0], 3, &mut logs, &mut probabilities);
            assert_eq!(probabilities, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
            assert_eq!([logs[0], logs[4]], [0.0, 0.0]);
            assert!((entropy(&logs[..3], &probabilities[..3])).abs() < 1e-9);
        }
    }

    #[test]
    fn cross_entropy_and_its_gradient() {
        let targets = [2, 0];
        let exact = |scores: &[f64]| {
            let rows = scores.chunks(3).zip(targets);
            rows.map(|(scores, target)| -exact_logs(scores)[target]).sum::<f64>() / 2.0
        };
        for isa in Isa::available() {
            let (mut logs, mut dscores) = ([0.0; 6], [0.0; 6]);
            let loss = cross_entropy(isa, &SCORES, 3, &targets, &mut logs, &mut dscores);
            assert!((f64::from(loss) - exact(&SCORES.map(f64::from))).abs() < 1e-6, "{loss}");
            assert_gradient(&SCORES, &dscores, exact);
        }
    }

    #[test]
    fn gradients_of_the_logs() {
        let (mut logs, mut probabilities, mut dscores) = ([0.0; 6], [0.0; 6], [0.0; 6]);
        log_softmax(Isa::best(), &SCORES, 6, &mut logs, &mut probabilities);
        let weights = [0.5, -1.0, 2.0, 0.0, 0.25, 0.75];
        log_softmax_backward(&probabilities, 6, &weights, &mut dscores);
        assert_gradient(&SCORES, &dscores, |scores| {
            exact_logs(scores).iter().zip(weights).map(|(log, weight)| log * f64::from(weight)).sum()
        });
    }

    #[test]
    fn gradients_of_a_policy() {
        let (mut logs, mut probabilities, mut dscores) = ([0.0; 6], [0.0; 6], [0.0; 6]);
        log_softmax(Isa::best(), &SCORES, 6, &mut logs, &mut probabilities);
        categorical_backward(&logs, &probabilities, 4, [1.5, -0.5], &mut dscores);
        assert_gradient(&SCORES, &dscores, |scores| {
            let logs = exact_logs(scores);
            let entropy = -logs.iter().map(|log| log.exp() * log).sum::<f64>();
            1.5 * logs[4] - 0.5 * entropy
        });
    }
}
