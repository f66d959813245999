//! Compares a trajectory with the truth and prints the errors as JSON.
//!
//! `cargo run -p opendr-odometry --example trajectory_errors -- (tum|kitti) TRUTH ESTIMATE [STEP [LENGTH ..]]`; STEP is the number of poses of
//! relative errors (1), LENGTH those of KITTI's pieces in metres.

use opendr_engine::{Error, Result};
use opendr_odometry::{Alignment, Trajectory, absolute_errors, kitti_drift, relative_errors};
use serde_json::json;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [format, truth, estimate, rest @ ..] = arguments.as_slice() else {
        return Err(Error::invalid_input("give the format (tum or kitti) and two files"));
    };
    let read = |path: &String| {
        let text = std::fs::read_to_string(path)?;
        if format == "kitti" { Trajectory::from_kitti(&text, 10.0) } else { Trajectory::from_tum(&text) }
    };
    let (truth, estimate) = (read(truth)?, read(estimate)?);
    let (truth, estimate) = truth.associated(&estimate, 0.01)?;
    let number =
        |text: &String| text.parse::<f64>().map_err(|_| Error::invalid_input(format!("{text} is no number")));
    let numbers = rest.iter().map(number).collect::<Result<Vec<f64>>>()?;
    let step = numbers.first().map_or(1, |step| *step as usize);
    let absolute = |alignment| {
        absolute_errors(&truth, &estimate, alignment).map(|errors| {
        json!({"rmse": errors.rmse, "mean": errors.mean, "median": errors.median, "max": errors.largest})
    })
    };
    let relative = relative_errors(&truth, &estimate, step)?;
    let drift = match numbers.get(1..) {
        Some(lengths @ [_, ..]) => {
            let drift = kitti_drift(&truth, &estimate, lengths)?;
            json!({"translation": drift.translation, "rotation": drift.rotation, "pieces": drift.pieces})
        }
        _ => json!(null),
    };
    let report = json!({
        "ape": {
            "none": absolute(Alignment::None)?,
            "rigid": absolute(Alignment::Rigid)?,
            "scaled": absolute(Alignment::Scaled)?,
        },
        "rpe": {"translation": relative.translation.rmse, "rotation": relative.rotation.rmse.to_degrees()},
        "drift": drift,
    });
    println!("{report}");
    Ok(())
}
