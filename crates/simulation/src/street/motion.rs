//! Motion of the objects of a street.

use opendr_engine::overlap::RotatedRectangle;
use opendr_engine::target::LidarBox;
use opendr_engine::{Random, Result};

use super::layout::OWN;
use super::{Street, StreetKind, StreetObject};
use crate::raycast::Scene;

/// Velocities of a street's objects and of the car that carries the lidar.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    /// Speed of each object along its yaw, in m/s.
    speeds: Vec<f64>,
    own: OwnMotion,
}

/// Motion along an arc.
#[derive(Debug, Clone, Copy)]
struct OwnMotion {
    /// Speed, in m/s.
    speed: f64,
    /// Yaw rate, in rad/s; not 0.
    turn: f64,
}

/// Interval of collision checks, in seconds.
const STEP: f64 = 0.2;

impl OwnMotion {
    /// Returns position and yaw of the lidar after `time` seconds, relative to the start.
    fn pose(self, time: f64) -> ([f64; 2], f64) {
        let yaw = self.turn * time;
        let radius = self.speed / self.turn;
        ([radius * yaw.sin(), radius * (1.0 - yaw.cos())], yaw)
    }

    fn floor(self, time: f64) -> RotatedRectangle {
        let (center, angle) = self.pose(time);
        RotatedRectangle { center, angle, ..OWN }
    }
}

/// Returns the place of an object that moves straight ahead.
fn moved(place: &LidarBox, speed: f64, time: f64) -> LidarBox {
    let (sin, cos) = place.yaw.sin_cos();
    let [x, y, z] = place.center;
    LidarBox { center: [x + cos * speed * time, y + sin * speed * time, z], ..*place }
}

impl Motion {
    /// Creates a random motion in which nothing collides for `seconds`.
    pub fn new(street: &Street, seconds: f64, random: &mut Random) -> Self {
        let turn = 0.02 * random.normal() + 1e-6;
        let own = OwnMotion { speed: 0.0, turn };
        let mut motion = Self { speeds: vec![0.0; street.objects.len()], own };
        motion.own.speed = f64::from(random.uniform(0.0, 12.0));
        while motion.own.speed > 0.0 && !motion.is_own_way_free(street, seconds) {
            motion.own.speed = if motion.own.speed < 1.0 { 0.0 } else { motion.own.speed / 2.0 };
        }
        for (number, object) in street.objects.iter().enumerate() {
            let (share, [low, high]) = match object.kind {
                StreetKind::Car => (0.6, [1.0, 12.0]),
                StreetKind::Truck => (0.4, [1.0, 9.0]),
                StreetKind::Pedestrian => (0.7, [0.5, 1.8]),
                StreetKind::Structure | StreetKind::Vegetation | StreetKind::Ground => continue,
            };
            if random.chance(share) {
                motion.speeds[number] = f64::from(random.uniform(low, high));
                if !motion.is_way_free(street, number, seconds) {
                    motion.speeds[number] = 0.0;
                }
            }
        }
        motion
    }

    fn floor(&self, object: &StreetObject, number: usize, time: f64) -> RotatedRectangle {
        moved(&object.bounding_box, self.speeds[number], time).upright_box().base
    }

    fn is_own_way_free(&self, street: &Street, seconds: f64) -> bool {
        self.is_free(street, seconds, None, |time| self.own.floor(time))
    }

    fn is_way_free(&self, street: &Street, number: usize, seconds: f64) -> bool {
        let own = |time| self.floor(&street.objects[number], number, time);
        times(seconds).all(|time| own(time).intersection_area(&self.own.floor(time)) == 0.0)
            && self.is_free(street, seconds, Some(number), own)
    }

    /// Returns whether `floor` overlaps no object other than `own`.
    fn is_free(
        &self,
        street: &Street,
        seconds: f64,
        own: Option<usize>,
        floor: impl Fn(f64) -> RotatedRectangle,
    ) -> bool {
        let others = street.objects.iter().enumerate();
        let mut others = others.filter(|(at, other)| Some(*at) != own && other.kind != StreetKind::Ground);
        others.all(|(at, other)| {
            times(seconds).all(|time| floor(time).intersection_area(&self.floor(other, at, time)) == 0.0)
        })
    }

    /// Returns the street after `time` seconds, in the frame of the lidar at that time.
    pub fn street_at(&self, street: &Street, time: f64) -> Result<Street> {
        let ([own_x, own_y], own_yaw) = self.own.pose(time);
        let (sin, cos) = own_yaw.sin_cos();
        // From the lidar's first frame to its current one; the ground keeps its slope under the car.
        let in_new_frame = |[x, y, z]: [f64; 3]| {
            let (dx, dy) = (x - own_x, y - own_y);
            let [new_x, new_y] = [cos * dx + sin * dy, cos * dy - sin * dx];
            let rise = street.ground.at(new_x as f32, new_y as f32) - street.ground.at(x as f32, y as f32);
            [new_x, new_y, z + f64::from(rise)]
        };
        let mut later = street.clone();
        later.scene = Scene::default();
        for (object, speed) in later.objects.iter_mut().zip(&self.speeds) {
            if object.kind != StreetKind::Ground {
                object.bounding_box = moved(&object.bounding_box, *speed, time);
                object.bounding_box.center = in_new_frame(object.bounding_box.center);
                object.bounding_box.yaw -= own_yaw;
            }
        }
        for body in street.scene.bodies() {
            let number = usize::from(body.label());
            let (Some(object), Some(speed)) = (street.objects.get(number), self.speeds.get(number)) else {
                continue;
            };
            if object.kind == StreetKind::Ground {
                later.scene.add(body.clone());
                continue;
            }
            let center = body.position().map(f64::from);
            let place = LidarBox { center, ..object.bounding_box };
            let position = in_new_frame(moved(&place, *speed, time).center);
            later.scene.add(body.moved(position.map(|part| part as f32), -own_yaw as f32)?);
        }
        Ok(later)
    }
}

fn times(seconds: f64) -> impl Iterator<Item = f64> {
    (0..=(seconds / STEP).ceil() as usize).map(|step| step as f64 * STEP)
}
