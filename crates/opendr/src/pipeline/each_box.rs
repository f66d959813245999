//! A learner that looks at each box of a picture as a picture of its own.

use opendr_engine::data::{Image, PixelFormat};
use opendr_engine::learner::{AnyStream, Entry, Ports};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Category, Classes, Name, Pose, PoseList};
use opendr_engine::{Error, Result, Value, ValueType};

/// What the answers to single boxes can be put together to.
const ANSWERS: &[ValueType] = &[ValueType::Category, ValueType::BoundingBoxList, ValueType::PoseList];

const PORT: &str = ValueType::Image.port();

/// Whether a learner can look at boxes: it takes a picture and nothing else, and what it answers has a place.
///
/// # Errors
/// `InvalidParam` where it cannot.
pub(super) fn check(entry: &Entry) -> Result<()> {
    let takes_picture =
        matches!(entry.ports, [port] if port.value_type == ValueType::Image && port.name == PORT);
    if takes_picture && matches!(entry.outputs, [output] if ANSWERS.contains(&output.value_type)) {
        return Ok(());
    }
    let answers: Vec<_> = ANSWERS.iter().map(|answer| answer.name()).collect();
    Err(Error::invalid_param(format!(
        "{} cannot look at each box: that takes a learner of a single picture which answers one of {}",
        entry.spec.class,
        answers.join(", ")
    )))
}

/// Shows `stream` each of `boxes` and puts its answers together, in the pixels of the whole picture. A category becomes
/// the name of its box, and its score the box's. Boxes are strangers to each other: the learner forgets one before the next.
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
    for place in &boxes.boxes {
        let Some((crop, corner)) = crop(image, place)? else { continue };
        stream.reset();
        match stream.infer(&Ports::one(&crop))?.into_iter().next() {
            Some((_, Value::Category(category))) => found.push(named(place, category)),
            Some((_, Value::BoundingBoxList(list))) => {
                found.extend(list.boxes.into_iter().map(|inner| moved_box(inner, corner)));
            }
            Some((_, Value::PoseList(list))) => persons.push((list, corner)),
            _ => return Err(Error::internal(format!("{} answered what it does not say", entry.spec.class))),
        }
    }
    let header = image.header.clone();
    if matches!(entry.outputs, [output] if output.value_type == ValueType::PoseList) {
        let poses = persons.into_iter().flat_map(|(list, corner)| moved_poses(list, corner)).collect();
        return Ok(PoseList { header, poses, ..Default::default() }.into());
    }
    Ok(BoundingBoxList { header, boxes: found, classes: classes.clone(), ..Default::default() }.into())
}

/// The pixels of a box and its left-top corner; `None` where it lies outside the picture.
fn crop(image: &Image, place: &BoundingBox) -> Result<Option<(Image, [f32; 2])>> {
    let [x0, y0, x1, y1] = place.corners().map(|edge| if edge.is_finite() { edge.max(0.0) } else { 0.0 });
    let (left, top) = (x0 as usize, y0 as usize);
    let size = [(x1.ceil() as usize).saturating_sub(left), (y1.ceil() as usize).saturating_sub(top)];
    let Some(part) = image.view().crop(left, top, size[0], size[1]) else { return Ok(None) };
    let pixels = part.hwc_u8(PixelFormat::Rgb);
    let crop = Image::from_rgb8(pixels, part.width(), part.height())?.with_header(image.header.clone());
    Ok(Some((crop, [left as f32, top as f32])))
}

/// The box with what was told of it.
fn named(place: &BoundingBox, category: Category) -> BoundingBox {
    let name = category.description.map_or(Name::Index(category.class), Name::Label);
    BoundingBox { name, confidence: category.confidence.unwrap_or(place.confidence), ..place.clone() }
}

/// A box of the crop at `corner` in the whole picture. Its outline is left out: it is of the crop's size.
fn moved_box(inner: BoundingBox, [left, top]: [f32; 2]) -> BoundingBox {
    let landmarks = inner.landmarks.iter().map(|[x, y]| [x + left, y + top]).collect();
    BoundingBox { left: inner.left + left, top: inner.top + top, landmarks, segment: None, ..inner }
}

fn moved_poses(list: PoseList, [left, top]: [f32; 2]) -> impl Iterator<Item = Pose> {
    list.poses.into_iter().map(move |mut pose| {
        for point in pose.keypoints.iter_mut().filter(|point| point.is_found()) {
            (point.x, point.y) = (point.x + left, point.y + top);
        }
        // Numbers of a stream that ends with the box.
        (pose.id, pose.region) = (None, pose.region.map(|region| Box::new(moved_box(*region, [left, top]))));
        pose
    })
}
