//! From scores to probabilities.

/// `exp(x_i) / sum(exp(x))` in place of what `probabilities` held.
pub(crate) fn softmax(scores: &[f32], probabilities: &mut Vec<f32>) {
    let most = scores.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    probabilities.clear();
    probabilities.extend(scores.iter().map(|score| (score - most).exp()));
    let sum: f32 = probabilities.iter().sum();
    probabilities.iter_mut().for_each(|probability| *probability /= sum);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_add_up_however_large_the_scores() {
        let mut probabilities = vec![9.0];
        softmax(&[1000.0, 1000.0 + 2f32.ln(), -1000.0], &mut probabilities);
        assert!((probabilities[0] - 1.0 / 3.0).abs() < 1e-4 && (probabilities[1] - 2.0 / 3.0).abs() < 1e-4);
        assert_eq!(probabilities[2], 0.0);
    }
}
