//! The pose of a moving camera.

use opendr::target::{Odometry, RigidPose};

use crate::handle::Out;
use crate::pointer::{place, reference};
use crate::status::{guard, opendr_status};
use crate::target::check_finite;
use crate::value::{AnyValue, opendr_odometry};

/// The fields of an odometry.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_odometry_fields {
    /// Whether the pose is known; position and orientation are NaN if it is not.
    pub is_known: bool,
    /// Position in the frame of the first image, metres: x to the right, y down, z ahead.
    pub position: [f64; 3],
    /// Orientation as a quaternion x, y, z, w.
    pub orientation: [f64; 4],
    /// Number of landmarks that agree with the pose.
    pub num_landmarks: u32,
}

/// Creates an odometry; the fields are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_odometry_create(
    fields: *const opendr_odometry_fields,
    odometry: *mut *mut opendr_odometry,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, fields) = unsafe { (Out::new(odometry, "odometry")?, reference(fields, "fields")?) };
        let opendr_odometry_fields { is_known, position, orientation, num_landmarks } = *fields;
        let mut value = Odometry { num_landmarks, ..Odometry::default() };
        if is_known {
            let numbers = position.iter().chain(&orientation).map(|number| *number as f32);
            check_finite(&numbers.collect::<Vec<_>>(), "a pose")?;
            value.pose = Some(RigidPose { position, orientation });
        }
        out.set(AnyValue::from(value));
        Ok(())
    })
}

/// Writes the fields of an odometry.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_odometry_read(
    odometry: *const opendr_odometry,
    fields: *mut opendr_odometry_fields,
) -> opendr_status {
    guard(|| {
        let place = place(fields, "fields")?;
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { AnyValue::of(odometry, "odometry") }?;
        let odometry = value.typed::<Odometry>("odometry")?;
        let unknown = RigidPose { position: [f64::NAN; 3], orientation: [f64::NAN; 4] };
        let RigidPose { position, orientation } = odometry.pose.unwrap_or(unknown);
        let (is_known, num_landmarks) = (odometry.pose.is_some(), odometry.num_landmarks);
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(opendr_odometry_fields { is_known, position, orientation, num_landmarks }) };
        Ok(())
    })
}
