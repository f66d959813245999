//! Values with nothing to find and everything to compute, for learners of which the zoo has no sample.

use std::f32::consts::TAU;

use opendr::data::{Audio, Image, Layout, PixelFormat, SkeletonSequence, Timeseries, Vector, Video};
use opendr::target::{BoundingBox, BoundingBoxList};
use opendr::{Error, Result, Value, ValueType};
use serde_json::{Map, Value as Json};

use super::seen::{HEIGHT, WIDTH};

/// Samples a second, and seconds, of a sound.
const SAMPLE_RATE: u32 = 16000;
const SOUND_S: usize = 10;
/// Frames of a moving skeleton, of a clip, and of boxes that move.
const FRAMES: usize = 32;
const CLIP_FRAMES: usize = 16;
/// Boxes in a frame.
const BOXES: usize = 25;

/// Values of the type for a model with such `inputs` in its manifest: more than one where they belong to a stream.
///
/// # Errors
/// `Unsupported` for a type that nothing can be drawn of.
pub fn values(kind: ValueType, inputs: &Map<String, Json>) -> Result<Vec<Value>> {
    let number = |key: &str, otherwise: usize| {
        let number = inputs.get(kind.port()).and_then(|input| input.get(key)).and_then(Json::as_u64);
        number.map_or(otherwise, |number| number as usize)
    };
    let size = |at: usize, otherwise: usize| {
        let size = inputs.get(kind.port()).and_then(|input| input.get("size")?.get(at)?.as_u64());
        size.map_or(otherwise, |size| size as usize)
    };
    Ok(match kind {
        ValueType::Image => vec![picture()?.into()],
        ValueType::Audio => {
            let count = SAMPLE_RATE as usize * SOUND_S;
            vec![Audio::new(wave(count, SAMPLE_RATE as f32 / 220.0), 1, SAMPLE_RATE)?.into()]
        }
        ValueType::Timeseries => {
            let shape = [size(0, 140), size(1, 1)];
            vec![Timeseries::new(wave(shape.iter().product(), 70.0), shape)?.into()]
        }
        ValueType::Vector => vec![Vector::from_data(wave(size(0, 1), 10.0))?.into()],
        ValueType::SkeletonSequence => {
            let shape = [1, number("channels", 2), FRAMES, number("joints", 15), 1];
            vec![SkeletonSequence::new(wave(shape.iter().product(), 40.0), shape)?.into()]
        }
        ValueType::Video => {
            let side = size(0, 160);
            let shape = [3, number("frames", CLIP_FRAMES), side, size(1, side)];
            vec![Video::new(wave(shape.iter().product(), 90.0), shape)?.into()]
        }
        ValueType::BoundingBoxList => (0..FRAMES).map(|frame| boxes(frame).into()).collect(),
        other => {
            let name = other.name();
            return Err(Error::unsupported(format!(
                "nothing is drawn for an input {name}; name a file of it"
            )));
        }
    })
}

/// A tone with its third, neither silent nor too loud.
fn wave(count: usize, period: f32) -> Vec<f32> {
    (0..count)
        .map(|at| 0.3 * (TAU * at as f32 / period).sin() + 0.1 * (TAU * at as f32 * 3.0 / period).cos())
        .collect()
}

/// Gradients and squares.
fn picture() -> Result<Image> {
    let pixel = |at: usize| {
        let (x, y) = (at % WIDTH, at / WIDTH);
        let square = if (x / 64 + y / 64) % 2 == 0 { 200 } else { 40 };
        [(x * 255 / WIDTH) as u8, (y * 255 / HEIGHT) as u8, square]
    };
    let samples: Vec<u8> = (0..WIDTH * HEIGHT).flat_map(pixel).collect();
    Image::new(samples, WIDTH, HEIGHT, PixelFormat::Rgb, Layout::Hwc)
}

/// Boxes that go to the right, each at its own pace.
fn boxes(frame: usize) -> BoundingBoxList {
    let boxes = (0..BOXES).map(|at| {
        let (row, column) = (at / 5, at % 5);
        let left = column as f32 * 300.0 + frame as f32 * (1.0 + row as f32);
        BoundingBox::new(0, left, row as f32 * 200.0, 80.0, 160.0, 0.9)
    });
    boxes.collect::<Vec<_>>().into()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn values_have_the_size_that_the_model_names() {
        let inputs =
            json!({ "vector": { "size": [42] }, "skeleton_sequence": { "joints": 25, "channels": 3 } });
        let inputs = inputs.as_object().unwrap();
        let one = |kind| values(kind, inputs).unwrap().remove(0);
        assert!(matches!(one(ValueType::Vector), Value::Vector(vector) if vector.as_slice().len() == 42));
        assert!(
            matches!(one(ValueType::SkeletonSequence), Value::SkeletonSequence(all) if all.shape() == [1, 3, 32, 25, 1])
        );
        assert!(values(ValueType::RlTarget, inputs).is_err());
    }
}
