/// Stochastic gradient descent with momentum, as PyTorch's `SGD`: `v = momentum v + g`, `p -= rate v`.
#[derive(Debug, Clone, PartialEq)]
pub struct Momentum {
    momentum: f32,
    /// One number for each parameter; save and restore them with the parameters.
    pub velocity: Vec<f32>,
}

impl Momentum {
    /// An optimiser of this many parameters, at rest; `momentum` 0 is plain gradient descent.
    pub fn new(parameters: usize, momentum: f32) -> Self {
        Self { momentum, velocity: vec![0.0; parameters] }
    }

    /// One step at learning rate `rate`.
    ///
    /// # Panics
    /// Where there are more or fewer parameters or gradients than the optimiser was made for.
    pub fn step(&mut self, rate: f32, parameters: &mut [f32], gradients: &[f32]) {
        assert_eq!(parameters.len(), self.velocity.len(), "parameters of another network");
        assert_eq!(gradients.len(), self.velocity.len(), "gradients of another network");
        let both = parameters.iter_mut().zip(&mut self.velocity);
        for ((parameter, velocity), &gradient) in both.zip(gradients) {
            *velocity = self.momentum * *velocity + gradient;
            *parameter -= rate * *velocity;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocity_builds_up() {
        let mut optimizer = Momentum::new(1, 0.5);
        let mut p = [1.0];
        optimizer.step(0.1, &mut p, &[1.0]);
        assert_eq!(p, [0.9]);
        optimizer.step(0.1, &mut p, &[1.0]);
        assert!((p[0] - 0.75).abs() < 1e-7, "{p:?}");
    }
}
