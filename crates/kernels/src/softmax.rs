//! Categorical distributions from scores, row by row.

use crate::elementary::exp_in_place;
use crate::isa::Isa;

/// Writes logarithms of probabilities, and probabilities, of rows of `columns` scores.
///
/// # Panics
/// Where the lengths differ, or are no whole number of rows.
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

/// The gradient of the scores from that of the logarithms of probabilities: `dx = d - p sum(d)`.
///
/// # Panics
/// Where the lengths differ, or are no whole number of rows.
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

/// The entropy of a row, in nats: impossible outcomes count nothing.
pub fn entropy(log_probabilities: &[f32], probabilities: &[f32]) -> f32 {
    let terms = log_probabilities.iter().zip(probabilities);
    -terms.map(|(&log, &p)| if p > 0.0 { p * log } else { 0.0 }).sum::<f32>()
}

/// The gradient of the scores of a row where the loss has the gradient `dlog` by the logarithm of the probability of `chosen`,
/// and `dentropy` by the entropy: what a policy gradient needs.
///
/// # Panics
/// Where the lengths differ, or `chosen` is no outcome.
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

/// The mean cross-entropy of rows of scores against the true outcomes, and its gradient by the scores.
///
/// # Panics
/// Where the lengths do not fit, or a target is no outcome.
pub fn cross_entropy(
    isa: Isa,
    scores: &[f32],
    columns: usize,
    targets: &[usize],
    log_probabilities: &mut [f32],
    dscores: &mut [f32],
) -> f32 {
    assert_eq!(targets.len() * columns, scores.len(), "one target for each row");
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
    assert_eq!(lengths, [lengths[0]; N], "lengths differ");
    assert!(columns > 0 && lengths[0].is_multiple_of(columns), "no rows of {columns}: {lengths:?}");
}
