//! Drawing of skeletons.

use opendr_engine::data::Image;
use opendr_engine::target::{Keypoint, Pose, PoseList};

use crate::draw::canvas::Canvas;
use crate::draw::label::Labels;
use crate::draw::palette::{Colour, colour_of_index};
use crate::draw::style::Style;

const LEFT: Colour = [255, 138, 48];
const RIGHT: Colour = [48, 160, 255];
const MIDDLE: Colour = [140, 230, 90];

/// Draws the detected bones and joints: left ones orange, right ones blue, central ones green.
///
/// Poses with a track id have it as a label. `image` is converted to RGB `u8` where needed; earlier poses of the list
/// are drawn on top of later ones.
pub fn draw_poses(image: &mut Image, poses: &PoseList, style: &Style) {
    let mut canvas = Canvas::over(image);
    let (thickness, unit) = (style.thickness(&canvas), style.letter_unit(&canvas));
    for pose in poses.poses.iter().rev() {
        draw_skeleton(&mut canvas, pose, thickness, style);
    }
    let mut labels = Labels::default();
    for pose in poses.poses.iter().filter(|_| style.labels) {
        if let (Some(id), Some([left, top, width, height])) = (pose.id, pose.bounding_box()) {
            let colour = style.colour.unwrap_or_else(|| colour_of_index(id));
            let corners = [left, top - 4.0 * thickness, left + width, top + height];
            let text = id.to_string();
            labels.draw(&mut canvas, [&text, &text], corners, [unit, thickness], colour);
        }
    }
}

fn draw_skeleton(canvas: &mut Canvas<'_>, pose: &Pose, thickness: f32, style: &Style) {
    let found = |index: usize| {
        let shown = |joint: &&Keypoint| joint.is_detected() && joint.confidence >= style.min_joint_confidence;
        pose.keypoints.get(index).filter(shown).map(|joint| [joint.x, joint.y])
    };
    let side = |index: usize| {
        let name = pose.skeleton.joints().get(index).copied().unwrap_or_default();
        name.chars().next().filter(|_| name.starts_with("l_") || name.starts_with("r_"))
    };
    let colour = |side: Option<char>| {
        style.colour.unwrap_or(match side {
            Some('l') => LEFT,
            Some(_) => RIGHT,
            None => MIDDLE,
        })
    };
    let bones =
        pose.skeleton.bones().iter().filter_map(|&[a, b]| Some((found(a)?, found(b)?, side(a), side(b))));
    for (from, to, ..) in bones.clone() {
        canvas.line(from, to, thickness + 2.0, [0; 3], 0.3);
    }
    for (from, to, a, b) in bones {
        // A bone between a left and a right joint belongs to the trunk; a bone to the neck or nose has the side of
        // its other end.
        let bone = match (a, b) {
            (Some(a), Some(b)) if a != b => None,
            (a, b) => a.or(b),
        };
        canvas.line(from, to, thickness, colour(bone), 1.0);
    }
    for index in 0..pose.keypoints.len() {
        if let Some(joint) = found(index) {
            canvas.disc(joint, thickness * 1.1 + 0.5, [255; 3], 1.0);
            canvas.disc(joint, thickness * 0.8, colour(side(index)), 1.0);
        }
    }
}
