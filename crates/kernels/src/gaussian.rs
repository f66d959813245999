//! Gaussian distributions with a diagonal covariance.

/// ln(2 pi) / 2.
const HALF_LOG_TAU: f32 = 0.918_938_5;

/// Returns the log density of `value`; `log_std` are the logarithms of the standard deviations.
///
/// # Panics
/// When the lengths differ.
pub fn gaussian_log_density(mean: &[f32], log_std: &[f32], value: &[f32]) -> f32 {
    assert_eq!(
        [log_std.len(), value.len()],
        [mean.len(); 2],
        "`log_std` and `value` must have the length of `mean`"
    );
    let axes = mean.iter().zip(log_std).zip(value);
    axes.map(|((&mean, &log_std), &value)| {
        let z = (value - mean) * (-log_std).exp();
        -0.5 * z * z - log_std - HALF_LOG_TAU
    })
    .sum()
}

/// Computes the gradients of `mean` and `log_std` for the gradient `dlog` of the log density; overwrites `dmean` and
/// adds to `dlog_std`.
///
/// # Panics
/// When the lengths differ.
pub fn gaussian_backward(
    [mean, log_std, value]: [&[f32]; 3],
    dlog: f32,
    dmean: &mut [f32],
    dlog_std: &mut [f32],
) {
    let lengths = [log_std.len(), value.len(), dmean.len(), dlog_std.len()];
    assert_eq!(lengths, [mean.len(); 4], "all slices must have the length of `mean`");
    for i in 0..mean.len() {
        let inverse = (-log_std[i]).exp();
        let z = (value[i] - mean[i]) * inverse;
        dmean[i] = dlog * z * inverse;
        dlog_std[i] += dlog * (z * z - 1.0);
    }
}

/// Returns the entropy, in nats.
pub fn gaussian_entropy(log_std: &[f32]) -> f32 {
    log_std.iter().map(|&log_std| log_std + 0.5 + HALF_LOG_TAU).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(mean: &[f64], log_std: &[f64], value: &[f64]) -> f64 {
        let axes = mean.iter().zip(log_std).zip(value);
        axes.map(|((mean, log_std), value)| {
            let z = (value - mean) / log_std.exp();
            -0.5 * z * z - log_std - 0.5 * std::f64::consts::TAU.ln()
        })
        .sum()
    }

    #[test]
    fn density_and_gradients() {
        let (mean, log_std, value) = ([0.5f32, -1.0], [-0.5f32, 0.25], [0.1f32, 2.0]);
        let [m, s, v] = [mean, log_std, value].map(|axes| axes.map(f64::from));
        let density = gaussian_log_density(&mean, &log_std, &value);
        assert!((f64::from(density) - exact(&m, &s, &v)).abs() < 1e-6, "{density}");
        let (mut dmean, mut dlog_std) = ([9.0; 2], [1.0; 2]);
        gaussian_backward([&mean, &log_std, &value], 2.0, &mut dmean, &mut dlog_std);
        for axis in [0, 1] {
            let moved = |from: [f64; 2], by: f64| {
                let mut to = from;
                to[axis] += by;
                to
            };
            let by_mean = exact(&moved(m, 1e-5), &s, &v) - exact(&moved(m, -1e-5), &s, &v);
            let by_std = exact(&m, &moved(s, 1e-5), &v) - exact(&m, &moved(s, -1e-5), &v);
            assert!((f64::from(dmean[axis]) - by_mean / 1e-5).abs() < 1e-5, "{dmean:?}");
            assert!((f64::from(dlog_std[axis]) - 1.0 - by_std / 1e-5).abs() < 1e-5, "{dlog_std:?}");
        }
    }

    #[test]
    fn entropy_of_the_unit_distribution() {
        let exact = 0.5 * (std::f64::consts::TAU * std::f64::consts::E).ln();
        assert!((f64::from(gaussian_entropy(&[0.0, 0.0])) - 2.0 * exact).abs() < 1e-6);
    }
}
