//! Calibration files with checks, since a wrong calibration misplaces every object.

use std::fmt::Write as _;
use std::path::Path;

use opendr_engine::data::Calibration;
use opendr_engine::{Header, Result};

use crate::Problem;
use crate::fields::lines;
use crate::folder::read_text;

/// Largest deviation of the rows of a rotation from unit length and right angles.
const ROTATION_TOLERANCE: f64 = 1e-3;

/// Reads and checks the calibration at `path`.
///
/// # Errors
/// `NotFound` or `Io` if it cannot be read; otherwise as [`calibration_from_kitti`].
pub fn open_kitti_calibration(path: impl AsRef<Path>) -> Result<Calibration> {
    let path = path.as_ref();
    calibration_from_kitti(&read_text(path)?, path)
}

/// Parses a calibration of the detection or tracking benchmark; `path` is used in errors.
///
/// Each matrix must have the right number of finite values. Rotations are checked for right angles, unit lengths
/// and a positive determinant, the projection for positive focal lengths.
///
/// # Errors
/// `Format` with file and line, or the missing matrix.
pub fn calibration_from_kitti(text: &str, path: &Path) -> Result<Calibration> {
    let (mut p2, mut r0_rect, mut tr_velo_to_cam) = (None, None, None);
    for (number, line) in lines(text) {
        let problem = |message: String| Problem::at_line(path, number, message);
        let mut words = line.split_whitespace();
        let name = words.next().unwrap_or_default().trim_end_matches(':');
        let twelve = |words| numbers::<12>(name, words).map(|flat| rows::<4, 12>(&flat));
        match name {
            "P0" | "P1" | "P2" | "P3" => {
                let matrix =
                    twelve(words).and_then(|matrix| check_projection(name, matrix)).map_err(problem)?;
                p2 = if name == "P2" { Some(matrix) } else { p2 };
            }
            "R0_rect" | "R_rect" => {
                let matrix = numbers::<9>(name, words).map(|flat| rows::<3, 9>(&flat));
                r0_rect = Some(matrix.and_then(|matrix| check_rotation(name, matrix)).map_err(problem)?);
            }
            "Tr_velo_to_cam" | "Tr_velo_cam" | "Tr_imu_to_velo" | "Tr_imu_velo" => {
                let matrix = twelve(words).map_err(problem)?;
                let turned = matrix.map(|[a, b, c, _]| [a, b, c]);
                check_rotation(name, turned).map_err(problem)?;
                tr_velo_to_cam = if name.starts_with("Tr_velo") { Some(matrix) } else { tr_velo_to_cam };
            }
            _ => {}
        }
    }
    let missing =
        |name: &str| Problem::at_key(path, name, "this matrix is missing; use a complete KITTI calibration");
    Ok(Calibration {
        header: Header::default(),
        p2: p2.ok_or_else(|| missing("P2"))?,
        r0_rect: r0_rect.ok_or_else(|| missing("R0_rect"))?,
        tr_velo_to_cam: tr_velo_to_cam.ok_or_else(|| missing("Tr_velo_to_cam"))?,
    })
}

fn numbers<'a, const N: usize>(name: &str, words: impl Iterator<Item = &'a str>) -> Result<[f64; N], String> {
    let mut numbers = [0.0; N];
    let mut count = 0;
    for word in words {
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        let number = number.ok_or_else(|| format!("{name} has {word:.40?} instead of a finite number"))?;
        numbers.get_mut(count).into_iter().for_each(|place| *place = number);
        count += 1;
    }
    if count == N { Ok(numbers) } else { Err(format!("{name} has {count} numbers instead of {N}")) }
}

fn rows<const C: usize, const N: usize>(flat: &[f64; N]) -> [[f64; C]; 3] {
    std::array::from_fn(|row| std::array::from_fn(|column| flat[row * C + column]))
}

fn check_rotation(name: &str, matrix: [[f64; 3]; 3]) -> Result<[[f64; 3]; 3], String> {
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let [x, y, z] = matrix;
    let cross = [y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0]];
    let determinant = dot(x, cross);
    if determinant.abs() < ROTATION_TOLERANCE {
        return Err(format!(
            "{name} is singular (determinant {determinant:.2e}), not a rotation; calibrate again"
        ));
    }
    let lengths = [dot(x, x) - 1.0, dot(y, y) - 1.0, dot(z, z) - 1.0];
    let angles = [dot(x, y), dot(y, z), dot(z, x)];
    let worst = lengths.iter().chain(&angles).fold(0f64, |worst, error| worst.max(error.abs()));
    if worst > ROTATION_TOLERANCE || determinant < 0.0 {
        return Err(format!(
            "{name} is not a rotation (error {worst:.2e}, determinant {determinant:.3}); calibrate again"
        ));
    }
    Ok(matrix)
}

fn check_projection(name: &str, matrix: [[f64; 4]; 3]) -> Result<[[f64; 4]; 3], String> {
    let ([fx, ..], [_, fy, ..], [.., depth, _]) = (matrix[0], matrix[1], matrix[2]);
    if fx > 0.0 && fy > 0.0 && depth > 0.0 {
        return Ok(matrix);
    }
    Err(format!(
        "{name} has focal lengths {fx} and {fy} and depth scale {depth}, which must be positive; calibrate again"
    ))
}

/// Converts a calibration to KITTI's text: all four cameras have the projection of the second, and the IMU has the
/// identity.
pub fn kitti_from_calibration(calibration: &Calibration) -> String {
    let mut text = String::new();
    let mut line = |name: &str, numbers: &mut dyn Iterator<Item = f64>| {
        let numbers: Vec<_> = numbers.map(|number| format!("{number:e}")).collect();
        // Writing to a String cannot fail.
        writeln!(text, "{name}: {}", numbers.join(" ")).ok();
    };
    for name in ["P0", "P1", "P2", "P3"] {
        line(name, &mut calibration.p2.into_iter().flatten());
    }
    line("R0_rect", &mut calibration.r0_rect.into_iter().flatten());
    line("Tr_velo_to_cam", &mut calibration.tr_velo_to_cam.into_iter().flatten());
    let identity = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    line("Tr_imu_to_velo", &mut identity.into_iter());
    text
}
