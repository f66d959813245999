//! Gaussian distributions with a standard deviation for each axis.

/// ln(2 pi) / 2.
const HALF_LOG_TAU: f32 = 0.918_938_5;

/// The logarithm of the density of `value`; `log_std` are logarithms of the standard deviations.
///
/// # Panics
/// Where the lengths differ.
pub fn gaussian_log_density(mean: &[f32], log_std: &[f32], value: &[f32]) -> f32 {
    assert_eq!([log_std.len(), value.len()], [mean.len(); 2], "axes differ in number");
    let axes = mean.iter().zip(log_std).zip(value);
    axes.map(|((&mean, &log_std), &value)| {
        let z = (value - mean) * (-log_std).exp();
        -0.5 * z * z - log_std - HALF_LOG_TAU
    })
    .sum()
}

/// Writes to `dmean`, and adds to `dlog_std`, the gradient where the loss has the gradient `dlog` by the logarithm of the density.
///
/// # Panics
/// Where the lengths differ.
pub fn gaussian_backward(
    [mean, log_std, value]: [&[f32]; 3],
    dlog: f32,
    dmean: &mut [f32],
    dlog_std: &mut [f32],
) {
    let lengths = [log_std.len(), value.len(), dmean.len(), dlog_std.len()];
    assert_eq!(lengths, [mean.len(); 4], "axes differ in number");
    for i in 0..mean.len() {
        let inverse = (-log_std[i]).exp();
        let z = (value[i] - mean[i]) * inverse;
        dmean[i] = dlog * z * inverse;
        dlog_std[i] += dlog * (z * z - 1.0);
    }
}

/// The entropy, in nats.
pub fn gaussian_entropy(log_std: &[f32]) -> f32 {
    log_std.iter().map(|&log_std| log_std + 0.5 + HALF_LOG_TAU).sum()
}
