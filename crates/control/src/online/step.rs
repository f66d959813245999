//! One bounded step of the parameters.

/// Moves `parameters` by `factor` times `gradients`, at most `step_limit` far, gives back `leak` of their distance to `base`, and
/// keeps them within `radius` of it.
pub(super) fn bounded_step(
    parameters: &mut [f32],
    base: &[f32],
    gradients: &[f32],
    factor: f32,
    [step_limit, leak, radius]: [f32; 3],
) {
    let length = factor.abs() * norm(gradients.iter().copied());
    let factor = if length > step_limit { factor * step_limit / length } else { factor };
    for ((parameter, base), gradient) in parameters.iter_mut().zip(base).zip(gradients) {
        *parameter += factor * gradient - leak * (*parameter - base);
    }
    let distance = norm(parameters.iter().zip(base).map(|(parameter, base)| parameter - base));
    if distance > radius {
        let kept = radius / distance;
        for (parameter, base) in parameters.iter_mut().zip(base) {
            *parameter = base + kept * (*parameter - base);
        }
    }
}

/// The Euclidean norm.
pub(super) fn norm(numbers: impl Iterator<Item = f32>) -> f32 {
    numbers.map(|number| number * number).sum::<f32>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_distances_are_bounded() {
        let base = [1.0, -1.0, 0.5];
        let mut parameters = base;
        let distance = |parameters: &[f32; 3]| norm(parameters.iter().zip(&base).map(|(a, b)| a - b));
        bounded_step(&mut parameters, &base, &[3.0, 4.0, 0.0], 100.0, [0.1, 0.0, 1.0]);
        assert!((distance(&parameters) - 0.1).abs() < 1e-6);
        (0..100).for_each(|_| bounded_step(&mut parameters, &base, &[3.0, 4.0, 0.0], 100.0, [0.1, 0.0, 1.0]));
        assert!((distance(&parameters) - 1.0).abs() < 1e-5);
        (0..10).for_each(|_| bounded_step(&mut parameters, &base, &[0.0; 3], 1.0, [0.1, 0.5, 1.0]));
        assert!(distance(&parameters) < 2e-3, "it leaks back");
    }
}
