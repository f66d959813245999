//! A spinning lidar: rings of rays, range noise, lost returns.
//!
//! The frame is the sensor's, as in ROS and KITTI: x ahead, y left, z up, in metres.

use std::f32::consts::PI;

use opendr_engine::{Error, Random, Result};

use crate::raycast::{Hit, Scene, Vector, along};

/// A lidar whose rays start in one point.
#[derive(Debug, Clone, PartialEq)]
pub struct SpinningLidar {
    /// Elevation angles of the rings, in radians, in the order of the returned points.
    pub elevations: Vec<f32>,
    /// Half of the horizontal field of view, in radians; pi is a full turn.
    pub half_fov: f32,
    /// Angle between two rays of a ring, in radians.
    pub step: f32,
    /// Maximum range, in metres.
    pub range: f32,
}

/// Response of a surface to a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceResponse {
    /// Standard deviation of the measured range, in metres.
    pub noise: f32,
    /// Fraction of the returns that are lost.
    pub lost: f32,
    /// Reflectance, 0 to 1.
    pub reflectance: f32,
}

/// A return of a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LidarReturn {
    /// x, y, z in metres and reflectance, as in KITTI's files.
    pub point: [f32; 4],
    /// Label of the body that was hit.
    pub label: u16,
}

/// Maximum rays of a scan: a thousand rings of ten thousand.
const MAX_RAYS: usize = 10_000_000;

impl SpinningLidar {
    /// Returns Velodyne's HDL-64E as mounted on KITTI's car: 64 rings from +2 to -24.8 degrees, the upper 32 a third of a degree
    /// apart, the lower 32 half a degree; 0.1728 degrees between rays at ten turns per second; range 120 metres.
    pub fn hdl64e() -> Self {
        let upper = (0..32).map(|ring| 2.0 - ring as f32 / 3.0);
        let lower = (0..32).map(|ring| -8.83 - ring as f32 * (24.8 - 8.83) / 31.0);
        Self {
            elevations: upper.chain(lower).map(f32::to_radians).collect(),
            half_fov: PI,
            step: 0.1728_f32.to_radians(),
            range: 120.0,
        }
    }

    /// Limits the field of view to `half_view` radians to either side.
    #[must_use]
    pub fn with_half_view(mut self, half_view: f32) -> Self {
        self.half_fov = half_view;
        self
    }

    /// Returns the directions of a turn, ring by ring, from left to right; `random` draws a horizontal offset for each ring.
    ///
    /// # Errors
    /// `InvalidParam` for a step or view that is not a positive angle, or for more than ten million rays.
    pub fn directions(&self, random: &mut Random) -> Result<Vec<Vector>> {
        let rays = 2.0 * self.half_fov / self.step;
        let most = MAX_RAYS / self.elevations.len().max(1);
        if !(self.half_fov > 0.0 && self.half_fov <= PI + 1e-3 && rays >= 1.0 && (rays as usize) < most) {
            return Err(Error::invalid_param(format!(
                "the lidar has a half view of {} radians, steps of {} radians and {} rings; give a half view up to pi and at most \
                 {MAX_RAYS} rays",
                self.half_fov,
                self.step,
                self.elevations.len()
            )));
        }
        let mut directions = Vec::with_capacity(self.elevations.len() * rays as usize);
        for elevation in &self.elevations {
            let (up, level) = elevation.sin_cos();
            let first = self.half_fov - self.step * random.unit() as f32;
            directions.extend((0..rays as usize).map(|ray| {
                let (sin, cos) = (first - ray as f32 * self.step).sin_cos();
                [level * cos, level * sin, up]
            }));
        }
        Ok(directions)
    }

    /// Scans a scene from the origin of its frame; `echo` returns the response of a surface at a point.
    ///
    /// # Errors
    /// As [`Self::directions`].
    pub fn scan(
        &self,
        scene: &Scene,
        random: &mut Random,
        mut echo: impl FnMut(&Hit, Vector) -> SurfaceResponse,
    ) -> Result<Vec<LidarReturn>> {
        let directions = self.directions(random)?;
        let mut hits = vec![None; directions.len()];
        scene.hits([0.0; 3], &directions, self.range, &mut hits)?;
        let mut returns = Vec::with_capacity(hits.len());
        for (direction, hit) in directions.iter().zip(&hits) {
            let Some(hit) = hit else { continue };
            let SurfaceResponse { noise, lost, reflectance } =
                echo(hit, along([0.0; 3], *direction, hit.distance));
            if random.chance(lost) {
                continue;
            }
            let distance = hit.distance + noise * random.normal() as f32;
            let [x, y, z] = along([0.0; 3], *direction, distance);
            returns.push(LidarReturn { point: [x, y, z, reflectance.clamp(0.0, 1.0)], label: hit.label });
        }
        Ok(returns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raycast::{Body, Shape};

    const CLEAR: SurfaceResponse = SurfaceResponse { noise: 0.0, lost: 0.0, reflectance: 0.5 };

    #[test]
    fn rings_match_kitti() {
        let lidar = SpinningLidar::hdl64e();
        let degrees: Vec<_> = lidar.elevations.iter().map(|angle| angle.to_degrees()).collect();
        assert_eq!(degrees.len(), 64);
        assert!((degrees[0] - 2.0).abs() < 1e-4 && (degrees[63] + 24.8).abs() < 1e-4);
        assert!(degrees.is_sorted_by(|a, b| a > b));
        let rays = lidar.directions(&mut Random::new(1)).unwrap().len();
        assert_eq!(rays, 64 * 2083);
    }

    #[test]
    fn the_ground_has_its_height() {
        let mut scene = Scene::default();
        scene.add(Body::upright(Shape::HalfSpace, [0.0, 0.0, -1.73], 0).unwrap());
        let lidar = SpinningLidar::hdl64e().with_half_view(0.5);
        let returns = lidar.scan(&scene, &mut Random::new(1), |_, _| CLEAR).unwrap();
        // The lowest ring hits the ground 1.73 / tan 24.8 degrees ahead: 3.744 metres.
        let nearest = returns.iter().map(|hit| hit.point[0].hypot(hit.point[1])).fold(f32::MAX, f32::min);
        assert!((nearest - 3.744).abs() < 1e-2, "{nearest}");
        assert!(returns.iter().all(|seen| (seen.point[2] + 1.73).abs() < 1e-3 && seen.point[0] > 0.0));
        let half =
            lidar.scan(&scene, &mut Random::new(1), |_, _| SurfaceResponse { lost: 0.5, ..CLEAR }).unwrap();
        assert!((half.len() as f64 / returns.len() as f64 - 0.5).abs() < 0.05);
    }

    #[test]
    fn invalid_angles_are_refused() {
        for step in [0.0, -1.0, f32::NAN, 1e-9] {
            let lidar = SpinningLidar { step, ..SpinningLidar::hdl64e() };
            assert!(lidar.directions(&mut Random::new(1)).is_err(), "{step}");
        }
    }
}
