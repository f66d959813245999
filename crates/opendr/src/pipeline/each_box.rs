//! Inference on the crop of each detected box.

use opendr_engine::data::{Image, PixelFormat};
use opendr_engine::learner::{AnyStream, Entry, Ports};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Category, Classes, Name, Pose, PoseList};
use opendr_engine::{Error, Result, Value, ValueType};

/// Output types that can be merged over the boxes of an image.
const MERGEABLE: &[ValueType] = &[ValueType::Category, ValueType::BoundingBoxList, ValueType::PoseList];

const PORT: &str = ValueType::Image.port();

/// Checks that a learner can run on crops: its only input is an image, and its outputs can be merged.
///
/// # Errors
/// `InvalidParam` for other learners.
pub(super) fn check(entry: &Entry) -> Result<()> {
    let takes_image =
        matches!(entry.ports, [port] if port.value_type == ValueType::Image && port.name == PORT);
    if takes_image && matches!(entry.outputs, [output] if MERGEABLE.contains(&output.value_type)) {
        return Ok(());
    }
    let names: Vec<_> = MERGEABLE.iter().map(|value_type| value_type.name()).collect();
    Err(Error::invalid_param(format!(
        "{} cannot run on each box: a learner is needed whose only input is an image and whose output is one of {}",
        entry.spec.class,
        names.join(", ")
    )))
}

/// Runs `stream` on the crop of each of `boxes` and merges the outputs, in pixels of the whole image. A category becomes the
/// name of its box, and its score that of the box. The stream is reset before each box.
///
/// # Errors
/// Those of the learner.
pub(super) fn infer(
    entry: &Entry,
    stream: &mut dyn AnyStream,
    classes: &Classes,
    image: &Image,
    boxes: &BoundingBoxList,
) -> Result<Value> {
    let (mut found, mut persons) = (Vec::new(), Vec::new());
    for region in &boxes.boxes {
        let Some((crop, corner)) = crop(image, region)? else { continue };
        stream.reset();
        match stream.infer(&Ports::one(&crop))?.into_iter().next() {
            Some((_, Value::Category(category))) => found.push(named(region, category)),
            Some((_, Value::BoundingBoxList(list))) => {
                found.extend(list.boxes.into_iter().map(|inner| moved_box(inner, corner)));
            }
            Some((_, Value::PoseList(list))) => persons.push((list, corner)),
            _ => {
                return Err(Error::internal(format!(
                    "{} returned an output that it does not declare",
                    entry.spec.class
                )));
            }
        }
    }
    let header = image.header.clone();
    if matches!(entry.outputs, [output] if output.value_type == ValueType::PoseList) {
        let poses = persons.into_iter().flat_map(|(list, corner)| moved_poses(list, corner)).collect();
        return Ok(PoseList { header, poses, ..Default::default() }.into());
    }
    Ok(BoundingBoxList { header, boxes: found, classes: classes.clone(), ..Default::default() }.into())
}

/// Returns the crop of a box and its top-left corner; `None` if the box lies outside the image.
fn crop(image: &Image, region: &BoundingBox) -> Result<Option<(Image, [f32; 2])>> {
    let [x0, y0, x1, y1] = region.corners().map(|edge| if edge.is_finite() { edge.max(0.0) } else { 0.0 });
    let (left, top) = (x0 as usize, y0 as usize);
    let size = [(x1.ceil() as usize).saturating_sub(left), (y1.ceil() as usize).saturating_sub(top)];
    let Some(part) = image.view().crop(left, top, size[0], size[1]) else { return Ok(None) };
    let pixels = part.hwc_u8(PixelFormat::Rgb);
    let crop = Image::from_rgb8(pixels, part.width(), part.height())?.with_header(image.header.clone());
    Ok(Some((crop, [left as f32, top as f32])))
}

/// Returns the box with the predicted category as its name, and with the category's confidence if it has one.
fn named(region: &BoundingBox, category: Category) -> BoundingBox {
    let name = category.description.map_or(Name::Index(category.class), Name::Label);
    BoundingBox { name, confidence: category.confidence.unwrap_or(region.confidence), ..region.clone() }
}

/// Moves a box of the crop into the whole image and drops its mask, which has the size of the crop.
fn moved_box(inner: BoundingBox, [left, top]: [f32; 2]) -> BoundingBox {
    let landmarks = inner.landmarks.iter().map(|[x, y]| [x + left, y + top]).collect();
    BoundingBox { left: inner.left + left, top: inner.top + top, landmarks, segment: None, ..inner }
}

fn moved_poses(list: PoseList, [left, top]: [f32; 2]) -> impl Iterator<Item = Pose> {
    list.poses.into_iter().map(move |mut pose| {
        for point in pose.keypoints.iter_mut().filter(|point| point.is_detected()) {
            (point.x, point.y) = (point.x + left, point.y + top);
        }
        // Track ids are valid only within the stream of this box.
        (pose.id, pose.region) = (None, pose.region.map(|region| Box::new(moved_box(*region, [left, top]))));
        pose
    })
}
