//! JSON round trips of every target type, and the examples of the documentation.

use std::sync::Arc;

use opendr_engine::target::*;
use opendr_engine::{Header, Value, ValueType};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use proptest::sample;

const DOCUMENT: &str = include_str!("../../../../docs/json.md");

/// The examples of targets (the command line's own records have no type). They are compared as JSON, because a
/// NaN does not equal itself.
#[test]
fn examples_are_read_and_written() {
    let mut types = Vec::new();
    for block in DOCUMENT.split("```json\n").skip(1) {
        let example = block.split("```").next().unwrap();
        let value: Value =
            serde_json::from_str(example).unwrap_or_else(|error| panic!("{error} in {example}"));
        let expected: serde_json::Value = serde_json::from_str(example).unwrap();
        let written = serde_json::to_string(&value).unwrap();
        assert_eq!(serde_json::from_str::<serde_json::Value>(&written).unwrap(), expected, "{written}");
        types.push(value.as_value_ref().value_type());
    }
    for target in ValueType::ALL.iter().filter(|value_type| value_type.is_target()) {
        assert!(types.contains(target), "docs/json.md has no {}", target.name());
    }
}

#[test]
fn null_is_nan() {
    let list = BoundingBoxList::from(vec![BoundingBox::new(0, f32::NAN, f32::INFINITY, 1.0, 1.0, f32::NAN)]);
    let text = serde_json::to_string(&list).unwrap();
    assert!(text.contains(r#""left":null,"top":null"#), "{text}");
    let back: BoundingBoxList = serde_json::from_str(&text).unwrap();
    assert!(back.boxes[0].left.is_nan() && back.boxes[0].top.is_nan() && back.boxes[0].confidence.is_nan());
}

#[test]
fn unknown_fields_are_ignored_and_unknown_types_rejected() {
    assert!(serde_json::from_str::<Value>(r#"{"type":"PoseList","poses":[],"later":1}"#).is_ok());
    for text in [r#"{"type":"Image"}"#, r#"{"poses":[]}"#, r#"{"type":"PoseList"}"#, "[]", "null"] {
        assert!(serde_json::from_str::<Value>(text).is_err(), "{text}");
    }
}

fn number() -> impl Strategy<Value = f32> {
    any::<f32>().prop_filter("finite", |number| number.is_finite())
}

fn header() -> impl Strategy<Value = Header> {
    (option::of(any::<i64>()), option::of(".{0,8}"))
        .prop_map(|(stamp_ns, frame_id)| Header { stamp_ns, frame_id: frame_id.map(Arc::from) })
}

fn action() -> impl Strategy<Value = Option<Action>> {
    option::of(vec(-1.0f32..=1.0, 1..=4).prop_map(|axes| Action::new(&axes).unwrap()))
}

fn classes() -> impl Strategy<Value = Classes> {
    vec(".{0,6}", 0..3).prop_map(Classes::from)
}

fn name() -> impl Strategy<Value = Name> {
    prop_oneof![any::<i64>().prop_map(Name::from), ".{0,8}".prop_map(|label| Name::from(label.as_str()))]
}

fn segment() -> impl Strategy<Value = Segment> {
    let rle = vec(any::<bool>(), 12).prop_map(|mask| Segmentation::Rle(Rle::from_mask(&mask, 3, 4).unwrap()));
    let polygons = vec(vec(number(), 0..6), 0..3).prop_map(Segmentation::Polygons);
    (prop_oneof![rle, polygons], number(), any::<bool>()).prop_map(|(segmentation, area, iscrowd)| Segment {
        segmentation,
        area,
        iscrowd,
    })
}

fn bounding_box() -> impl Strategy<Value = BoundingBox> {
    let place = [number(), number(), number(), number(), number()];
    (name(), place, vec([number(), number()], 0..7), option::of(segment())).prop_map(
        |(name, [left, top, width, height, confidence], landmarks, segment)| BoundingBox {
            landmarks: landmarks.into(),
            segment: segment.map(Box::new),
            ..BoundingBox::new(name, left, top, width, height, confidence)
        },
    )
}

fn bounding_box_3d() -> impl Strategy<Value = BoundingBox3D> {
    (name(), any::<i32>(), proptest::array::uniform14(number())).prop_map(|(name, occluded, numbers)| {
        let [truncated, alpha, x0, y0, x1, y1, length, height, width, x, y, z, rotation_y, confidence] =
            numbers;
        let (bbox2d, dimensions, location) = ([x0, y0, x1, y1], [length, height, width], [x, y, z]);
        BoundingBox3D {
            name,
            truncated,
            occluded,
            alpha,
            bbox2d,
            dimensions,
            location,
            rotation_y,
            confidence,
        }
    })
}

fn pose() -> impl Strategy<Value = Pose> {
    let keypoint =
        [number(), number(), number()].prop_map(|[x, y, confidence]| Keypoint { x, y, confidence });
    let skeleton = sample::select(Skeleton::ALL);
    let region = option::of(bounding_box().prop_map(Box::new));
    (vec(keypoint, 0..19), number(), option::of(any::<i64>()), skeleton, region).prop_map(
        |(keypoints, confidence, id, skeleton, region)| Pose {
            keypoints: keypoints.into(),
            confidence,
            id,
            skeleton,
            region,
        },
    )
}

fn boxes() -> impl Strategy<Value = Value> {
    let list = (vec(bounding_box(), 0..4), classes(), option::of(any::<i64>()));
    (header(), list, action()).prop_map(|(header, (boxes, classes, image_id), action)| {
        BoundingBoxList { header, boxes, classes, image_id, action }.into()
    })
}

fn tracks() -> impl Strategy<Value = Value> {
    let track = (bounding_box(), any::<i64>(), option::of(any::<i64>()))
        .prop_map(|(bounding_box, id, frame)| TrackingAnnotation { bounding_box, id, frame });
    (header(), vec(track, 0..4), classes(), action()).prop_map(|(header, annotations, classes, action)| {
        TrackingAnnotationList { header, annotations, classes, action }.into()
    })
}

fn boxes_3d() -> impl Strategy<Value = Value> {
    (header(), vec(bounding_box_3d(), 0..4), classes(), action()).prop_map(
        |(header, boxes, classes, action)| BoundingBox3DList { header, boxes, classes, action }.into(),
    )
}

fn tracks_3d() -> impl Strategy<Value = Value> {
    let track = (bounding_box_3d(), any::<i64>(), option::of(any::<i64>()))
        .prop_map(|(bounding_box_3d, id, frame)| TrackingAnnotation3D { bounding_box_3d, id, frame });
    (header(), vec(track, 0..4), classes(), action()).prop_map(|(header, annotations, classes, action)| {
        TrackingAnnotation3DList { header, annotations, classes, action }.into()
    })
}

fn poses() -> impl Strategy<Value = Value> {
    (header(), vec(pose(), 0..3), action())
        .prop_map(|(header, poses, action)| PoseList { header, poses, action }.into())
}

fn category() -> impl Strategy<Value = Value> {
    let scores = (option::of(number()), vec(number(), 0..5));
    (header(), any::<i64>(), option::of(".{0,8}"), scores, action()).prop_map(
        |(header, class, description, (confidence, probabilities), action)| {
            let description = description.map(Arc::from);
            Category { header, class, description, confidence, probabilities, action }.into()
        },
    )
}

fn heatmap() -> impl Strategy<Value = Value> {
    let labels = vec(any::<u32>(), 6).prop_map(|labels| Heatmap::from_labels(labels, &[2, 3]).unwrap());
    let scores = vec(number(), 8).prop_map(|scores| Heatmap::from_scores(scores, &[2, 2, 2]).unwrap());
    (header(), prop_oneof![labels, scores], classes(), action()).prop_map(
        |(header, mut map, classes, action)| {
            (map.header, map.classes, map.action) = (header, classes, action);
            map.into()
        },
    )
}

fn texts() -> impl Strategy<Value = Value> {
    let corners = proptest::array::uniform4([number(), number()]);
    let region = (".{0,8}", corners, number()).prop_map(|(text, corners, confidence)| TextRegion {
        text,
        corners,
        confidence,
    });
    (header(), vec(region, 0..4), action())
        .prop_map(|(header, regions, action)| TextRegionList { header, regions, action }.into())
}

fn odometry() -> impl Strategy<Value = Value> {
    let part = -1e6..1e6_f64;
    let pose = ([part.clone(), part.clone(), part.clone()], [part.clone(), part.clone(), part.clone(), part]);
    let pose = pose.prop_map(|(position, orientation)| RigidPose { position, orientation });
    (header(), option::of(pose), any::<u32>(), action()).prop_map(|(header, pose, num_landmarks, action)| {
        Odometry { header, pose, num_landmarks, action }.into()
    })
}

fn command() -> impl Strategy<Value = Value> {
    (header(), name(), number(), option::of([number(), number()]), action()).prop_map(
        |(header, command, confidence, span_s, action)| {
            SpeechCommand { header, command, confidence, span_s, action }.into()
        },
    )
}

fn rl_target() -> impl Strategy<Value = Value> {
    (header(), vec(number(), 0..5), action())
        .prop_map(|(header, values, action)| RlTarget { header, values, action }.into())
}

fn transcription() -> impl Strategy<Value = Value> {
    let numbers = proptest::array::uniform6(number());
    let segment = (any::<i64>(), any::<i64>(), ".{0,8}", vec(any::<i64>(), 0..4), numbers).prop_map(
        |(id, seek, text, tokens, numbers)| {
            let [start, end, temperature, avg_logprob, compression_ratio, no_speech_prob] = numbers;
            WhisperSegment {
                id,
                seek,
                start,
                end,
                text,
                tokens,
                temperature,
                avg_logprob,
                compression_ratio,
                no_speech_prob,
            }
        },
    );
    prop_oneof![
        (header(), ".{0,20}", action()).prop_map(|(header, text, action)| BaseTranscription {
            header,
            text,
            action
        }
        .into()),
        (header(), ".{0,20}", any::<bool>(), action()).prop_map(|(header, text, accept_waveform, action)| {
            VoskTranscription { header, text, accept_waveform, action }.into()
        }),
        (header(), ".{0,20}", vec(segment, 0..3), action()).prop_map(|(header, text, segments, action)| {
            WhisperTranscription { header, text, segments, action }.into()
        }),
    ]
}

fn target() -> impl Strategy<Value = Value> {
    prop_oneof![
        boxes(),
        tracks(),
        boxes_3d(),
        tracks_3d(),
        poses(),
        category(),
        heatmap(),
        texts(),
        odometry(),
        command(),
        rl_target(),
        transcription(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 500, ..ProptestConfig::default() })]

    #[test]
    fn round_trip(value in target()) {
        let text = serde_json::to_string(&value).unwrap();
        let back: Value = serde_json::from_str(&text).unwrap();
        prop_assert_eq!(&back, &value, "{}", text);
        prop_assert_eq!(serde_json::to_string(&back).unwrap(), text);
    }

    #[test]
    fn readable_lines_are_ended(value in target()) {
        let text = format!("{value:#}");
        prop_assert!(text.is_empty() || text.ends_with('\n'), "{}", text);
    }
}
