//! Lines of YOLO label files: a class, then a box or a polygon in fractions of the image.

use opendr_engine::target::{BoundingBox, Segment, Segmentation};

use crate::fields::Fields;
use crate::picture_box::leaves_picture;

/// Tolerance of fractions for rounding errors.
const SLACK: f32 = 0.01;

/// Parses `class x y width height` (centre and size), the same with a score, or `class x0 y0 x1 y1 x2 y2 ...`.
pub(crate) fn box_from_line(
    line: &str,
    size: [u32; 2],
    class_from_number: impl Fn(i64) -> Result<i64, String>,
) -> Result<BoundingBox, String> {
    let fields = Fields::of(line);
    let class = class_from_number(fields.whole(0)?)?;
    let [width, height] = size.map(|side| side as f32);
    match fields.len() {
        5 | 6 => {
            let [x, y, across, down] = fields.numbers(1)?;
            if across < 0.0 || down < 0.0 {
                return Err(format!("has a box of {across} x {down}; width and height must be positive"));
            }
            let unit = [x - across / 2.0, y - down / 2.0, across, down];
            let in_pixels = [unit[0] * width, unit[1] * height, across * width, down * height];
            if leaves_picture(in_pixels, size) || across > 1.0 + SLACK || down > 1.0 + SLACK {
                return Err(format!(
                    "has a box outside of its image ({x} {y} {across} {down}); write fractions of the image, 0 to 1"
                ));
            }
            let confidence = if fields.len() == 6 { fields.number(5)? } else { 1.0 };
            let [left, top, across, down] = in_pixels;
            Ok(BoundingBox::new(class, left, top, across, down, confidence))
        }
        count if count >= 7 && count % 2 == 1 => {
            let numbers = (1..count).map(|at| fields.number(at)).collect::<Result<Vec<_>, _>>()?;
            if let Some(outside) = numbers.iter().find(|number| !(-SLACK..=1.0 + SLACK).contains(*number)) {
                return Err(format!(
                    "has a corner outside of its image ({outside}); write fractions of the image, 0 to 1"
                ));
            }
            let corners = numbers.chunks_exact(2).flat_map(|point| [point[0] * width, point[1] * height]);
            Ok(box_around(class, corners.collect()))
        }
        count => {
            Err(format!("has {count} fields; write a class and 4 numbers, or a class and 3 or more corners"))
        }
    }
}

fn box_around(class: i64, polygon: Vec<f32>) -> BoundingBox {
    let side = |start: usize| {
        let numbers = polygon.iter().copied().skip(start).step_by(2);
        let (low, high) =
            (numbers.clone().fold(f32::INFINITY, f32::min), numbers.fold(f32::NEG_INFINITY, f32::max));
        (low, high)
    };
    let ((left, right), (top, bottom)) = (side(0), side(1));
    let area = polygon_area(&polygon);
    let segment = Segment { segmentation: Segmentation::Polygons(vec![polygon]), area, iscrowd: false };
    BoundingBox {
        segment: Some(Box::new(segment)),
        ..BoundingBox::from_corners(class, [left, top, right, bottom], 1.0)
    }
}

/// Returns the area in square pixels, by the shoelace formula.
fn polygon_area(polygon: &[f32]) -> f32 {
    let corner = |at: usize| {
        let start = at * 2 % polygon.len();
        (f64::from(polygon[start]), f64::from(polygon[start + 1]))
    };
    let cross = |at: usize| {
        let ((x0, y0), (x1, y1)) = (corner(at), corner(at + 1));
        x0 * y1 - x1 * y0
    };
    ((0..polygon.len() / 2).map(cross).sum::<f64>() / 2.0).abs() as f32
}

/// Returns the line of a box, or of its polygon if `outlined` (its corners if it has no polygons); `None` for a
/// crowd.
pub(crate) fn line_from_box(
    found: &BoundingBox,
    class: usize,
    size: [u32; 2],
    outlined: bool,
) -> Option<String> {
    let segment = found.segment.as_deref();
    if segment.is_some_and(|segment| segment.iscrowd) {
        return None;
    }
    let [width, height] = size.map(f64::from);
    let [x0, y0, x1, y1] = found.corners();
    let mut line = class.to_string();
    let mut push =
        |pixels: f64, side: f64| line.push_str(&format!(" {}", rounded((pixels / side).clamp(0.0, 1.0))));
    if !outlined {
        let [x0, x1] = [x0, x1].map(|x| f64::from(x).clamp(0.0, width));
        let [y0, y1] = [y0, y1].map(|y| f64::from(y).clamp(0.0, height));
        push((x0 + x1) / 2.0, width);
        push((y0 + y1) / 2.0, height);
        push(x1 - x0, width);
        push(y1 - y0, height);
        return Some(line);
    }
    let corners = match segment.map(|segment| &segment.segmentation) {
        Some(Segmentation::Polygons(polygons)) if !polygons.is_empty() => joined(polygons),
        _ => vec![x0, y0, x1, y0, x1, y1, x0, y1],
    };
    for point in corners.chunks_exact(2) {
        push(point[0].into(), width);
        push(point[1].into(), height);
    }
    Some(line)
}

/// Rounds to nine decimals.
fn rounded(number: f64) -> f64 {
    (number * 1e9).round() / 1e9
}

/// Joins several polygons into one: each is connected to the first corner by a line that is used in both
/// directions.
fn joined(polygons: &[Vec<f32>]) -> Vec<f32> {
    let Some((first, rest)) = polygons.split_first() else { return Vec::new() };
    let start = first.get(..2).unwrap_or_default();
    let mut all = first.clone();
    for polygon in rest {
        all.extend_from_slice(start);
        all.extend_from_slice(polygon);
        all.extend_from_slice(polygon.get(..2).unwrap_or_default());
    }
    all
}
