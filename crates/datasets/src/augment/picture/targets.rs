//! Transformation of targets.

use opendr_engine::target::{Heatmap, HeatmapValues, Keypoint, Pose, PoseList, TextRegionList};
use opendr_engine::{Error, Result, Value};

use crate::augment::picture::border::Border;
use crate::augment::picture::boxes::map_box;
use crate::augment::picture::map::AffineMap;
use crate::augment::picture::warp::{check_size, nearest_plane};

/// Transforms the parts of a target with image coordinates; a target of the whole image (a class, a text) is kept.
pub(super) fn follow(target: &mut Value, map: &AffineMap, border: &Border) -> Result<()> {
    match target {
        Value::BoundingBoxList(list) => retain(&mut list.boxes, |object| map_box(object, map, border)),
        Value::TrackingAnnotationList(list) => {
            retain(&mut list.annotations, |track| map_box(&mut track.bounding_box, map, border))
        }
        Value::PoseList(list) => map_poses(list, map, border),
        Value::Heatmap(heatmap) => map_heatmap(heatmap, map, border),
        Value::TextRegionList(list) => map_text(list, map),
        Value::Category(_)
        | Value::SpeechCommand(_)
        | Value::BaseTranscription(_)
        | Value::WhisperTranscription(_)
        | Value::VoskTranscription(_) => Ok(()),
        other => Err(Error::unsupported(format!(
            "a {} cannot be transformed together with its image; remove the augmentation",
            other.as_value_ref().value_type().name()
        ))),
    }
}

/// Keeps the items for which `keep` returns true; returns the last error of `keep`.
pub(super) fn retain<T>(items: &mut Vec<T>, mut keep: impl FnMut(&mut T) -> Result<bool>) -> Result<()> {
    let mut outcome = Ok(());
    items.retain_mut(|item| {
        keep(item).unwrap_or_else(|error| {
            outcome = Err(error);
            true
        })
    });
    outcome
}

fn map_poses(list: &mut PoseList, map: &AffineMap, border: &Border) -> Result<()> {
    retain(&mut list.poses, |pose| {
        let joints = |pose: &Pose| pose.keypoints.iter().filter(|joint| joint.is_detected()).count();
        let nothing_before = joints(pose) == 0 && pose.region.is_none();
        pose.keypoints.iter_mut().for_each(|joint| map_keypoint(joint, map));
        if map.mirrors() {
            swap_sides(pose);
        }
        if let Some(region) = &mut pose.region
            && !map_box(region, map, border)?
        {
            pose.region = None;
        }
        Ok(nothing_before || joints(pose) > 0 || pose.region.is_some())
    })
}

/// Maps the corners of text; regions whose centre leaves the image are dropped.
fn map_text(list: &mut TextRegionList, map: &AffineMap) -> Result<()> {
    if map.mirrors() {
        return Err(Error::unsupported(
            "mirrored text cannot be read; remove the flip from the augmentation",
        ));
    }
    let [width, height] = map.output_size().map(|side| side as f64);
    list.regions.retain_mut(|region| {
        let corners = region.corners.map(|[x, y]| map.output_from_input([x.into(), y.into()]));
        region.corners = corners.map(|corner| corner.map(|number| number as f32));
        let [x, y] = [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0);
        (0.0..=width).contains(&x) && (0.0..=height).contains(&y)
    });
    Ok(())
}

fn map_keypoint(joint: &mut Keypoint, map: &AffineMap) {
    if !joint.is_detected() {
        return;
    }
    let [x, y] = map.output_from_input([joint.x.into(), joint.y.into()]);
    let [width, height] = map.output_size().map(|side| side as f64);
    // A point on the edge is inside: a flip maps 0 to the width.
    let inside = (0.0..=width).contains(&x) && (0.0..=height).contains(&y);
    *joint = if inside { Keypoint { x: x as f32, y: y as f32, ..*joint } } else { Keypoint::MISSING };
}

/// Swaps left and right keypoints, as needed in a mirror image.
fn swap_sides(pose: &mut Pose) {
    for joint in 0..pose.skeleton.joints().len() {
        if let Some(partner) = pose.skeleton.partner(joint)
            && joint < partner
            && partner < pose.keypoints.len()
        {
            pose.keypoints.swap(joint, partner);
        }
    }
    pose.skeleton = pose.skeleton.mirrored();
}

fn map_heatmap(heatmap: &mut Heatmap, map: &AffineMap, border: &Border) -> Result<()> {
    let shape: Vec<usize> = heatmap.shape().to_vec();
    let (&[height, width] | &[_, height, width]) = &shape[..] else {
        return Err(Error::unsupported(format!(
            "a heatmap of shape {shape:?} cannot be transformed together with its image; its shape must be \
            [height, width] or [classes, height, width]"
        )));
    };
    let map = map.for_size([width, height]);
    let [columns, rows] = map.output_size();
    let values = match heatmap.values() {
        HeatmapValues::Labels(labels) => {
            HeatmapValues::Labels(each_plane(labels, &map, border.label)?.into())
        }
        HeatmapValues::Scores(scores) => HeatmapValues::Scores(each_plane(scores, &map, 0.0)?.into()),
    };
    let shape: Vec<usize> = shape[..shape.len() - 2].iter().copied().chain([rows, columns]).collect();
    let mut moved = Heatmap::new(values, &shape)?;
    (moved.header, moved.classes) = (heatmap.header.clone(), heatmap.classes.clone());
    moved.action = heatmap.action;
    *heatmap = moved;
    Ok(())
}

fn each_plane<T: Copy>(values: &[T], map: &AffineMap, fill: T) -> Result<Vec<T>> {
    let [width, height] = map.input_size();
    let mut moved = Vec::new();
    for plane in values.chunks_exact((width * height).max(1)) {
        check_size(map.output_size(), values.len() / plane.len())?;
        moved.extend(nearest_plane(plane, map, fill)?);
    }
    Ok(moved)
}
