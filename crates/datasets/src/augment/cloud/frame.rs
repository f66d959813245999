//! Transform between the frame of the points (lidar: x ahead, y left, z up) and that of the boxes (camera: x right,
//! y down, z ahead).

use opendr_engine::data::Calibration;
use opendr_engine::{Error, Result, Value};

/// Transform from the lidar frame to the camera frame: `turn * point + shift`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    turn: [[f64; 3]; 3],
    back: [[f64; 3]; 3],
    shift: [f64; 3],
}

impl Frame {
    /// Transform without a calibration: both frames have one origin, only the axes differ.
    pub(super) const NOMINAL: Self = Self {
        turn: [[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]],
        back: [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
        shift: [0.0; 3],
    };

    /// Returns the transform of a point cloud.
    ///
    /// # Errors
    /// `InvalidInput` for a calibration that is not invertible.
    pub(crate) fn of(datum: &Value) -> Result<Self> {
        match datum {
            Value::PointCloudWithCalibration(both) => Self::calibrated(&both.calibration),
            _ => Ok(Self::NOMINAL),
        }
    }

    fn calibrated(calibration: &Calibration) -> Result<Self> {
        let shift = calibration.camera_from_lidar([0.0; 3]);
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| {
            let place = calibration.camera_from_lidar(axis);
            [0, 1, 2].map(|row| place[row] - shift[row])
        });
        let turn = [0, 1, 2].map(|row| columns.map(|column| column[row]));
        let back = inverse(&turn)
            .ok_or_else(|| Error::invalid_input("the calibration is not invertible; fix its matrices"))?;
        Ok(Self { turn, back, shift })
    }

    pub(super) fn camera_from_lidar(&self, place: [f64; 3]) -> [f64; 3] {
        let turned = times(&self.turn, place);
        [0, 1, 2].map(|axis| turned[axis] + self.shift[axis])
    }

    pub(crate) fn lidar_from_camera(&self, place: [f64; 3]) -> [f64; 3] {
        times(&self.back, [0, 1, 2].map(|axis| place[axis] - self.shift[axis]))
    }

    /// Returns the position of the lidar in the camera frame.
    pub(super) fn lidar(&self) -> [f64; 3] {
        self.shift
    }
}

fn times(matrix: &[[f64; 3]; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    matrix.map(|[a, b, c]| a * x + b * y + c * z)
}

fn inverse(matrix: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let minor = |row: usize, column: usize| {
        let [r0, r1] = [(row + 1) % 3, (row + 2) % 3];
        let [c0, c1] = [(column + 1) % 3, (column + 2) % 3];
        matrix[r0][c0] * matrix[r1][c1] - matrix[r0][c1] * matrix[r1][c0]
    };
    let determinant: f64 = (0..3).map(|column| matrix[0][column] * minor(0, column)).sum();
    (determinant.abs() > 1e-9)
        .then(|| [0, 1, 2].map(|row| [0, 1, 2].map(|column| minor(column, row) / determinant)))
}
