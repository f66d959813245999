//! Gradients against finite differences.

use super::*;

pub(crate) fn numbers(count: usize, seed: u64) -> Vec<f32> {
    let mut random = Random::new(seed);
    (0..count).map(|_| random.uniform(-1.0, 1.0)).collect()
}

/// Checks directional derivatives of `loss` at `at` against `gradient`, in single precision: along random directions.
pub(crate) fn assert_directions(
    what: &str,
    at: &[f32],
    gradient: &[f32],
    mut loss: impl FnMut(&[f32]) -> f64,
) {
    for seed in 0..6 {
        let direction = numbers(at.len(), 100 + seed);
        let step = 2e-3 / (at.len() as f32).sqrt();
        let mut moved = |by: f32| {
            let at: Vec<f32> = at.iter().zip(&direction).map(|(at, along)| at + by * along).collect();
            loss(&at)
        };
        // Richardson's extrapolation removes the error of the second order.
        let slope =
            |moved: &mut dyn FnMut(f32) -> f64, by: f32| (moved(by) - moved(-by)) / f64::from(2.0 * by);
        let coarse = slope(&mut moved, 4.0 * step);
        let fine = slope(&mut moved, 2.0 * step);
        let difference = (4.0 * fine - coarse) / 3.0;
        let product = gradient.iter().zip(&direction).map(|(a, b)| f64::from(a * b));
        let product: f64 = product.sum();
        let scale = gradient.iter().map(|g| f64::from(g * g)).sum::<f64>().sqrt();
        assert!((product - difference).abs() < 0.02 * scale.max(1e-3), "{what}: {product}, not {difference}");
    }
}

#[test]
fn encoders_and_decoders_have_the_gradients_of_their_outputs() {
    let sizes = TransformerSizes { size: 8, heads: 2, hidden: 12, layers: 2 };
    let (compute, batch, tokens, lengths) = (Compute::single(), 2, 3, [3, 2]);
    for decodes in [false, true] {
        let network = Transformer::new(sizes, decodes).unwrap();
        let mut parameters = vec![0.0; network.parameters()];
        network.initialise(&mut Random::new(1), &mut parameters);
        let (x, values) = (numbers(batch * tokens * 8, 2), numbers(batch * 4 * 8, 3));
        let weights = numbers(x.len(), 4);
        let run = |p: &[f32], x: &[f32], values: &[f32], tape: &mut TransformerTape| {
            let mut y = x.to_vec();
            let sequences = Sequences { queries: tokens, keys: tokens, lengths: Some(&lengths) };
            let memory = decodes.then_some(Memory { values, tokens: 4 });
            network.forward(&compute, p, &mut y, sequences, memory, tape);
            y.iter().zip(&weights).map(|(y, weight)| f64::from(*y) * f64::from(*weight)).sum::<f64>()
        };
        let mut tape = TransformerTape::default();
        run(&parameters, &x, &values, &mut tape);
        let (mut dx, mut gradients) = (weights.clone(), vec![0.0; parameters.len()]);
        let mut dmemory = vec![0.0; values.len()];
        let memory = decodes.then_some((Memory { values: &values, tokens: 4 }, &mut dmemory[..]));
        network.backward(&compute, &parameters, &mut dx, memory, &mut tape, &mut gradients);
        let mut scratch = TransformerTape::default();
        assert_directions("parameters", &parameters, &gradients, |p| run(p, &x, &values, &mut scratch));
        assert_directions("tokens", &x, &dx, |x| run(&parameters, x, &values, &mut scratch));
        assert_directions("memory", &values, &dmemory, |v| run(&parameters, &x, v, &mut scratch));
    }
}
