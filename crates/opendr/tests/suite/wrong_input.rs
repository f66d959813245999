//! Unusual inputs: every learner returns finite numbers or a clear error, and continues to work.

use std::f32::consts::TAU;

use opendr::data::{
    Audio, Image, Layout, Observation, PixelFormat, PointCloud, SkeletonSequence, Timeseries, Vector, Video,
};
use opendr::learner::{AnyLearner, Entry, Outputs, Ports};
use opendr::params::ParamMap;
use opendr::target::{BoundingBox, BoundingBox3D, BoundingBox3DList, BoundingBoxList, Heatmap};
use opendr::{Device, ErrorKind, Result, Value, ValueType};

use crate::models::Models;

#[test]
fn wrong_input_is_answered_or_refused_and_changes_nothing() {
    let Some(models) = Models::find() else { return };
    let mut wrongs = Vec::new();
    for entry in opendr::registry().entries() {
        // Tests of their own have those that take several things; the test learner, one of them, has no model in the zoo.
        if entry.ports.iter().filter(|port| !port.optional).count() > 1 {
            continue;
        }
        let Some(model) = models.get(entry.spec.name) else { continue };
        let mut learner = entry.make(&ParamMap::new(), Device::Cpu).unwrap();
        learner.load(&model).unwrap();
        let kind = entry.ports[0].value_type;
        let usual = usual(kind).map(|value| infer(&mut *learner, &value).map_err(|error| error.kind()));
        for (what, value) in wrong(kind) {
            learner.reset();
            wrongs.extend(fault(entry, what, infer(&mut *learner, &value)));
        }
        learner.reset();
        if let Some(before) = usual {
            let after = infer(&mut *learner, &self::usual(kind).unwrap()).map_err(|error| error.kind());
            if after != before {
                wrongs.push(format!("{} remembers what it refused", entry.spec.name));
            }
        }
    }
    assert!(wrongs.is_empty(), "{}", wrongs.join("\n"));
}

fn infer(learner: &mut dyn AnyLearner, value: &Value) -> Result<Outputs> {
    learner.infer(&Ports::one(value))
}

/// Describes a failure: a prediction with a number that is not finite, or an error of another kind than wrong input.
fn fault(entry: &Entry, what: &str, answer: Result<Outputs>) -> Option<String> {
    let name = entry.spec.name;
    match answer {
        Ok(outputs) => outputs.iter().find_map(|(_, target)| {
            let json = serde_json::to_string(target).unwrap();
            json.contains("null").then(|| format!("{name} answers {what} with {json:.300}"))
        }),
        Err(error) if error.kind() == ErrorKind::InvalidInput => None,
        Err(error) => Some(format!("{name} refuses {what} by {error}")),
    }
}

/// A usual input of the type.
fn usual(kind: ValueType) -> Option<Value> {
    Some(match kind {
        ValueType::Image => picture(320, 240, |x, y| [(x % 256) as u8, (y % 256) as u8, 90]),
        ValueType::Audio => Audio::new(tone(16_000), 1, 16_000).unwrap().into(),
        ValueType::Timeseries => Timeseries::new(tone(140), [140, 1]).unwrap().into(),
        ValueType::SkeletonSequence => SkeletonSequence::new(tone(960), [1, 2, 32, 15, 1]).unwrap().into(),
        ValueType::Vector => Vector::from_data(tone(42)).unwrap().into(),
        _ => return None,
    })
}

/// Unusual inputs of the type.
fn wrong(kind: ValueType) -> Vec<(&'static str, Value)> {
    match kind {
        ValueType::Image => vec![
            ("one pixel", picture(1, 1, |_, _| [255; 3])),
            ("a line", picture(2000, 1, |x, _| [(x % 256) as u8; 3])),
            ("a column", picture(1, 2000, |_, y| [(y % 256) as u8; 3])),
            ("blackness", picture(640, 480, |_, _| [0; 3])),
            ("whiteness", picture(640, 480, |_, _| [255; 3])),
            (
                "noise",
                picture(301, 203, |x, y| {
                    let mixed = (x * 7919 + y * 104_729).wrapping_mul(2_654_435_761);
                    [(mixed >> 8) as u8, (mixed >> 16) as u8, (mixed >> 24) as u8]
                }),
            ),
            ("a tall picture", picture(40, 3000, |x, y| [(x ^ y) as u8; 3])),
        ],
        ValueType::Audio => {
            let sound =
                |samples: Vec<f32>, channels, rate| Audio::new(samples, channels, rate).unwrap().into();
            let bytes: Vec<u8> = tone(8000).iter().map(|one| (128.0 + one * 100.0) as u8).collect();
            vec![
                ("one sample", sound(vec![0.5], 1, 16_000)),
                ("silence", sound(vec![0.0; 16_000], 1, 16_000)),
                ("a sample that is no number", sound(vec![f32::NAN; 16_000], 1, 16_000)),
                ("an infinite sample", sound(vec![f32::INFINITY; 100], 1, 16_000)),
                ("loudness", sound(vec![1e30; 16_000], 1, 16_000)),
                ("8 bits at 8 kHz", Audio::from_pcm8(&bytes, 1, 8000).unwrap().into()),
                ("seven channels", sound(tone(7000), 7, 16_000)),
                ("192 kHz", sound(tone(19_200), 1, 192_000)),
                ("one sample a second", sound(tone(100), 1, 1)),
            ]
        }
        ValueType::Timeseries => vec![
            ("one instant", Timeseries::new(vec![0.0], [1, 1]).unwrap().into()),
            ("many features", Timeseries::new(tone(140 * 3), [140, 3]).unwrap().into()),
            ("a measurement that is none", Timeseries::new(vec![f32::NAN; 140], [140, 1]).unwrap().into()),
            ("a flat line", Timeseries::new(vec![0.0; 140], [140, 1]).unwrap().into()),
            ("a huge measurement", Timeseries::new(vec![f32::MAX; 140], [140, 1]).unwrap().into()),
        ],
        ValueType::SkeletonSequence => vec![
            ("one joint", SkeletonSequence::new(vec![0.5; 64], [1, 2, 32, 1, 1]).unwrap().into()),
            ("one frame", SkeletonSequence::new(tone(30), [1, 2, 1, 15, 1]).unwrap().into()),
            ("no numbers", SkeletonSequence::new(vec![f32::NAN; 960], [1, 2, 32, 15, 1]).unwrap().into()),
            ("nobody", SkeletonSequence::new(vec![0.0; 960], [1, 2, 32, 15, 1]).unwrap().into()),
            ("far away", SkeletonSequence::new(vec![1e38; 960], [1, 2, 32, 15, 1]).unwrap().into()),
            ("a crowd", SkeletonSequence::new(tone(9600), [1, 2, 32, 15, 10]).unwrap().into()),
        ],
        ValueType::Vector => vec![
            ("one number", Vector::from_data(vec![1.0]).unwrap().into()),
            ("no numbers", Vector::from_data(vec![f32::NAN; 42]).unwrap().into()),
            ("zeros", Vector::from_data(vec![0.0; 42]).unwrap().into()),
            ("huge numbers", Vector::from_data(vec![f32::MAX; 42]).unwrap().into()),
        ],
        ValueType::Observation => vec![
            ("one number", Observation::from_data(vec![1.0]).unwrap().into()),
            ("no numbers", Observation::from_data(vec![f32::NAN; 4]).unwrap().into()),
        ],
        ValueType::Video => {
            vec![("one black pixel", Video::new(vec![0.0; 3], [3, 1, 1, 1]).unwrap().into())]
        }
        ValueType::Heatmap => {
            let map = |values: Vec<f32>, shape: &[usize]| Heatmap::from_scores(values, shape).unwrap().into();
            vec![
                ("nothing", Heatmap::default().into()),
                ("classes", Heatmap::from_labels(vec![3; 12], &[3, 4]).unwrap().into()),
                ("one value", map(vec![-2.0], &[1, 1])),
                ("a flat map", map(vec![0.5; 12], &[3, 4])),
                ("no numbers", map(vec![f32::NAN; 12], &[3, 4])),
                ("huge values", map(vec![f32::MAX, -f32::MAX, f32::MAX], &[1, 3])),
                ("three axes", map(vec![0.0; 12], &[3, 2, 2])),
            ]
        }
        ValueType::BoundingBoxList => {
            let odd = |left, width| BoundingBox::new(0, left, 0.0, width, 10.0, f32::NAN);
            vec![
                ("nothing", BoundingBoxList::default().into()),
                (
                    "odd boxes",
                    BoundingBoxList::from(vec![odd(f32::NAN, 5.0), odd(0.0, -5.0), odd(1e38, f32::INFINITY)])
                        .into(),
                ),
            ]
        }
        ValueType::BoundingBox3DList => {
            let odd = BoundingBox3D { location: [f32::NAN, 0.0, f32::INFINITY], ..BoundingBox3D::default() };
            vec![
                ("nothing", BoundingBox3DList::default().into()),
                ("an odd box", BoundingBox3DList::from(vec![odd]).into()),
            ]
        }
        ValueType::PointCloud => {
            let cloud = |numbers: Vec<f32>, channels: usize| {
                let shape = [numbers.len() / channels, channels];
                PointCloud::new(numbers, shape).unwrap().into()
            };
            vec![
                ("no points", cloud(vec![], 4)),
                ("one point", cloud(vec![12.0, 1.0, -1.0], 3)),
                ("points of seven numbers", cloud(tone(700), 7)),
                ("no numbers", cloud(vec![f32::NAN; 400], 4)),
                ("infinite points", cloud(vec![f32::INFINITY; 400], 4)),
                ("points far away", cloud(vec![-1e38; 400], 4)),
                ("points in one place", cloud([12.0, 1.0, -1.0, 0.3].repeat(100_000), 4)),
                ("five million points", cloud(tone(5_000_000 * 3), 3)),
            ]
        }
        other => panic!("no wrong input of the type {}; say what may come", other.name()),
    }
}

fn tone(count: usize) -> Vec<f32> {
    (0..count).map(|at| 0.4 * (TAU * at as f32 / 37.0).sin()).collect()
}

fn picture(width: usize, height: usize, pixel: impl Fn(usize, usize) -> [u8; 3]) -> Value {
    let samples: Vec<u8> = (0..width * height).flat_map(|at| pixel(at % width, at / width)).collect();
    Image::new(samples, width, height, PixelFormat::Rgb, Layout::Hwc).unwrap().into()
}
