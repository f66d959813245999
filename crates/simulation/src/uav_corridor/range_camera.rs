//! The drone's depth camera.

use opendr_engine::{Random, Result};

use super::{CAMERA_HEIGHT, CorridorOptions, HALF_WIDTH, RANGE, SIDE};
use crate::raycast::{Camera, DepthBuffer, Pose, Scene, along};

/// Measures depth, with configured noise and dropped pixels.
#[derive(Debug, Clone)]
pub(super) struct RangeCamera {
    camera: Camera,
    buffer: DepthBuffer,
}

impl RangeCamera {
    pub fn new() -> Result<Self> {
        Ok(Self { camera: Camera::new(SIDE, SIDE, HALF_WIDTH)?, buffer: DepthBuffer::default() })
    }

    /// Writes depth as a fraction of the range. `random` generates the faults of one image.
    pub fn measure(
        &mut self,
        scene: &Scene,
        drone: &Pose,
        options: &CorridorOptions,
        random: impl FnOnce() -> Random,
        shares: &mut [f32],
    ) {
        let position = along(drone.position, drone.axes[2], CAMERA_HEIGHT);
        self.camera.render_depth(scene, &Pose { position, ..*drone }, RANGE, &mut self.buffer);
        for (share, depth) in shares.iter_mut().zip(self.buffer.depths()) {
            *share = depth * (1.0 / RANGE);
        }
        if options.range_noise > 0.0 || options.dropped_pixels > 0.0 {
            disturb(shares, options, random());
        }
    }
}

/// Uses the four quarters of 64 random bits: the sum of three is nearly normal, the fourth decides on dropped pixels.
fn disturb(shares: &mut [f32], options: &CorridorOptions, mut random: Random) {
    const UNIT: f32 = 1.0 / 65_536.0;
    for share in shares {
        let bits = random.bits();
        let quarter = |number: u32| ((bits >> (16 * number)) & 0xffff) as f32 * UNIT;
        // Three uniform numbers have mean 3/2 and variance 1/4.
        let noise = 2.0 * (quarter(0) + quarter(1) + quarter(2) - 1.5);
        let measured = (*share * (1.0 + options.range_noise * noise)).clamp(0.0, 1.0);
        // Pixels out of range have no depth to disturb.
        let measured = if *share < 1.0 { measured } else { 1.0 };
        *share = if quarter(3) < options.dropped_pixels { 1.0 } else { measured };
    }
}
