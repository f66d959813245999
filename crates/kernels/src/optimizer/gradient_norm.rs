/// Returns the Euclidean norm of the gradients, summed in double precision in an order that depends on their number
/// only.
pub fn gradient_norm(gradients: &[f32]) -> f64 {
    let mut lanes = [0.0; 8];
    let chunks = gradients.chunks_exact(8);
    let rest: f64 = chunks.remainder().iter().map(|&g| f64::from(g) * f64::from(g)).sum();
    for chunk in chunks {
        for (lane, &gradient) in lanes.iter_mut().zip(chunk) {
            *lane += f64::from(gradient) * f64::from(gradient);
        }
    }
    (lanes.iter().sum::<f64>() + rest).sqrt()
}

/// Scales the gradients of all parts of a model by one factor, so that their norm is at most `max_norm`, and returns
/// the norm before.
///
/// The factor is that of PyTorch's `clip_grad_norm_`: `max_norm / (norm + 1e-6)`, at most 1. A norm that is not
/// finite leaves no finite gradient; check the returned norm to skip such a step.
pub fn clip_gradient_norm(parts: &mut [&mut [f32]], max_norm: f32) -> f32 {
    let squares: f64 = parts.iter().map(|part| gradient_norm(part).powi(2)).sum();
    let norm = squares.sqrt();
    let factor = f64::from(max_norm) / (norm + 1e-6);
    if factor < 1.0 || factor.is_nan() {
        for gradient in parts.iter_mut().flat_map(|part| part.iter_mut()) {
            *gradient *= factor as f32;
        }
    }
    norm as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clips_all_parts_by_one_factor() {
        let (mut a, mut b) = ([3.0, 0.0], [4.0]);
        assert_eq!(clip_gradient_norm(&mut [&mut a, &mut b], 10.0), 5.0);
        assert_eq!((a, b), ([3.0, 0.0], [4.0]));
        assert_eq!(clip_gradient_norm(&mut [&mut a, &mut b], 1.0), 5.0);
        assert!((a[0] - 0.6).abs() < 1e-6 && (b[0] - 0.8).abs() < 1e-6, "{a:?} {b:?}");
    }

    #[test]
    fn a_large_gradient_does_not_overflow() {
        assert_eq!(gradient_norm(&[1e30; 4]) as f32, 2e30);
    }

    #[test]
    fn nan_norm_is_returned() {
        let mut a = [1.0, f32::NAN];
        assert!(clip_gradient_norm(&mut [&mut a], 1.0).is_nan());
        assert!(a[0].is_nan());
    }
}
