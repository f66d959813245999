//! Conversion of boxes to and from the rows of the MOT Challenge.
//!
//! A row is `frame, left, top, width, height, confidence` for boxes and `frame, id, left, top, width, height,
//! confidence` for tracks; an image without a frame number is frame -1. OpenDR's `with_confidence=False` is the row
//! without its last element.

use std::fmt::Write as _;

use crate::target::convert::table::Row;
use crate::target::{BoundingBox, BoundingBoxList, Name, TrackingAnnotation, TrackingAnnotationList};
use crate::{Error, Result};

fn frame_number(frame: Option<i64>) -> f32 {
    frame.unwrap_or(-1) as f32
}

/// Converts a frame number; numbers below 0 mean none.
fn frame(number: i64) -> Option<i64> {
    (number >= 0).then_some(number)
}

/// Checks the length of a row and that its numbers are finite.
fn finite(row: &[f32], counts: std::ops::RangeInclusive<usize>) -> Result<()> {
    if counts.contains(&row.len()) && row.iter().all(|number| number.is_finite()) {
        return Ok(());
    }
    Err(Error::invalid_input(format!(
        "{row:?} is not a MOT row; give {} to {} finite numbers",
        counts.start(),
        counts.end()
    )))
}

impl BoundingBox {
    /// Returns the row `[frame, left, top, width, height, confidence]`.
    pub fn mot(&self, frame: Option<i64>) -> [f32; 6] {
        [frame_number(frame), self.left, self.top, self.width, self.height, self.confidence]
    }

    /// Returns frame and box of a row `[frame, left, top, width, height]`, optionally with a confidence (default 1).
    ///
    /// # Errors
    /// Returns `InvalidInput` for another number of elements, or one that is not finite.
    pub fn from_mot(row: &[f32]) -> Result<(Option<i64>, Self)> {
        finite(row, 5..=6)?;
        let confidence = row.get(5).copied().unwrap_or(1.0);
        Ok((frame(row[0] as i64), Self::new(0, row[1], row[2], row[3], row[4], confidence)))
    }
}

impl BoundingBoxList {
    /// Returns a row per box, see [`BoundingBox::mot`].
    pub fn mot(&self, frame: Option<i64>) -> Vec<[f32; 6]> {
        self.boxes.iter().map(|found| found.mot(frame)).collect()
    }
}

impl TrackingAnnotation {
    /// Returns the row `[frame, id, left, top, width, height, confidence]`.
    pub fn mot(&self) -> [f32; 7] {
        let [frame, left, top, width, height, confidence] = self.bounding_box.mot(self.frame);
        [frame, self.id as f32, left, top, width, height, confidence]
    }

    /// Creates an annotation of class 0 from a row `[frame, id, left, top, width, height]`, optionally with a confidence
    /// (default 1). Further elements are ignored.
    ///
    /// # Errors
    /// Returns `InvalidInput` for fewer than 6 elements, more than 10, or one that is not finite.
    pub fn from_mot(row: &[f32]) -> Result<Self> {
        finite(row, 6..=10)?;
        let confidence = row.get(6).copied().unwrap_or(1.0);
        let bounding_box = BoundingBox::new(0, row[2], row[3], row[4], row[5], confidence);
        Ok(Self { bounding_box, id: row[1] as i64, frame: frame(row[0] as i64) })
    }
}

impl TrackingAnnotationList {
    /// Returns a row per object, see [`TrackingAnnotation::mot`].
    pub fn mot(&self) -> Vec<[f32; 7]> {
        self.annotations.iter().map(TrackingAnnotation::mot).collect()
    }

    /// Creates a list from rows, see [`TrackingAnnotation::from_mot`].
    ///
    /// # Errors
    /// Returns `InvalidInput` for an invalid row.
    pub fn from_mot<'a>(rows: impl IntoIterator<Item = &'a [f32]>) -> Result<Self> {
        rows.into_iter().map(TrackingAnnotation::from_mot).collect::<Result<Vec<_>>>().map(Self::from)
    }

    /// Parses a file of the MOT Challenge: 6 to 10 fields per line, separated by commas or spaces.
    ///
    /// In lines of 8 or 9 fields (ground truth) the eighth is the class; in lines of 10 fields (detections, results) the last
    /// three are ignored. Coordinates are not changed, although the challenge counts pixels from 1.
    ///
    /// # Errors
    /// Returns `Format` with the line number.
    pub fn from_mot_text(text: &str) -> Result<Self> {
        let tracks = Row::all(text, Some(',')).map(|row| {
            row.expect(6..=10)?;
            let [left, top, width, height] = row.numbers(2)?;
            let confidence = if row.len() > 6 { row.number(6)? } else { 1.0 };
            let class = if matches!(row.len(), 8 | 9) { row.whole(7)? } else { 0 };
            Ok(TrackingAnnotation {
                bounding_box: BoundingBox::new(Name::Index(class), left, top, width, height, confidence),
                id: row.whole(1)?,
                frame: frame(row.whole(0)?),
            })
        });
        tracks.collect::<Result<Vec<_>>>().map(Self::from)
    }

    /// Returns the text of a results file of the MOT Challenge: 10 fields per line, of which the last three are -1.
    pub fn mot_text(&self) -> String {
        let mut text = String::new();
        for TrackingAnnotation { bounding_box: found, id, frame } in &self.annotations {
            let frame = frame.unwrap_or(-1);
            let BoundingBox { left, top, width, height, confidence, .. } = found;
            // Writing to a String cannot fail.
            writeln!(text, "{frame},{id},{left},{top},{width},{height},{confidence},-1,-1,-1").ok();
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_both_ways() {
        let row = [3.0, 7.0, 10.0, 20.5, 30.0, 40.0, 0.9];
        let track = TrackingAnnotation::from_mot(&row).unwrap();
        assert_eq!(track.mot(), row);
        assert_eq!(track.to_string(), "[ 3.   7.  10.  20.5 30.  40.   0.9]");
        assert_eq!(format!("{track:#}"), "#7 class 0 0.90 at left 10.0 top 20.5 width 30.0 height 40.0");
        assert_eq!(TrackingAnnotation::from_mot(&row[..6]).unwrap().bounding_box.confidence, 1.0);
        let (frame, found) = BoundingBox::from_mot(&[-1.0, 1.0, 2.0, 3.0, 4.0, 0.5]).unwrap();
        assert_eq!((frame, found.mot(frame)), (None, [-1.0, 1.0, 2.0, 3.0, 4.0, 0.5]));
        assert!(BoundingBox::from_mot(&[f32::NAN; 6]).is_err());
        assert!(TrackingAnnotation::from_mot(&[0.0; 5]).is_err());
    }

    #[test]
    fn files_both_ways() {
        let ground_truth = "1,2,10.5,20,30,40,1,7,0.5\n\n2, 2, 11, 20, 30, 40, 0, 1, 1\r\n";
        let tracks = TrackingAnnotationList::from_mot_text(ground_truth).unwrap();
        assert_eq!(tracks.annotations.len(), 2);
        assert_eq!(tracks.annotations[0].bounding_box, BoundingBox::new(7, 10.5, 20.0, 30.0, 40.0, 1.0));
        assert_eq!(tracks.annotations[1].frame, Some(2));
        let text = tracks.mot_text();
        assert_eq!(text.lines().next(), Some("1,2,10.5,20,30,40,1,-1,-1,-1"));
        assert_eq!(TrackingAnnotationList::from_mot_text(&text).unwrap().mot(), tracks.mot());
    }

    #[test]
    fn errors_state_the_line() {
        for (text, expected) in [
            ("1,2,3,4,5,6\n1,2,3", "line 2 has 3 fields"),
            ("1,2,3,4,5,inf", "line 1 has \"inf\" in field 6"),
            ("\n1,x,3,4,5,6", "line 2 has \"x\" in field 2"),
            ("1.5,2,3,4,5,6", "line 1 has \"1.5\" in field 1"),
        ] {
            let error = TrackingAnnotationList::from_mot_text(text).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
        }
    }
}
