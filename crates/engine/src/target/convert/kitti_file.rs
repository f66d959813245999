//! Conversion of 3D boxes to and from KITTI's label files.
//!
//! A line of the detection benchmark has type, truncated, occluded, alpha, left, top, right, bottom, **height, width,
//! length**, x, y, z, rotation_y and, in results, a score. The tracking benchmark writes frame and identity before it.
//! [`BoundingBox3D::dimensions`] has OpenDR's order length, height, width; these functions reorder.

use std::fmt::Write as _;

use crate::Result;
use crate::target::convert::table::Row;
use crate::target::{BoundingBox3D, BoundingBox3DList, Name, TrackingAnnotation3D, TrackingAnnotation3DList};

fn box_from_row(row: &Row<'_>, first: usize) -> Result<BoundingBox3D> {
    let [height, width, length] = row.numbers(first + 8)?;
    Ok(BoundingBox3D {
        name: Name::from(row.text(first)?),
        truncated: row.number(first + 1)?,
        occluded: row.whole(first + 2)?.clamp(-1, 3) as i32,
        alpha: row.number(first + 3)?,
        bbox2d: row.numbers(first + 4)?,
        dimensions: [length, height, width],
        location: row.numbers(first + 11)?,
        rotation_y: row.number(first + 14)?,
        confidence: if row.len() > first + 15 { row.number(first + 15)? } else { 1.0 },
    })
}

/// Writes the fields of a line; spaces within a label become `_`, as in KITTI.
fn write_box(found: &BoundingBox3D, text: &mut String) {
    let BoundingBox3D { truncated, occluded, alpha, rotation_y, confidence, .. } = found;
    let name: Vec<_> = found.name.to_string().split_whitespace().map(str::to_owned).collect();
    let name = if name.is_empty() { "DontCare".to_owned() } else { name.join("_") };
    let ([x0, y0, x1, y1], [length, height, width], [x, y, z]) =
        (found.bbox2d, found.dimensions, found.location);
    // Writing to a String cannot fail.
    writeln!(
        text,
        "{name} {truncated} {occluded} {alpha} {x0} {y0} {x1} {y1} {height} {width} {length} {x} {y} {z} \
         {rotation_y} {confidence}"
    )
    .ok();
}

impl BoundingBox3DList {
    /// Parses a label or results file of the detection benchmark; the score of a label is 1.
    ///
    /// # Errors
    /// Returns `Format` with the line number.
    pub fn from_kitti_text(text: &str) -> Result<Self> {
        let boxes = Row::all(text, None).map(|row| {
            row.expect(15..=16)?;
            box_from_row(&row, 0)
        });
        boxes.collect::<Result<Vec<_>>>().map(Self::from)
    }

    /// Returns the text of a results file of the detection benchmark.
    pub fn kitti_text(&self) -> String {
        let mut text = String::new();
        self.boxes.iter().for_each(|found| write_box(found, &mut text));
        text
    }
}

impl TrackingAnnotation3DList {
    /// Parses a label or results file of the tracking benchmark; the score of a label is 1.
    ///
    /// # Errors
    /// Returns `Format` with the line number.
    pub fn from_kitti_text(text: &str) -> Result<Self> {
        let tracks = Row::all(text, None).map(|row| {
            row.expect(17..=18)?;
            let frame = Some(row.whole(0)?).filter(|frame| *frame >= 0);
            Ok(TrackingAnnotation3D { bounding_box_3d: box_from_row(&row, 2)?, id: row.whole(1)?, frame })
        });
        tracks.collect::<Result<Vec<_>>>().map(Self::from)
    }

    /// Returns the text of a results file of the tracking benchmark.
    pub fn kitti_text(&self) -> String {
        let mut text = String::new();
        for TrackingAnnotation3D { bounding_box_3d, id, frame } in &self.annotations {
            // Writing to a String cannot fail.
            write!(text, "{} {id} ", frame.unwrap_or(-1)).ok();
            write_box(bounding_box_3d, &mut text);
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LABELS: &str = "Car 0.25 1 -1.5 599.5 156.25 629.75 189.5 2.5 1.5 3.5 -16 2.5 58.5 -1.25\n\
                          DontCare -1 -1 -10 503 169 590 190 -1 -1 -1 -1000 -1000 -1000 -10\n";

    #[test]
    fn files_both_ways() {
        let boxes = BoundingBox3DList::from_kitti_text(LABELS).unwrap();
        assert_eq!(boxes.boxes[0].dimensions, [3.5, 2.5, 1.5]);
        assert_eq!(boxes.boxes[0].confidence, 1.0);
        assert_eq!(BoundingBox3DList::from_kitti_text(&boxes.kitti_text()).unwrap(), boxes);
        let tracks: String = LABELS.lines().map(|line| format!("4 7 {line} 0.5\n")).collect();
        let tracks = TrackingAnnotation3DList::from_kitti_text(&tracks).unwrap();
        assert_eq!((tracks.annotations[1].id, tracks.annotations[1].frame), (7, Some(4)));
        assert_eq!(TrackingAnnotation3DList::from_kitti_text(&tracks.kitti_text()).unwrap(), tracks);
    }

    #[test]
    fn errors_state_the_line() {
        let error = BoundingBox3DList::from_kitti_text(&format!("{LABELS}Car 1 2")).unwrap_err();
        assert!(error.to_string().starts_with("line 3 has 3 fields instead of 15 to 16"), "{error}");
        let error = BoundingBox3DList::from_kitti_text(&LABELS.replace("58.5", "NaN")).unwrap_err();
        assert!(error.to_string().starts_with("line 1 has \"NaN\" in field 14"), "{error}");
    }
}
