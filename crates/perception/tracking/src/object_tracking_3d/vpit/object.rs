//! Position and motion of the tracked object.

use opendr_clouds::object_detection_3d::Scan;
use opendr_engine::target::{BoundingBox3DList, LidarBox, Name};
use opendr_engine::{Error, Result};

use super::choice::Found;
use super::params::{Extrapolation, VpitParams};

pub(super) struct Object {
    pub name: Name,
    /// Box in the lidar's frame.
    pub place: LidarBox,
    /// Motion per step, x and y, in metres.
    step: [f64; 2],
    /// Height of its points above the bottom of its first box, in metres.
    pub top: Option<f32>,
    pub frame: i64,
}

/// Range of sides of objects, in metres.
const SIZES: std::ops::Range<f64> = 0.05..50.0;
/// Maximum coordinate, in metres.
const LIMIT: f64 = 1e5;
/// Weight of the last step in the mean motion.
const RECENT: f64 = 0.5;
/// Maximum vertical motion per step, in metres.
const RISE: f64 = 0.3;

impl Object {
    /// Creates the object from the first of `boxes`.
    ///
    /// # Errors
    /// `InvalidInput` without a box, and for one without a volume or a finite position.
    pub fn of(scan: Scan<'_>, boxes: &BoundingBox3DList) -> Result<Self> {
        let found = boxes.boxes.first().ok_or_else(|| {
            Error::invalid_input("init_box has no box; give one around the object to track")
        })?;
        let place = LidarBox::from_camera(found, scan.calibration()).filter(|place| {
            place.size.iter().all(|side| SIZES.contains(side))
                && place.center.iter().all(|part| part.abs() < LIMIT)
        });
        let place = place.ok_or_else(|| {
            Error::invalid_input(format!(
                "init_box is {:?} m at {:?}; give a box with a finite position and sides of {} to {} m",
                found.dimensions, found.location, SIZES.start, SIZES.end
            ))
        })?;
        Ok(Self { name: found.name.clone(), place, step: [0.0; 2], top: None, frame: 1 })
    }

    /// Advances to the expected position of the next step.
    pub fn expect(&mut self, mode: Extrapolation) {
        self.frame = self.frame.saturating_add(1);
        if mode != Extrapolation::None {
            for (part, step) in self.place.center.iter_mut().zip(self.step) {
                *part = (*part + step).clamp(-LIMIT, LIMIT);
            }
        }
    }

    /// Moves to the detection in a view that is rotated by `turn`; views are `step` apart. Returns the offset in x and y.
    pub fn go(&mut self, found: &Found, turn: f64, step: f64, params: &VpitParams) -> [f64; 2] {
        let share = f64::from(params.offset_interpolation);
        let (sin, cos) = (self.place.yaw + turn).sin_cos();
        let [ahead, aside] = found.offset.map(|part| share * part);
        let way = [cos * ahead - sin * aside, sin * ahead + cos * aside];
        for (part, way) in self.place.center.iter_mut().zip(way) {
            *part += way;
        }
        let yaw = self.place.yaw + share * (turn + found.turn * step);
        self.place.yaw = yaw.sin().atan2(yaw.cos());
        way
    }

    /// Moves vertically by `share` of the change of the height of the object's points.
    pub fn settle(&mut self, top: Option<f32>, share: f32) {
        if let (Some(before), Some(now)) = (self.top, top) {
            self.place.center[2] += (f64::from(share) * f64::from(now - before)).clamp(-RISE, RISE);
        }
    }

    /// Updates the motion from the position before this step.
    pub fn learn(&mut self, before: [f64; 3], mode: Extrapolation) {
        let share = match mode {
            Extrapolation::LinearPlus => RECENT,
            Extrapolation::Linear | Extrapolation::None => 1.0,
        };
        for ((step, now), before) in self.step.iter_mut().zip(self.place.center).zip(before) {
            *step += share * (now - before - *step);
        }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::PointCloud;
    use opendr_engine::target::BoundingBox3D;

    use super::*;

    fn list(dimensions: [f32; 3], location: [f32; 3]) -> BoundingBox3DList {
        vec![BoundingBox3D { dimensions, location, ..Default::default() }].into()
    }

    #[test]
    fn boxes_without_volume_or_place_are_refused() {
        let cloud = PointCloud::new(vec![], [0, 3]).unwrap();
        let object = |boxes: &BoundingBox3DList| Object::of(Scan::from(&cloud), boxes);
        assert!(object(&list([4.0, 1.5, 1.7], [0.0, 1.7, 12.0])).is_ok());
        for (dimensions, location) in [
            ([4.0, 0.0, 1.7], [0.0, 1.7, 12.0]),
            ([4.0, f32::NAN, 1.7], [0.0, 1.7, 12.0]),
            ([4.0, 1.5, 1.7], [f32::INFINITY, 1.7, 12.0]),
            ([4.0, 1.5, 1e9], [0.0, 1.7, 12.0]),
            ([4.0, 1.5, 1.7], [0.0, 1.7, 1e9]),
        ] {
            assert!(object(&list(dimensions, location)).is_err(), "{dimensions:?} {location:?}");
        }
        assert!(object(&BoundingBox3DList::default()).is_err());
    }

    #[test]
    fn steps_are_kept_and_turned() {
        let cloud = PointCloud::new(vec![], [0, 3]).unwrap();
        let mut object = Object::of(Scan::from(&cloud), &list([4.0, 1.5, 1.7], [0.0, 1.7, 12.0])).unwrap();
        let yaw = object.place.yaw;
        let (before, params) = (object.place.center, VpitParams::default());
        let found = Found { view: 1, offset: [1.0, 0.0], turn: 0.5, score: 1.0 };
        let way = object.go(&found, 0.0, 0.2, &params);
        assert!((way[0].hypot(way[1]) - 1.0).abs() < 1e-9 && (way[0] - yaw.cos()).abs() < 1e-9);
        assert!(((object.place.yaw - yaw) - 0.1).abs() < 1e-9);
        object.learn(before, Extrapolation::Linear);
        let here = object.place.center;
        object.expect(Extrapolation::None);
        assert_eq!(object.place.center, here);
        object.expect(Extrapolation::Linear);
        assert!((object.place.center[0] - here[0] - way[0]).abs() < 1e-9);
        object.top = Some(1.5);
        object.settle(Some(1.6), 0.5);
        object.settle(None, 0.5);
        assert!((object.place.center[2] - here[2] - 0.05).abs() < 1e-6);
    }
}
