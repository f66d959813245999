//! Synthetic inputs for learners without a sample in the zoo.

use std::f32::consts::TAU;

use opendr::data::{
    Audio, Image, Layout, PixelFormat, Pixels, PointCloud, SkeletonSequence, Timeseries, Vector, Video,
};
use opendr::learner::Port;
use opendr::target::{BoundingBox, BoundingBox3D, BoundingBox3DList, BoundingBoxList, Heatmap};
use opendr::{Error, Result, Value, ValueType};
use serde_json::{Map, Value as Json};

/// Sample rate in hertz, and duration in seconds, of audio.
const SAMPLE_RATE: u32 = 16000;
const AUDIO_S: usize = 10;
/// Frames of a skeleton sequence and of moving boxes.
const FRAMES: usize = 32;
/// Frames of a video clip.
const CLIP_FRAMES: usize = 16;
/// Boxes per frame.
const BOXES: usize = 25;
/// Side of a heatmap in cells.
const MAP_SIDE: usize = 224;
/// Rings of a point cloud, and points per ring.
const RINGS: usize = 64;
const RING_POINTS: usize = 1800;

/// Returns synthetic values for a port of a model with `inputs` in its manifest and images of size `[width, height]`: several
/// values where they form a stream.
///
/// # Errors
/// `Unsupported` for a type without synthetic values.
pub fn values(port: &Port, size: [usize; 2], inputs: &Map<String, Json>) -> Result<Vec<Value>> {
    let input = inputs.get(port.name);
    let number = |key: &str, otherwise: usize| {
        let number = input.and_then(|input| input.get(key)?.as_u64());
        number.map_or(otherwise, |number| number as usize)
    };
    let [width, height] = size;
    let size = |at: usize, otherwise: usize| {
        let size = input.and_then(|input| input.get("size")?.get(at)?.as_u64());
        size.map_or(otherwise, |size| size as usize)
    };
    Ok(match port.value_type {
        ValueType::Image if port.name == "depth" => vec![depth(width, height)?.into()],
        ValueType::Image => vec![image(width, height)?.into()],
        ValueType::Audio => {
            let rate = number("rate", SAMPLE_RATE as usize);
            vec![Audio::new(wave(rate * AUDIO_S, rate as f32 / 220.0), 1, rate as u32)?.into()]
        }
        ValueType::PointCloud => vec![cloud(number("channels", 4))?.into()],
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
        ValueType::BoundingBox3DList => (0..FRAMES).map(|frame| boxes_3d(frame).into()).collect(),
        ValueType::Heatmap => vec![map(size(0, MAP_SIDE), size(1, MAP_SIDE)).into()],
        other => {
            let name = other.name();
            return Err(Error::unsupported(format!(
                "no synthetic {name} input exists; name a file of that type"
            )));
        }
    })
}

/// Returns a sine wave with its third harmonic.
fn wave(count: usize, period: f32) -> Vec<f32> {
    (0..count)
        .map(|at| 0.3 * (TAU * at as f32 / period).sin() + 0.1 * (TAU * at as f32 * 3.0 / period).cos())
        .collect()
}

/// Returns an image of gradients and squares.
fn image(width: usize, height: usize) -> Result<Image> {
    let pixel = |at: usize| {
        let (x, y) = (at % width, at / width);
        let square = if (x / 64 + y / 64) % 2 == 0 { 200 } else { 40 };
        [(x * 255 / width) as u8, (y * 255 / height) as u8, square]
    };
    let samples: Vec<u8> = (0..width * height).flat_map(pixel).collect();
    Image::new(samples, width, height, PixelFormat::Rgb, Layout::Hwc)
}

/// Returns a depth image of a floor, in millimetres.
fn depth(width: usize, height: usize) -> Result<Image> {
    let samples: Vec<u16> =
        (0..width * height).map(|at| 3000 - (at / width * 2000 / height) as u16).collect();
    Image::new(Pixels::from(samples), width, height, PixelFormat::Grey, Layout::Hwc)
}

/// Returns the point cloud of a 64-beam lidar 1.73 m above a plane, with a wall at 50 m.
fn cloud(channels: usize) -> Result<PointCloud> {
    let channels = channels.max(3);
    let mut points = Vec::with_capacity(RINGS * RING_POINTS * channels);
    for ring in 0..RINGS {
        let down = (24.8 - 26.8 * ring as f32 / (RINGS - 1) as f32).to_radians();
        let range = if down > 0.0 { (1.73 / down.sin()).min(50.0) } else { 50.0 };
        for point in 0..RING_POINTS {
            let (sine, cosine) = (TAU * point as f32 / RING_POINTS as f32).sin_cos();
            let flat = range * down.cos();
            points.extend([flat * cosine, flat * sine, -range * down.sin()]);
            points.extend(std::iter::repeat_n(0.3, channels - 3));
        }
    }
    PointCloud::new(points, [RINGS * RING_POINTS, channels])
}

/// Returns a heatmap with many peaks of different heights.
fn map(rows: usize, columns: usize) -> Heatmap {
    let mut map = Heatmap::default();
    for (at, value) in map.scores_mut(&[rows, columns]).iter_mut().enumerate() {
        let [x, y] = [at % columns, at / columns].map(|place| place as f32);
        *value = (x / 7.0).sin() * (y / 9.0).cos() + x * 1e-3 + y * 1e-4;
    }
    map
}

/// Returns boxes that move to the right, each row at its own speed.
fn boxes(frame: usize) -> BoundingBoxList {
    let boxes = (0..BOXES).map(|at| {
        let (row, column) = (at / 5, at % 5);
        let left = column as f32 * 300.0 + frame as f32 * (1.0 + row as f32);
        BoundingBox::new(0, left, row as f32 * 200.0, 80.0, 160.0, 0.9)
    });
    boxes.collect::<Vec<_>>().into()
}

/// Returns cars that drive away, each row at its own speed.
fn boxes_3d(frame: usize) -> BoundingBox3DList {
    let boxes = (0..BOXES).map(|at| {
        let (row, column) = (at / 5, at % 5);
        BoundingBox3D {
            name: 0.into(),
            dimensions: [3.9, 1.56, 1.6],
            location: [
                column as f32 * 6.0 - 12.0,
                1.7,
                10.0 + row as f32 * 10.0 + frame as f32 * (0.2 + 0.1 * row as f32),
            ],
            confidence: 0.9,
            ..BoundingBox3D::default()
        }
    });
    boxes.collect::<Vec<_>>().into()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn port(name: &'static str, value_type: ValueType) -> Port {
        Port { name, doc: "", value_type, optional: false, init: false }
    }

    #[test]
    fn values_have_the_size_of_the_manifest() {
        let inputs =
            json!({ "vector": { "size": [42] }, "skeleton_sequence": { "joints": 25, "channels": 3 } });
        let inputs = inputs.as_object().unwrap();
        let one = |kind: ValueType| values(&port(kind.port(), kind), [64, 32], inputs).unwrap().remove(0);
        assert!(matches!(one(ValueType::Vector), Value::Vector(vector) if vector.as_slice().len() == 42));
        assert!(
            matches!(one(ValueType::SkeletonSequence), Value::SkeletonSequence(all) if all.shape() == [1, 3, 32, 25, 1])
        );
        assert!(
            matches!(one(ValueType::PointCloud), Value::PointCloud(cloud) if cloud.as_slice().len() == 115_200 * 4)
        );
        assert!(matches!(one(ValueType::Heatmap), Value::Heatmap(map) if map.shape() == [224, 224]));
        assert!(values(&port("rl_target", ValueType::RlTarget), [64, 32], inputs).is_err());
    }

    #[test]
    fn depth_has_the_size_of_its_image() {
        let one = |name| values(&port(name, ValueType::Image), [64, 32], &Map::new()).unwrap().remove(0);
        let [Value::Image(image), Value::Image(depth)] = ["image", "depth"].map(one) else {
            panic!("no images");
        };
        assert_eq!([depth.width(), depth.height()], [image.width(), image.height()]);
        assert_eq!(depth.format(), PixelFormat::Grey);
        assert!(matches!(depth.pixels(), Pixels::U16(_)));
    }
}
