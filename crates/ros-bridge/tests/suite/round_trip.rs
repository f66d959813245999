//! Round trips of every type through each of its messages, as bytes of ROS 1 and ROS 2.

use opendr_engine::data::{
    Audio, Calibration, Image, ImageWithDetections, Layout, Observation, PixelFormat, PointCloud,
    PointCloudWithCalibration, SkeletonSequence, Timeseries, Vector, Video,
};
use opendr_engine::target::{
    BaseTranscription, BoundingBox, BoundingBox3D, BoundingBox3DList, BoundingBoxList, Category, Classes,
    Heatmap, Keypoint, Name, Odometry, Pose, PoseList, RigidPose, RlTarget, Skeleton, SpeechCommand,
    TextRegion, TextRegionList, TrackingAnnotation, TrackingAnnotation3D, TrackingAnnotation3DList,
    TrackingAnnotationList, VoskTranscription, WhisperSegment, WhisperTranscription,
};
use opendr_engine::{Header, Value, ValueType};
use opendr_messages::{Message, MessageType, WireFormat, geometry_msgs, nav_msgs};
use opendr_ros_bridge::{RosBridge, message_types};

fn header() -> Header {
    Header::new(1_700_000_000_987_654_321, "camera_link")
}

fn ramp(count: usize) -> Vec<f32> {
    (0..count).map(|index| index as f32 * 0.37 - 3.1).collect()
}

fn boxes() -> BoundingBoxList {
    let mut boxes = BoundingBoxList::from(vec![
        BoundingBox::new(0, 1.5, -2.25, 3.0, 4.125, 0.1),
        BoundingBox::new(17, 639.9, 1.0e-3, 0.3, 0.7, 0.987_654_3),
    ]);
    boxes.header = header();
    boxes
}

fn boxes_3d() -> BoundingBox3DList {
    let found = |rotation_y: f32, x: f32| BoundingBox3D {
        name: Name::Index(2),
        truncated: -1.0,
        occluded: -1,
        alpha: 0.0,
        bbox2d: [0.0; 4],
        dimensions: [4.2, 1.5, 1.7],
        location: [x, 1.65, 23.4],
        rotation_y,
        confidence: 0.75,
    };
    let mut boxes = BoundingBox3DList::from(vec![found(0.0, 1.0), found(-1.5, -7.3), found(3.1, 0.0)]);
    boxes.header = header();
    boxes
}

fn calibration() -> Calibration {
    Calibration {
        header: header(),
        p2: [[721.5, 0.0, 609.5, 44.8], [0.0, 721.5, 172.8, 0.2], [0.0, 0.0, 1.0, 0.0]],
        r0_rect: [[1.0, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        tr_velo_to_cam: [[0.0, -1.0, 0.0, 0.1], [0.0, 0.0, -1.0, 0.2], [1.0, 0.0, 0.0, 0.3]],
    }
}

fn image() -> Image {
    let samples: Vec<u8> = (0..5 * 3 * 3).map(|index| index as u8 * 5).collect();
    Image::from_rgb8(samples, 5, 3).unwrap().with_header(header())
}

fn with_header<T: opendr_engine::Datum + Into<Value>>(mut datum: T) -> Value {
    *datum.header_mut() = header();
    datum.into()
}

fn poses() -> PoseList {
    let keypoints = (0..17).map(|joint| Keypoint { x: joint as f32, y: 2.5, confidence: 0.5 }).collect();
    PoseList::from(vec![
        Pose { keypoints, confidence: 0.9, id: Some(4), skeleton: Skeleton::Coco17, region: None },
        Pose::default(),
    ])
}

/// Test values of a type; messages other than the first may simplify them.
fn values(value_type: ValueType) -> Vec<Value> {
    let segment = WhisperSegment { id: 3, text: "ja".into(), tokens: vec![1, -2], ..Default::default() };
    let mut value: Value = match value_type {
        ValueType::Image => {
            let chw = Image::new(vec![7_u8; 24], 4, 2, PixelFormat::Rgb, Layout::Hwc).unwrap();
            let depth = Image::new(vec![0_u16, 1, 65_535, 9], 2, 2, PixelFormat::Grey, Layout::Hwc).unwrap();
            let metres = vec![0.5_f32, f32::INFINITY, -1.0, 9.0];
            let metres = Image::new(metres, 1, 4, PixelFormat::Grey, Layout::Hwc).unwrap();
            let bgra = Image::new(vec![3_u8; 16], 2, 2, PixelFormat::Bgra, Layout::Hwc).unwrap();
            return [image(), chw, depth, metres, bgra].map(with_header).into();
        }
        ValueType::ImageWithDetections => ImageWithDetections::new(image(), boxes()).into(),
        ValueType::Video => Video::new(ramp(24), [3, 2, 2, 2]).unwrap().into(),
        ValueType::PointCloud => {
            let clouds = [(4, 4), (5, 3), (2, 7), (3, 6), (1, 9)];
            let cloud =
                |(points, channels)| PointCloud::new(ramp(points * channels), [points, channels]).unwrap();
            let empty = PointCloud::new(Vec::new(), [0, 4]).unwrap();
            return clouds.map(cloud).into_iter().chain([empty]).map(with_header).collect();
        }
        ValueType::PointCloudWithCalibration => {
            let cloud = PointCloud::new(ramp(8), [2, 4]).unwrap().with_header(header());
            PointCloudWithCalibration::new(cloud, calibration(), Some([375, 1242])).into()
        }
        ValueType::Calibration => calibration().into(),
        ValueType::Timeseries => Timeseries::new(ramp(12), [6, 2]).unwrap().into(),
        ValueType::Vector => Vector::from_data(ramp(5)).unwrap().into(),
        ValueType::Audio => Audio::new(ramp(6), 2, 16_000).unwrap().into(),
        ValueType::SkeletonSequence => SkeletonSequence::new(ramp(12), [1, 3, 2, 2, 1]).unwrap().into(),
        ValueType::Observation => {
            let (a, b) = (ramp(6), ramp(2));
            let parts = [("depth", &[2, 3][..], &a[..]), ("goal", &[2], &b)];
            let parts = Observation::from_parts(parts).unwrap();
            return [parts, Observation::from_data(ramp(4)).unwrap()].map(with_header).into();
        }
        ValueType::BoundingBoxList => boxes().into(),
        ValueType::TrackingAnnotationList => {
            let annotations = boxes().boxes.into_iter().zip([5, -1]);
            let annotation = |(bounding_box, id)| TrackingAnnotation { bounding_box, id, frame: None };
            TrackingAnnotationList::from(annotations.map(annotation).collect::<Vec<_>>()).into()
        }
        ValueType::BoundingBox3DList => boxes_3d().into(),
        ValueType::TrackingAnnotation3DList => {
            let annotation = |bounding_box_3d| TrackingAnnotation3D { bounding_box_3d, id: 12, frame: None };
            TrackingAnnotation3DList::from(boxes_3d().boxes.into_iter().map(annotation).collect::<Vec<_>>())
                .into()
        }
        ValueType::PoseList => poses().into(),
        ValueType::Category => {
            let plain = Category::new(3, None);
            let full = Category { probabilities: vec![0.1, 0.2, 0.7], ..Category::new(2, Some(0.7)) };
            return [plain, full].map(with_header).into();
        }
        ValueType::Heatmap => {
            let labels = |labels: Vec<u32>| Heatmap::from_labels(labels, &[2, 2]).unwrap();
            let scores = Heatmap::from_scores(ramp(12), &[3, 2, 2]).unwrap();
            let flat = Heatmap::from_scores(ramp(6), &[3, 2]).unwrap();
            let small = labels(vec![0, 1, 2, 255]);
            let maps =
                [small, labels(vec![0, 256, 3, 65_535]), labels(vec![u32::MAX, 0, 1, 70_000]), scores, flat];
            return maps.map(with_header).into();
        }
        ValueType::TextRegionList => {
            let corners = [[1.0, 2.0], [9.5, 2.5], [9.0, 6.0], [1.0, 5.5]];
            TextRegionList::from(vec![TextRegion::new("EXIT", corners, 0.75)]).into()
        }
        ValueType::Odometry => {
            let pose = RigidPose { position: [0.5, -1.0, 2.0], orientation: [0.5, -0.5, 0.5, 0.5] };
            return [Odometry::new(pose, 0), Odometry::default()].map(with_header).into();
        }
        ValueType::SpeechCommand => SpeechCommand::new(7, 0.25).into(),
        ValueType::BaseTranscription => {
            BaseTranscription { text: "grün".into(), ..Default::default() }.into()
        }
        ValueType::WhisperTranscription => {
            let (text, segments) = ("ja".to_owned(), vec![segment]);
            WhisperTranscription { text, segments, ..Default::default() }.into()
        }
        ValueType::VoskTranscription => {
            VoskTranscription { text: "so".into(), accept_waveform: true, ..Default::default() }.into()
        }
        ValueType::RlTarget => RlTarget::from(ramp(6)).into(),
        other => panic!("no values of {}", other.name()),
    };

    *value.header_mut() = header();
    vec![value]
}

/// Rounds rotations, which a quaternion does not keep exactly, and the observation angle, which is computed.
fn rounded(mut value: Value) -> Value {
    let round = |found: &mut BoundingBox3D| {
        found.rotation_y = (found.rotation_y * 1e6).round() / 1e6;
        found.alpha = 0.0;
    };
    match &mut value {
        Value::BoundingBox3DList(list) => list.boxes.iter_mut().for_each(round),
        Value::TrackingAnnotation3DList(list) => {
            list.annotations.iter_mut().for_each(|annotation| round(&mut annotation.bounding_box_3d));
        }
        _ => {}
    }
    value
}

#[test]
fn every_type_survives_its_first_message() {
    let bridge = RosBridge::default();
    for value_type in ValueType::ALL.iter().copied() {
        let message_type = message_types(value_type).next().unwrap();
        for value in values(value_type) {
            let message = bridge.message_from_value(value.as_value_ref(), message_type).unwrap();
            for wire in [WireFormat::Cdr, WireFormat::Ros1] {
                let bytes = message.to_bytes(wire).unwrap();
                let read = Message::from_bytes(message_type, wire, &bytes).unwrap();
                assert_eq!(read.to_bytes(wire).unwrap(), bytes, "{} {wire:?}", value_type.name());
                let back = bridge.value_from_message(value_type, read).unwrap();
                assert_eq!(rounded(back), rounded(value.clone()), "{} {wire:?}", value_type.name());
            }
        }
    }
}

#[test]
fn other_messages_keep_their_fields() {
    let bridge = RosBridge { jpeg_quality: 100, ..RosBridge::default() };
    let pass = |value: &Value, message_type| {
        let message = bridge.message_from_value(value.as_value_ref(), message_type).unwrap();
        bridge.value_from_message(value.as_value_ref().value_type(), message).unwrap()
    };
    let series = &values(ValueType::Timeseries)[0];
    let Value::Timeseries(back) = pass(series, MessageType::StdMsgsFloat32MultiArray) else { panic!() };
    assert_eq!((back.shape(), back.header), ([6, 2], Header::default()));
    let depth = &values(ValueType::Image)[2];
    assert_eq!(pass(depth, MessageType::SensorMsgsCompressedImage), *depth);
    let Value::Image(seen) = pass(&image().into(), MessageType::SensorMsgsCompressedImage) else { panic!() };
    assert_eq!((seen.width(), seen.height(), &seen.header), (5, 3, &header()));
    let Value::Calibration(camera) = pass(&calibration().into(), MessageType::SensorMsgsCameraInfo) else {
        panic!()
    };
    assert_eq!(camera.p2, calibration().p2);
    let turn = Value::from(RlTarget::from(vec![0.5, -0.25]));
    let Value::RlTarget(twist) = pass(&turn, MessageType::GeometryMsgsTwist) else { panic!() };
    assert_eq!(twist.values, [0.5, 0.0, 0.0, 0.0, 0.0, -0.25]);
}

#[test]
fn classes_are_written_by_name_or_index() {
    let mut boxes = boxes();
    boxes.classes = Classes::from_iter(["person", "bicycle"]);
    let read = |bridge: RosBridge| -> BoundingBoxList {
        let message: opendr_messages::vision_msgs::Detection2DArray = bridge.to_message(&boxes).unwrap();
        bridge.from_message(message).unwrap()
    };
    let names = read(RosBridge::default());
    assert_eq!([&names.boxes[0].name, &names.boxes[1].name], [&Name::from("person"), &Name::from(17)]);
    let numbers = read(RosBridge { class_ids: opendr_ros_bridge::ClassIds::Numbers, ..RosBridge::default() });
    assert_eq!(numbers.boxes, boxes.boxes);
    let info = opendr_ros_bridge::label_info(&boxes.classes, &header(), 0.5).unwrap();
    assert_eq!((info.class_map[1].class_id, info.class_map[1].class_name.as_str()), (1, "bicycle"));
}

#[test]
fn odometry_has_the_axes_of_ros() {
    // Two metres ahead, one to the right, turned to the right by a quarter: about the axis that points down.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let pose = RigidPose { position: [1.0, 0.0, 2.0], orientation: [0.0, half, 0.0, half] };
    let odometry = Odometry { header: Header::new(5, "left_optical_frame"), ..Odometry::new(pose, 80) };
    let bridge = RosBridge::default();
    let message: nav_msgs::Odometry = bridge.to_message(&odometry).unwrap();
    assert_eq!((&*message.header.frame_id, &*message.child_frame_id), ("odom", "left_frame"));
    let geometry_msgs::Pose { position, orientation } = &message.pose.pose;
    assert_eq!([position.x, position.y, position.z], [2.0, -1.0, 0.0]);
    assert_eq!([orientation.x, orientation.y, orientation.z, orientation.w], [0.0, 0.0, -half, half]);
    let mut wild = message.clone();
    wild.pose.pose.position.x = f64::NAN;
    assert_eq!(bridge.from_message::<Odometry, _>(wild).unwrap().pose, None);
    let unknown: nav_msgs::Odometry = bridge.to_message(&Odometry::default()).unwrap();
    assert_eq!(unknown.pose.covariance[35], 9999.0);
}
