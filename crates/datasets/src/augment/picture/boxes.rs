//! Boxes, with their landmarks and outlines, under a map.

use opendr_engine::Result;
use opendr_engine::target::{BoundingBox, Rle, Segment, Segmentation};

use crate::augment::picture::border::Border;
use crate::augment::picture::map::PictureMap;
use crate::augment::picture::polygons;
use crate::augment::picture::warp::nearest_plane;

/// A place that is not known, as data sets write it.
const UNKNOWN: [f32; 2] = [-1.0; 2];

/// Two eyes, nose, two corners of the mouth: which landmark a mirror makes of each.
const MIRRORED_FACE: [usize; 5] = [1, 0, 2, 4, 3];

/// Maps a box; `false` when too little of it is left.
pub(super) fn follow_box(found: &mut BoundingBox, map: &PictureMap, border: &Border) -> Result<bool> {
    let whole = whole_box(found, map);
    let size = map.output_size().map(|side| side as f64);
    let cut: [f64; 4] = std::array::from_fn(|edge| whole[edge].clamp(0.0, size[edge % 2]));
    let area = |[x0, y0, x1, y1]: [f64; 4]| (x1 - x0).max(0.0) * (y1 - y0).max(0.0);
    let visible = area(cut) / area(whole);
    // NaN, from a box without an area, is not visible.
    if !(visible > 0.0 && visible >= f64::from(border.min_visible)) {
        return Ok(false);
    }
    let [x0, y0, x1, y1] = cut.map(|edge| edge as f32);
    (found.left, found.top, found.width, found.height) = (x0, y0, x1 - x0, y1 - y0);
    follow_landmarks(found, map);
    match &mut found.segment {
        Some(segment) => follow_segment(segment, map),
        None => Ok(true),
    }
}

/// The mapped box, not cut: around its outline where it has one and the map turns, else around its corners.
fn whole_box(found: &BoundingBox, map: &PictureMap) -> [f64; 4] {
    let outline = match found.segment.as_deref() {
        Some(Segment { segmentation: Segmentation::Polygons(outlines), .. })
            if map.along_axes().is_none() =>
        {
            let points: Vec<_> = outlines.iter().flat_map(|outline| polygons::mapped(outline, map)).collect();
            polygons::bounds(&points)
        }
        _ => None,
    };
    let [x0, y0, x1, y1] = found.corners().map(f64::from);
    let corners = [[x0, y0], [x1, y0], [x0, y1], [x1, y1]].map(|corner| map.output_from_input(corner));
    outline.or_else(|| polygons::bounds(&corners)).unwrap_or_default()
}

fn follow_landmarks(found: &mut BoundingBox, map: &PictureMap) {
    let size = map.output_size().map(|side| side as f32);
    for landmark in found.landmarks.iter_mut().filter(|landmark| landmark.iter().all(|part| *part >= 0.0)) {
        let place = map.output_from_input(landmark.map(f64::from)).map(|part| part as f32);
        let inside = (0..2).all(|axis| (0.0..=size[axis]).contains(&place[axis]));
        *landmark = if inside { place } else { UNKNOWN };
    }
    if map.mirrors() && found.landmarks.len() == MIRRORED_FACE.len() {
        let before = found.landmarks.clone();
        found.landmarks = MIRRORED_FACE.iter().map(|joint| before[*joint]).collect();
    }
}

/// Maps an outline and its area; `false` when no pixel is left of one that had some.
fn follow_segment(segment: &mut Segment, map: &PictureMap) -> Result<bool> {
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
            *runs = follow_runs(runs, map)?;
            segment.area = runs.area() as f32;
            Ok(!had_some || runs.area() > 0)
        }
    }
}

fn follow_runs(runs: &Rle, map: &PictureMap) -> Result<Rle> {
    let [height, width] = runs.size();
    let map = map.for_size([width as usize, height as usize]);
    let [columns, rows] = map.output_size();
    Rle::from_mask(&nearest_plane(&runs.mask()?, &map, false)?, rows as u32, columns as u32)
}
