//! Rendering of scenes into depth buffers.

use super::paint::paint;
use super::{Camera, DepthBuffer, LANES, Pose, Scene};

impl Camera {
    /// Renders depth and bodies of a scene, up to `range` metres ahead (along the optical axis, as depth cameras measure).
    ///
    /// Bodies are drawn one by one into the pixels that they may cover; the nearest is kept.
    pub fn render_depth(&self, scene: &Scene, pose: &Pose, range: f32, buffer: &mut DepthBuffer) {
        let packets = self.columns.len() * self.height();
        buffer.width = self.width();
        buffer.packets.clear();
        buffer.packets.resize(packets, [range; LANES]);
        buffer.bodies.clear();
        buffer.bodies.resize(packets, [u32::MAX; LANES]);
        for (body, number) in scene.bodies().iter().zip(0..) {
            if let Some(patch) = self.patch(pose, body.position(), body.shape().reach(), range) {
                paint(self, pose, body, number, patch, buffer);
            }
        }
    }
}
