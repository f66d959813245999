//! Calibration of a lidar and a camera.

use std::ffi::c_char;
use std::fs::File;
use std::io::Read;

use opendr::data::Calibration;
use opendr::{Error, Header, ResultExt};

use crate::handle::Out;
use crate::pointer::{path, place, reference};
use crate::status::{guard, opendr_status};
use crate::value::{AnyValue, opendr_calibration, typed};

/// Largest calibration file that is read; KITTI's have about a kilobyte.
const MAX_BYTES: u64 = 1 << 20;

/// The matrices of a calibration in row-major order, with KITTI's names.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_calibration_matrices {
    /// Projection of the rectified camera frame into the left colour image.
    pub p2: [[f64; 4]; 3],
    /// Rectifying rotation.
    pub r0_rect: [[f64; 3]; 3],
    /// Transformation from the lidar frame to the camera frame, metres.
    pub tr_velo_to_cam: [[f64; 4]; 3],
}

/// Creates a calibration from its matrices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_calibration_create(
    matrices: *const opendr_calibration_matrices,
    calibration: *mut *mut opendr_calibration,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, matrices) =
            unsafe { (Out::new(calibration, "calibration")?, reference(matrices, "matrices")?) };
        let opendr_calibration_matrices { p2, r0_rect, tr_velo_to_cam } = *matrices;
        let mut numbers =
            p2.iter().flatten().chain(r0_rect.iter().flatten()).chain(tr_velo_to_cam.iter().flatten());
        if !numbers.all(|number| number.is_finite()) {
            return Err(Error::invalid_input(
                "matrices have elements that are NaN or infinite; give finite numbers",
            ));
        }
        out.set(AnyValue::from(Calibration { header: Header::default(), p2, r0_rect, tr_velo_to_cam }));
        Ok(())
    })
}

/// Reads a calibration file of KITTI's detection or tracking benchmark.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_calibration_open(
    path: *const c_char,
    calibration: *mut *mut opendr_calibration,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, path) = unsafe { (Out::new(calibration, "calibration")?, self::path(path, "path")?) };
        let context = || format!("reading {}", path.display());
        let mut bytes = Vec::new();
        File::open(path).and_then(|file| file.take(MAX_BYTES).read_to_end(&mut bytes)).context(context)?;
        let text = String::from_utf8_lossy(&bytes);
        out.set(AnyValue::from(Calibration::from_kitti_text(&text).context(context)?));
        Ok(())
    })
}

/// Copies the matrices of a calibration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_calibration_read(
    calibration: *const opendr_calibration,
    matrices: *mut opendr_calibration_matrices,
) -> opendr_status {
    guard(|| {
        let matrices = place(matrices, "matrices")?;
        // SAFETY: the rules at the top of opendr.h.
        unsafe {
            let Calibration { p2, r0_rect, tr_velo_to_cam, .. } = *typed(calibration, "calibration")?;
            matrices.write(opendr_calibration_matrices { p2, r0_rect, tr_velo_to_cam });
        }
        Ok(())
    })
}
