//! Text in images.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::numpy_text::python_float;
use crate::target::json_number::null_as_nan;
use crate::target::{Action, mean};

/// A line of text in an image and where it is.
///
/// `{}` writes the text, `{:#}` one readable line.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TextRegion {
    /// Recognised text; [`TextRegion::ILLEGIBLE`] in the annotation of a text that cannot be read.
    pub text: String,
    /// Corners in pixels, clockwise as the text is read: those at its top left, top right, bottom right and bottom left.
    #[serde(deserialize_with = "null_as_nan")]
    pub corners: [[f32; 2]; 4],
    /// Score of the text, 0..=1.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub confidence: f32,
}

impl TextRegion {
    /// Text of annotated regions that nobody can read (ICDAR's convention).
    pub const ILLEGIBLE: &str = "###";

    /// Creates a region from its text, corners and score.
    pub fn new(text: impl Into<String>, corners: [[f32; 2]; 4], confidence: f32) -> Self {
        Self { text: text.into(), corners, confidence }
    }

    /// Returns the upright box `[left, top, width, height]` around the corners, in pixels.
    pub fn bounding_box(&self) -> [f32; 4] {
        let [first, ..] = self.corners;
        let [x0, y0, x1, y1] =
            self.corners.iter().fold([first[0], first[1], first[0], first[1]], |[x0, y0, x1, y1], [x, y]| {
                [x0.min(*x), y0.min(*y), x1.max(*x), y1.max(*y)]
            });
        [x0, y0, x1 - x0, y1 - y0]
    }
}

/// The lines of text in an image, in reading order.
///
/// `{}` writes a line per region: text, confidence and corners; `{:#}` readable lines.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TextRegionList {
    /// Header of the image.
    #[serde(flatten)]
    pub header: Header,
    /// Regions in reading order.
    pub regions: Vec<TextRegion>,
    /// Proposed camera motion for a better view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

target!(TextRegionList, |list| Some(mean(list.regions.iter().map(|region| region.confidence))));

impl From<Vec<TextRegion>> for TextRegionList {
    fn from(regions: Vec<TextRegion>) -> Self {
        Self { regions, ..Self::default() }
    }
}

impl fmt::Display for TextRegion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() {
            return f.write_str(&self.text);
        }
        let [left, top, width, height] = self.bounding_box();
        write!(
            f,
            "{:?} {:.2} at left {left:.1} top {top:.1} width {width:.1} height {height:.1}",
            self.text, self.confidence
        )
    }
}

impl fmt::Display for TextRegionList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for region in &self.regions {
            if f.alternate() {
                writeln!(f, "{region:#}")?;
                continue;
            }
            write!(f, "{} {}", region.text, python_float(region.confidence))?;
            region.corners.iter().flatten().try_for_each(|number| write!(f, " {}", python_float(*number)))?;
            writeln!(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts() {
        let corners = [[1.0, 2.0], [11.0, 3.5], [10.0, 8.0], [0.5, 7.0]];
        let list = TextRegionList::from(vec![TextRegion::new("No exit", corners, 0.75)]);
        assert_eq!(list.to_string(), "No exit 0.75 1.0 2.0 11.0 3.5 10.0 8.0 0.5 7.0\n");
        assert_eq!(format!("{list:#}"), "\"No exit\" 0.75 at left 0.5 top 2.0 width 10.5 height 6.0\n");
        assert_eq!(list.regions[0].to_string(), "No exit");
    }

    #[test]
    fn json() {
        let region = TextRegion::new("A", [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, f32::NAN]], 0.5);
        let text = serde_json::to_string(&region).unwrap();
        assert_eq!(
            text,
            r#"{"text":"A","corners":[[0.0,0.0],[4.0,0.0],[4.0,2.0],[0.0,null]],"confidence":0.5}"#
        );
        assert!(serde_json::from_str::<TextRegion>(&text).unwrap().corners[3][1].is_nan());
    }
}
