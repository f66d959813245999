/// Stochastic gradient descent with momentum, as in PyTorch's `SGD`: `v = momentum v + g`, `p -= rate v`.
#[derive(Debug, Clone, PartialEq)]
pub struct Momentum {
    momentum: f32,
    /// One value per parameter; part of a checkpoint.
    pub velocity: Vec<f32>,
}

impl Momentum {
    /// Creates an optimiser of this many parameters with zero velocity; `momentum` 0 is plain gradient descent.
    pub fn new(parameters: usize, momentum: f32) -> Self {
        Self { momentum, velocity: vec![0.0; parameters] }
    }

    /// Takes one step at learning rate `rate`.
    ///
    /// # Panics
    /// When the number of parameters or gradients differs from the optimiser's.
    pub fn step(&mut self, rate: f32, parameters: &mut [f32], gradients: &[f32]) {
        assert_eq!(
            parameters.len(),
            self.velocity.len(),
            "`parameters` must have the length of the velocity"
        );
        assert_eq!(gradients.len(), self.velocity.len(), "`gradients` must have the length of the velocity");
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
