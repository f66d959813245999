//! Prompts: points and boxes.

use opendr_engine::target::BoundingBox;
use opendr_engine::{Error, Result};

/// Label of a point that fills the place of a box, and of points outside and on the object; labels of the corners of a box.
pub(super) const NO_POINT: i64 = -1;
const OUTSIDE: i64 = 0;
const INSIDE: i64 = 1;
const CORNERS: [i64; 2] = [2, 3];

/// Maximum number of points of an object.
const MAX_POINTS: usize = 1000;

/// A point of a prompt, in pixels of the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PromptPoint {
    pub(super) position: [f32; 2],
    pub(super) label: i64,
}

/// What describes an object.
#[derive(Debug, Clone, Copy)]
pub(super) enum Prompt<'a> {
    /// Points on it and outside.
    Points(&'a [PromptPoint]),
    /// The corners of a box around it.
    Box([PromptPoint; 2]),
}

impl Prompt<'_> {
    /// Returns the prompt of a box; `None` for a damaged one.
    pub(super) fn of_box(found: &BoundingBox) -> Option<Self> {
        let [left, top, right, bottom] = found.corners();
        let is_box = [left, top, right, bottom].iter().all(|edge| edge.is_finite())
            && found.width > 0.0
            && found.height > 0.0;
        let corners = [[left, top], [right, bottom]];
        let point = |at: usize| PromptPoint { position: corners[at], label: CORNERS[at] };
        is_box.then(|| Self::Box([point(0), point(1)]))
    }

    /// Returns the points, those of a box being its corners.
    pub(super) fn points(&self) -> &[PromptPoint] {
        match self {
            Self::Points(points) => points,
            Self::Box(corners) => corners,
        }
    }

    /// Returns whether several objects fit the prompt, such as a part and the whole: it is a single point.
    pub(super) fn is_ambiguous(&self) -> bool {
        matches!(self, Self::Points([_]))
    }
}

/// Parses points `x,y` or `x,y,label`, separated by semicolons.
///
/// # Errors
/// `InvalidParam` for other texts.
pub(super) fn parse_points(text: &str, points: &mut Vec<PromptPoint>) -> Result<()> {
    points.clear();
    for part in text.split(';').filter(|part| !part.trim().is_empty()) {
        let point = parse_point(part).filter(|_| points.len() < MAX_POINTS);
        points.push(point.ok_or_else(|| {
            Error::invalid_param(format!(
                "points: \"{part:.40}\" is not a point; write up to {MAX_POINTS} as x,y or x,y,label with label 1 (on the object) or 0 \
                 (outside), separated by semicolons, such as 320,240;100,80,0"
            ))
        })?);
    }
    Ok(())
}

fn parse_point(text: &str) -> Option<PromptPoint> {
    let mut fields = text.split(',').map(str::trim);
    let mut coordinate = || fields.next()?.parse::<f32>().ok().filter(|value| value.is_finite());
    let position = [coordinate()?, coordinate()?];
    let label = match (fields.next(), fields.next()) {
        (None | Some("1"), None) => INSIDE,
        (Some("0"), None) => OUTSIDE,
        _ => return None,
    };
    Some(PromptPoint { position, label })
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::ErrorKind;

    #[test]
    fn points_are_parsed() {
        let mut points = vec![PromptPoint { position: [9.0; 2], label: 9 }];
        parse_points(" 320,240; 10.5 , 80,0;-1,2,1;", &mut points).unwrap();
        let found: Vec<_> = points.iter().map(|point| (point.position, point.label)).collect();
        assert_eq!(found, [([320.0, 240.0], 1), ([10.5, 80.0], 0), ([-1.0, 2.0], 1)]);
        parse_points("", &mut points).unwrap();
        assert!(points.is_empty());
        for text in ["1", "1,2,3", "1,2,1,0", "a,b", "1,nan", "1,inf", "1,2;x", &"1,1;".repeat(1001)] {
            let error = parse_points(text, &mut points).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidParam, "{text:.20}");
        }
    }

    #[test]
    fn boxes_are_corners() {
        let found = BoundingBox::new(0, 10.0, 20.0, 30.0, 40.0, 0.5);
        let prompt = Prompt::of_box(&found).unwrap();
        assert_eq!(prompt.points()[0], PromptPoint { position: [10.0, 20.0], label: 2 });
        assert_eq!(prompt.points()[1], PromptPoint { position: [40.0, 60.0], label: 3 });
        assert!(!prompt.is_ambiguous() && Prompt::Points(&prompt.points()[..1]).is_ambiguous());
        for [width, height] in [[0.0, 5.0], [5.0, -1.0], [f32::NAN, 5.0], [f32::INFINITY, 5.0]] {
            assert!(Prompt::of_box(&BoundingBox { width, height, ..BoundingBox::default() }).is_none());
        }
    }
}
