//! Directions in the frame of a camera on its sphere.

use opendr_engine::rig::ViewPose;

/// Rotates a direction from the rig's frame into that of the camera at `pose`: x from the subject to the camera, z up.
pub fn in_camera_frame(pose: &ViewPose, [x, y, z]: [f32; 3]) -> [f32; 3] {
    let ((sine, cosine), (high, level)) = angles(pose);
    let (ahead, left) = (cosine * x + sine * y, cosine * y - sine * x);
    [level * ahead + high * z, left, level * z - high * ahead]
}

/// Rotates a direction from the frame of the camera at `pose` into the rig's frame.
pub fn in_rig_frame(pose: &ViewPose, [x, y, z]: [f32; 3]) -> [f32; 3] {
    let ((sine, cosine), (high, level)) = angles(pose);
    let (ahead, up) = (level * x - high * z, high * x + level * z);
    [cosine * ahead - sine * y, sine * ahead + cosine * y, up]
}

fn angles(pose: &ViewPose) -> ((f32, f32), (f32, f32)) {
    ((pose.azimuth as f32).sin_cos(), (pose.elevation as f32).sin_cos())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frames_are_inverse_to_each_other() {
        let pose = ViewPose { azimuth: 2.0, elevation: -0.6, distance: 3.0, fourth: 0.0 };
        let close = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(close(in_camera_frame(&pose, pose.direction().map(|part| part as f32)), [1.0, 0.0, 0.0]));
        assert!(close(in_rig_frame(&pose, in_camera_frame(&pose, [0.3, -0.5, 0.9])), [0.3, -0.5, 0.9]));
        // Further up on the same side is up, further round is left.
        let above = ViewPose { elevation: -0.5, ..pose };
        assert!(in_camera_frame(&pose, above.direction().map(|part| part as f32))[2] > 0.05);
        let round = ViewPose { azimuth: 2.1, ..pose };
        assert!(in_camera_frame(&pose, round.direction().map(|part| part as f32))[1] > 0.05);
    }
}
