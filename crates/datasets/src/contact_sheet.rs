//! What a data set looks like: pictures with their annotations.

use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::{Error, Result, Value};
use opendr_vision::draw::{self, Style, draw};

use crate::{Problem, Problems};

/// Side of a picture, pixels.
const SIDE: usize = 300;

/// Every sample of a data set that has a picture, drawn with its annotation and named; some six in a row.
///
/// # Errors
/// `Unsupported` when no sample has a picture; the first sample that cannot be read, unless `problems` skips them.
pub fn contact_sheet(
    dataset: &dyn DatasetIterator,
    problems: &Problems,
) -> Result<opendr_engine::data::Image> {
    let mut pictures = Vec::new();
    for at in 0..dataset.len() {
        match dataset.get(at) {
            Ok(sample) => {
                pictures.extend(picture_with_target(&sample).map(|picture| (picture, dataset.name(at))))
            }
            Err(error) => {
                let file = dataset.path(at).unwrap_or_else(|| dataset.name(at).into());
                problems.report(Problem::new(file, error.to_string()))?;
            }
        }
    }
    if pictures.is_empty() {
        return Err(Error::unsupported(
            "there is no picture to look at; \"opendr data stats\" tells what there is",
        ));
    }
    let columns = pictures.len().min(6);
    draw::contact_sheet(&pictures, columns, SIDE)
}

/// The first picture of a sample with its target drawn onto it.
pub fn picture_with_target(sample: &Sample) -> Option<opendr_engine::data::Image> {
    let mut picture = sample.data.iter().find_map(|datum| match datum {
        Value::Image(image) => Some(image.clone()),
        _ => None,
    })?;
    if let Some(target) = &sample.target {
        // Twice as thick: the picture is made smaller after.
        draw(&mut picture, target, &Style { confidences: false, scale: 2.0, ..Style::default() });
    }
    Some(picture)
}
