//! Transformation of boxes with their landmarks and masks.

use opendr_engine::Result;
use opendr_engine::target::{BoundingBox, Rle, Segment, Segmentation};

use crate::augment::picture::border::Border;
use crate::augment::picture::map::AffineMap;
use crate::augment::picture::polygons;
use crate::augment::picture::warp::nearest_plane;

/// Unknown coordinates in data sets.
const UNKNOWN: [f32; 2] = [-1.0; 2];

/// Order of the landmarks of a mirrored face: two eyes, nose, two corners of the mouth.
const MIRRORED_FACE: [usize; 5] = [1, 0, 2, 4, 3];

/// Transforms a box; returns `false` if too little of it is left.
pub(super) fn map_box(object: &mut BoundingBox, map: &AffineMap, border: &Border) -> Result<bool> {
    let whole = whole_box(object, map);
    let size = map.output_size().map(|side| side as f64);
    let cut: [f64; 4] = std::array::from_fn(|edge| whole[edge].clamp(0.0, size[edge % 2]));
    let area = |[x0, y0, x1, y1]: [f64; 4]| (x1 - x0).max(0.0) * (y1 - y0).max(0.0);
    let visible = area(cut) / area(whole);
    // NaN, from a box without an area, is not visible.
    if !(visible > 0.0 && visible >= f64::from(border.min_visible)) {
        return Ok(false);
    }
    let [x0, y0, x1, y1] = cut.map(|edge| edge as f32);
    (object.left, object.top, object.width, object.height) = (x0, y0, x1 - x0, y1 - y0);
    map_landmarks(object, map);
    match &mut object.segment {
        Some(segment) => map_segment(segment, map),
        None => Ok(true),
    }
}

/// Returns the transformed box without clipping: around its outline if it has one and the map rotates, otherwise
/// around its corners.
fn whole_box(object: &BoundingBox, map: &AffineMap) -> [f64; 4] {
    let outline = match object.segment.as_deref() {
        Some(Segment { segmentation: Segmentation::Polygons(outlines), .. })
            if map.along_axes().is_none() =>
        {
            let points: Vec<_> = outlines.iter().flat_map(|outline| polygons::mapped(outline, map)).collect();
            polygons::bounds(&points)
        }
        _ => None,
    };
    let [x0, y0, x1, y1] = object.corners().map(f64::from);
    let corners = [[x0, y0], [x1, y0], [x0, y1], [x1, y1]].map(|corner| map.output_from_input(corner));
    outline.or_else(|| polygons::bounds(&corners)).unwrap_or_default()
}

fn map_landmarks(object: &mut BoundingBox, map: &AffineMap) {
    let size = map.output_size().map(|side| side as f32);
    for landmark in object.landmarks.iter_mut().filter(|landmark| landmark.iter().all(|part| *part >= 0.0)) {
        let place = map.output_from_input(landmark.map(f64::from)).map(|part| part as f32);
        let inside = (0..2).all(|axis| (0.0..=size[axis]).contains(&place[axis]));
        *landmark = if inside { place } else { UNKNOWN };
    }
    if map.mirrors() && object.landmarks.len() == MIRRORED_FACE.len() {
        let before = object.landmarks.clone();
        object.landmarks = MIRRORED_FACE.iter().map(|joint| before[*joint]).collect();
    }
}

/// Transforms a mask and its area; returns `false` if no pixel is left of a mask that was not empty.
fn map_segment(segment: &mut Segment, map: &AffineMap) -> Result<bool> {
    match &mut segment.segmentation {
        Segmentation::Polygons(outlines) => {
            let had_some = !outlines.is_empty();
            let (mut whole, mut left) = (0.0, 0.0);
            let cut = outlines.iter().map(|outline| {
                let outline = polygons::mapped(outline, map);
                whole += polygons::area(&outline);
                let outline = polygons::clipped(outline, map.output_size());
                left += polygons::area(&outline);
                outline.into_flattened().into_iter().map(|part| part as f32).collect::<Vec<_>>()
            });
            *outlines = cut.filter(|outline| outline.len() >= 6).collect();
            if whole > 0.0 {
                segment.area *= (left / whole * map.determinant().abs()) as f32;
            }
            Ok(!had_some || left > 0.0)
        }
        Segmentation::Rle(runs) => {
            let had_some = runs.area() > 0;
            *runs = map_rle(runs, map)?;
            segment.area = runs.area() as f32;
            Ok(!had_some || runs.area() > 0)
        }
    }
}

fn map_rle(runs: &Rle, map: &AffineMap) -> Result<Rle> {
    let [height, width] = runs.size();
    let map = map.for_size([width as usize, height as usize]);
    let [columns, rows] = map.output_size();
    Rle::from_mask(&nearest_plane(&runs.mask()?, &map, false)?, rows as u32, columns as u32)
}
