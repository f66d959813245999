//! The drone's depth camera.

use opendr_engine::{Random, Result};

use super::{CAMERA_HEIGHT, CorridorOptions, HALF_WIDTH, RANGE, SIDE};
use crate::raycast::{Camera, DepthBuffer, Pose, Scene, along};

/// Measures depth, with the faults that were asked for.
#[derive(Debug, Clone)]
pub(super) struct RangeCamera {
    camera: Camera,
    seen: DepthBuffer,
}

impl RangeCamera {
    pub fn new() -> Result<Self> {
        Ok(Self { camera: Camera::new(SIDE, SIDE, HALF_WIDTH)?, seen: DepthBuffer::default() })
    }

    /// Writes depth as a share of the range. `random` makes the faults of one picture.
    pub fn measure(
        &mut self,
        scene: &Scene,
        drone: &Pose,
        options: &CorridorOptions,
        random: impl FnOnce() -> Random,
        shares: &mut [f32],
    ) {
        let position = along(drone.position, drone.axes[2], CAMERA_HEIGHT);
        self.camera.look(scene, &Pose { position, ..*drone }, RANGE, &mut self.seen);
        for (share, depth) in shares.iter_mut().zip(self.seen.depths()) {
            *share = depth * (1.0 / RANGE);
        }
        if options.range_noise > 0.0 || options.dropped_pixels > 0.0 {
            disturb(shares, options, random());
        }
    }
}

/// The four quarters of 64 random bits: three of them added are nearly normal, the fourth decides what is dropped.
fn disturb(shares: &mut [f32], options: &CorridorOptions, mut random: Random) {
    const UNIT: f32 = 1.0 / 65_536.0;
    for share in shares {
        let bits = random.bits();
        let quarter = |number: u32| ((bits >> (16 * number)) & 0xffff) as f32 * UNIT;
        // Three uniform numbers have mean 3/2 and variance 1/4.
        let noise = 2.0 * (quarter(0) + quarter(1) + quarter(2) - 1.5);
        let measured = (*share * (1.0 + options.range_noise * noise)).clamp(0.0, 1.0);
        // What is out of range has no depth that could be wrong.
        let measured = if *share < 1.0 { measured } else { 1.0 };
        *share = if quarter(3) < options.dropped_pixels { 1.0 } else { measured };
    }
}
