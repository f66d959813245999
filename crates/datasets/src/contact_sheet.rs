//! Contact sheets: images of a data set with their annotations.

use opendr_engine::data::Image;
use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::{Error, Result, Value};
use opendr_vision::draw::{self, Style, draw};

use crate::clip::frame_of;
use crate::curve::curve;
use crate::from_above::from_above;
use crate::{Problem, Problems};

/// Side of an image on the sheet, in pixels.
const SIDE: usize = 300;

/// Draws the samples of a data set with their annotations and names on one image, up to six in a row.
///
/// # Errors
/// `Unsupported` if no sample can be drawn; the error of the first sample that cannot be read, unless `problems`
/// skips it.
pub fn contact_sheet(dataset: &dyn DatasetIterator, problems: &Problems) -> Result<Image> {
    let mut pictures = Vec::new();
    for at in 0..dataset.len() {
        match dataset.get(at) {
            Ok(sample) => pictures.extend(draw_sample(&sample).map(|picture| (picture, dataset.name(at)))),
            Err(error) => {
                problems.report(Problem::of(&error, dataset, at))?;
            }
        }
    }
    if pictures.is_empty() {
        return Err(Error::unsupported(
            "no sample can be drawn; \"opendr data stats\" lists the types of the data set",
        ));
    }
    let columns = pictures.len().min(6);
    draw::contact_sheet(&pictures, columns, SIDE)
}

/// Draws the first datum of a sample that can be drawn, with the target: an image as it is, the middle frame of a
/// clip, audio and time series as curves, a point cloud in bird's eye view; `None` without such a datum.
pub fn draw_sample(sample: &Sample) -> Option<Image> {
    let mut picture = sample.data.iter().find_map(|datum| picture_of(datum, sample.target.as_ref()))?;
    // Lines are twice as thick, since the image is scaled down afterwards.
    let style = Style { show_confidences: false, scale: 2.0, ..Style::default() };
    for datum in &sample.data {
        if let Value::ImageWithDetections(both) = datum {
            draw(&mut picture, &both.boxes, &style);
        }
    }
    if let Some(target) = &sample.target {
        draw(&mut picture, target, &style);
    }
    Some(picture)
}

fn picture_of(datum: &Value, target: Option<&Value>) -> Option<Image> {
    match datum {
        Value::Image(image) => Some(image.clone()),
        Value::ImageWithDetections(both) => Some(both.image.clone()),
        Value::Video(clip) => frame_of(clip, clip.shape()[1] / 2).ok(),
        Value::Audio(audio) => curve(&audio.mono(), 1).ok(),
        Value::Timeseries(series) => curve(series.as_slice(), series.shape()[1]).ok(),
        other => from_above(other, target).ok().flatten(),
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::{Audio, PointCloud};
    use opendr_engine::dataset::Dataset;
    use opendr_engine::target::{BoundingBox, BoundingBoxList, Category};

    use super::*;

    struct Mixed;

    impl Dataset for Mixed {}

    impl DatasetIterator for Mixed {
        fn len(&self) -> usize {
            4
        }

        fn get(&self, index: usize) -> Result<Sample> {
            let black = || Image::from_rgb8(vec![0; 64 * 48 * 3], 64, 48);
            let boxes = BoundingBoxList::from(vec![BoundingBox::new("cat", 8.0, 8.0, 30.0, 30.0, 1.0)]);
            let (datum, target): (Value, Value) = match index {
                0 => (black()?.into(), boxes.into()),
                1 => (Audio::new(vec![0.0, 0.5, -0.5], 1, 8000)?.into(), Category::new(3, None).into()),
                2 => (PointCloud::new(vec![1.0, 2.0, 3.0], [1, 3])?.into(), Category::new(0, None).into()),
                _ => return Err(Error::format("cut off")),
            };
            Ok(Sample { data: vec![datum], target: Some(target) })
        }
    }

    #[test]
    fn all_types_that_can_be_drawn_are_on_the_sheet() {
        let sample = Mixed.get(0).unwrap();
        let drawn = draw_sample(&sample).unwrap();
        assert!(drawn.chw_u8().iter().any(|level| *level > 100));
        let problems = Problems::skipping();
        let sheet = contact_sheet(&Mixed, &problems).unwrap();
        assert!(sheet.width() > 3 * SIDE && sheet.width() < 4 * SIDE && problems.count() == 1);
        assert!(contact_sheet(&Mixed, &Problems::strict()).is_err());
        assert!(draw_sample(&Sample { data: vec![], target: None }).is_none());
    }
}
