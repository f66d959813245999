//! Numbers of tests, and their comparison with references in double precision.

/// Returns numbers from -1 to 1.
pub(crate) fn random(length: usize, seed: usize) -> Vec<f32> {
    (0..length).map(|i| ((i * 7919 + seed * 104_729 + i * i % 611) % 2003) as f32 / 1001.0 - 1.0).collect()
}

/// Panics unless each distance is at most `tolerance`, relative to the largest magnitude.
pub(crate) fn assert_near(got: &[f32], wanted: &[f64], tolerance: f64, what: &str) {
    let largest = wanted.iter().fold(1e-3, |largest: f64, value| largest.max(value.abs()));
    for (i, (got, wanted)) in got.iter().zip(wanted).enumerate() {
        let distance = (f64::from(*got) - wanted).abs();
        assert!(distance <= tolerance * largest, "{what}, {i}: {got} in place of {wanted}");
    }
}
