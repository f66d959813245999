//! Generalised advantage estimation.

/// Steps of several environments, ordered by step, then by environment.
#[derive(Debug, Clone, Copy)]
pub struct Trajectory<'a> {
    /// Rewards, including the discounted value of the last observation where an episode was truncated.
    pub rewards: &'a [f32],
    /// Predicted value of each observation.
    pub values: &'a [f32],
    /// Whether the step ended its episode.
    pub ends: &'a [bool],
    /// Predicted values of the observations after the last step, one per environment.
    pub last_values: &'a [f32],
}

/// Computes generalised advantage estimates (Schulman et al., 2016, Eq. 16): temporal differences discounted by
/// `gamma` times `lambda`, summed up to the end of the episode.
///
/// # Panics
/// If the lengths do not match.
pub fn generalised_advantages(trajectory: Trajectory<'_>, gamma: f32, lambda: f32, advantages: &mut [f32]) {
    let Trajectory { rewards, values, ends, last_values } = trajectory;
    let (total, environments) = (rewards.len(), last_values.len());
    assert_eq!([values.len(), ends.len(), advantages.len()], [total; 3], "slices of different lengths");
    assert!(
        environments > 0 && total.is_multiple_of(environments),
        "not a whole number of steps of all environments"
    );
    for at in (0..total).rev() {
        let next = at + environments;
        let (next_value, next_advantage) = match next < total {
            true => (values[next], advantages[next]),
            false => (last_values[next - total], 0.0),
        };
        let discount = if ends[at] { 0.0 } else { gamma };
        let difference = rewards[at] + discount * next_value - values[at];
        advantages[at] = difference + discount * lambda * next_advantage;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with the sum of the definition, up to the end of the episode or of the steps.
    #[test]
    fn equals_the_sum_of_differences() {
        let (gamma, lambda) = (0.9, 0.8);
        let rewards = [1.0, -2.0, 0.5, 3.0, 1.0, 0.25, -1.0, 2.0];
        let values = [0.3, 0.1, -0.2, 0.4, 0.7, -0.6, 0.2, 0.9];
        let ends = [false, false, false, true, true, false, false, false];
        let last_values = [0.5, -0.5];
        let mut advantages = [0.0; 8];
        let trajectory =
            Trajectory { rewards: &rewards, values: &values, ends: &ends, last_values: &last_values };
        generalised_advantages(trajectory, gamma, lambda, &mut advantages);
        for environment in 0..2 {
            for from in 0..4 {
                let (mut sum, mut factor) = (0.0f32, 1.0);
                for step in from..4 {
                    let at = 2 * step + environment;
                    let next = if step == 3 { last_values[environment] } else { values[at + 2] };
                    let next = if ends[at] { 0.0 } else { next };
                    sum += factor * (rewards[at] + gamma * next - values[at]);
                    factor *= gamma * lambda;
                    if ends[at] {
                        break;
                    }
                }
                let got = advantages[2 * from + environment];
                assert!((got - sum).abs() < 1e-6, "{environment} {from}: {got} {sum}");
            }
        }
    }
}
