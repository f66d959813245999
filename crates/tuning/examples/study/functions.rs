//! Functions with a known minimum.

use std::f64::consts::PI;

use opendr_engine::Result;
use opendr_tuning::Trial;

/// Evaluates Branin's function; minimum 0.397887 at three points.
pub fn branin(trial: &Trial<'_>) -> Result<f64> {
    let (x, y) = (trial.float("x")?, trial.float("y")?);
    let valley = y - 5.1 / (4.0 * PI * PI) * x * x + 5.0 / PI * x - 6.0;
    Ok(valley * valley + 10.0 * (1.0 - 1.0 / (8.0 * PI)) * x.cos() + 10.0)
}

const WEIGHTS: [f64; 4] = [1.0, 1.2, 3.0, 3.2];
const SCALES: [[f64; 6]; 4] = [
    [10.0, 3.0, 17.0, 3.5, 1.7, 8.0],
    [0.05, 10.0, 17.0, 0.1, 8.0, 14.0],
    [3.0, 3.5, 1.7, 10.0, 17.0, 8.0],
    [17.0, 8.0, 0.05, 10.0, 0.1, 14.0],
];
/// In ten-thousandths.
const CENTRES: [[f64; 6]; 4] = [
    [1312.0, 1696.0, 5569.0, 124.0, 8283.0, 5886.0],
    [2329.0, 4135.0, 8307.0, 3736.0, 1004.0, 9991.0],
    [2348.0, 1451.0, 3522.0, 2883.0, 3047.0, 6650.0],
    [4047.0, 8828.0, 8732.0, 5743.0, 1091.0, 381.0],
];

/// Evaluates Hartmann's function with six axes; minimum -3.32237.
pub fn hartmann6(trial: &Trial<'_>) -> Result<f64> {
    let x = places::<6>(trial)?;
    let peak = |at: usize| {
        let square = |axis: usize| SCALES[at][axis] * (x[axis] - 1e-4 * CENTRES[at][axis]).powi(2);
        WEIGHTS[at] * (-(0..6).map(square).sum::<f64>()).exp()
    };
    Ok(-(0..4).map(peak).sum::<f64>())
}

/// Evaluates Rosenbrock's function with five axes; minimum 0 where all are 1.
pub fn rosenbrock5(trial: &Trial<'_>) -> Result<f64> {
    let x = places::<5>(trial)?;
    Ok((0..4).map(|at| 100.0 * (x[at + 1] - x[at] * x[at]).powi(2) + (1.0 - x[at]).powi(2)).sum())
}

/// Resembles a training: minimum 0 at a learning rate of 10^-3.5, batches of 256, a discount of 0.99 and Adam.
pub fn mixed(trial: &Trial<'_>) -> Result<f64> {
    let (lr, batch, gamma) = (trial.float("lr")?, trial.float("batch")?, trial.float("gamma")?);
    let bowl = (lr.log10() + 3.5).powi(2)
        + (batch.log2() - 8.0).powi(2) / 4.0
        + ((1.0 - gamma).log10() + 2.0).powi(2);
    Ok(match trial.get::<String>("optimizer")?.as_str() {
        "sgd" => bowl + 1.0 + trial.float("momentum")?,
        "adam" => bowl,
        _ => bowl + 0.5,
    })
}

fn places<const N: usize>(trial: &Trial<'_>) -> Result<[f64; N]> {
    let mut places = [0.0; N];
    for (at, place) in places.iter_mut().enumerate() {
        *place = trial.float(&format!("x{at}"))?;
    }
    Ok(places)
}
