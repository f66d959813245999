//! Calibration of a lidar and a camera, as in KITTI.

use std::fmt;

use crate::data::Data;
use crate::numpy_text::{Number, array_repr};
use crate::{Error, Header, Result};

/// Calibration of a lidar and a camera: the transform from lidar to camera, and the projection to pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Header of the camera.
    pub header: Header,
    /// Projection from the rectified camera frame to the left colour image (KITTI's `P2`).
    pub p2: [[f64; 4]; 3],
    /// Rectification rotation (KITTI's `R0_rect`).
    pub r0_rect: [[f64; 3]; 3],
    /// Transform from the lidar's to the camera's frame (KITTI's `Tr_velo_to_cam`), in metres.
    pub tr_velo_to_cam: [[f64; 4]; 3],
}

impl Calibration {
    /// Creates a calibration for point clouds without one: lidar and camera at one position, with the focal length and
    /// centre of KITTI's images of 1242 x 375 pixels.
    pub fn nominal() -> Self {
        Self {
            header: Header::default(),
            p2: [[721.5, 0.0, 609.6, 0.0], [0.0, 721.5, 172.9, 0.0], [0.0, 0.0, 1.0, 0.0]],
            r0_rect: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            tr_velo_to_cam: [[0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [1.0, 0.0, 0.0, 0.0]],
        }
    }

    /// Parses a calibration file of KITTI's detection or tracking benchmark.
    ///
    /// # Errors
    /// Returns `Format` with the line number, or the name of a missing matrix.
    pub fn from_kitti_text(text: &str) -> Result<Self> {
        let (mut p2, mut r0_rect, mut tr_velo_to_cam) = (None, None, None);
        for (index, line) in text.lines().enumerate() {
            let mut fields = line.split_ascii_whitespace();
            let matrix = match fields.next().unwrap_or_default().trim_end_matches(':') {
                "P2" => &mut p2,
                "R0_rect" | "R_rect" => &mut r0_rect,
                "Tr_velo_to_cam" | "Tr_velo_cam" => &mut tr_velo_to_cam,
                _ => continue,
            };
            let numbers: Option<Vec<f64>> =
                fields.map(|field| field.parse().ok().filter(|number: &f64| number.is_finite())).collect();
            let numbers = numbers.ok_or_else(|| {
                Error::format(format!(
                    "line {} has fields that are not finite numbers; fix the file",
                    index + 1
                ))
            })?;
            *matrix = Some((index + 1, numbers));
        }
        Ok(Self {
            header: Header::default(),
            p2: rows("P2", p2)?,
            r0_rect: rows("R0_rect", r0_rect)?,
            tr_velo_to_cam: rows("Tr_velo_to_cam", tr_velo_to_cam)?,
        })
    }

    /// Transforms a point from the lidar's frame to the rectified camera frame (x right, y down, z forward), in metres.
    pub fn camera_from_lidar(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let rotated = self.tr_velo_to_cam.map(|[a, b, c, d]| a * x + b * y + c * z + d);
        let [x, y, z] = rotated;
        self.r0_rect.map(|[a, b, c]| a * x + b * y + c * z)
    }

    /// Projects a point of the rectified camera frame to a pixel `[x, y]`; `None` behind the camera.
    pub fn image_from_camera(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
        let [u, v, depth] = self.p2.map(|[a, b, c, d]| a * x + b * y + c * z + d);
        (depth > 0.0).then(|| [u / depth, v / depth])
    }
}

fn rows<const N: usize>(name: &str, matrix: Option<(usize, Vec<f64>)>) -> Result<[[f64; N]; 3]> {
    let Some((line, numbers)) = matrix else {
        return Err(Error::format(format!("there is no matrix {name}; give a KITTI calibration file")));
    };
    let (rows, rest) = numbers.as_chunks::<N>();
    match (<[[f64; N]; 3]>::try_from(rows), rest) {
        (Ok(rows), []) => Ok(rows),
        _ => Err(Error::format(format!(
            "line {line} gives {name} {} numbers instead of {}; fix the file",
            numbers.len(),
            3 * N
        ))),
    }
}

impl Data for Calibration {}

/// Writes Python's dictionary of the three matrices; with `{:#}`, focal length and image centre.
impl fmt::Display for Calibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            let ([fx, _, cx, _], [_, fy, cy, _]) = (self.p2[0], self.p2[1]);
            return writeln!(f, "Calibration, focal length {fx:.1} {fy:.1}, centre {cx:.1} {cy:.1} pixels");
        }
        let wide = |matrix: &[[f64; 4]; 3]| array_repr(&[3, 4], &|at| Number::F64(matrix[at / 4][at % 4]));
        let rect = array_repr(&[3, 3], &|at| Number::F64(self.r0_rect[at / 3][at % 3]));
        let (p2, velo) = (wide(&self.p2), wide(&self.tr_velo_to_cam));
        write!(f, "{{'P2': {p2}, 'R0_rect': {rect}, 'Tr_velo_to_cam': {velo}}}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nP2: 700 0 600 40 0 700 170 0 0 0 1 0\n\
                        R0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: 0 -1 0 0 0 0 -1 -0.5 1 0 0 -0.25\n";

    #[test]
    fn lidar_to_pixel() {
        let calibration = Calibration::from_kitti_text(FILE).unwrap();
        let camera = calibration.camera_from_lidar([10.25, 1.0, -1.0]);
        assert_eq!(camera, [-1.0, 0.5, 10.0]);
        assert_eq!(calibration.image_from_camera(camera), Some([534.0, 205.0]));
        assert_eq!(calibration.image_from_camera([0.0, 0.0, -1.0]), None);
        assert!(calibration.to_string().starts_with("{'P2': array([[700.,   0., 600.,  40.],\n"));
        let line = "Calibration, focal length 700.0 700.0, centre 600.0 170.0 pixels\n";
        assert_eq!(format!("{calibration:#}"), line);
    }

    #[test]
    fn broken_files_are_rejected() {
        for (from, to, expected) in [
            ("R0_rect", "R1_rect", "there is no matrix R0_rect"),
            ("700 0 600", "700 0", "line 2 gives P2 11 numbers instead of 12"),
            ("700 0 600", "700 nan 600", "line 2 has fields that are not finite numbers"),
        ] {
            let error = Calibration::from_kitti_text(&FILE.replace(from, to)).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
        }
    }
}
