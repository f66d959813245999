//! Messages in the forms of drivers and other nodes, and malformed messages.

use opendr_engine::ErrorKind;
use opendr_engine::data::{Calibration, Image, PixelFormat, Pixels, PointCloud, Timeseries};
use opendr_engine::target::{BoundingBoxList, Name};
use opendr_messages::sensor_msgs::{self, PointCloud2, PointField};
use opendr_messages::{std_msgs, vision_msgs};
use opendr_ros_bridge::RosBridge;

fn bridge() -> RosBridge {
    RosBridge::default()
}

fn picture(encoding: &str, width: u32, height: u32, step: u32, data: Vec<u8>) -> sensor_msgs::Image {
    sensor_msgs::Image { width, height, step, data, encoding: encoding.into(), ..Default::default() }
}

#[test]
fn rows_lose_their_padding() {
    let image: Image = bridge().from_message(picture("mono8", 2, 2, 4, vec![1, 2, 9, 9, 3, 4])).unwrap();
    assert_eq!(*image.pixels(), Pixels::from(vec![1_u8, 2, 3, 4]));
    let depth = sensor_msgs::Image { is_bigendian: 1, ..picture("16UC1", 1, 2, 3, vec![1, 2, 0, 3, 4]) };
    let image: Image = bridge().from_message(depth).unwrap();
    assert_eq!(*image.pixels(), Pixels::from(vec![0x0102_u16, 0x0304]));
}

#[test]
fn every_encoding_is_read() {
    let read = |encoding: &str, data: Vec<u8>, step| -> Image {
        bridge().from_message(picture(encoding, 2, 2, step, data)).unwrap()
    };
    assert_eq!(read("8UC3", vec![0; 12], 6).format(), PixelFormat::Bgr);
    assert_eq!(read("rgba8", vec![0; 16], 8).format(), PixelFormat::Rgba);
    let green = [0, 255, 255, 0];
    assert_eq!(read("bayer_rggb8", green.to_vec(), 2), read("rgb8", [0, 255, 0].repeat(4), 6));
    let wide: Vec<u8> = green.iter().flat_map(|sample| [7, *sample]).collect();
    assert_eq!(read("bayer_rggb16", wide, 4), read("rgb8", [0, 255, 0].repeat(4), 6));
    assert_eq!(read("yuv422_yuy2", [235, 128].repeat(4), 4), read("rgb8", vec![255; 12], 6));
    assert_eq!(read("yuv422", [128, 16].repeat(4), 4), read("rgb8", vec![0; 12], 6));
}

#[test]
fn broken_images_are_refused() {
    let broken = [
        picture("rgb8", 2, 2, 6, vec![0; 11]),
        picture("rgb8", 2, 2, 5, vec![0; 12]),
        picture("rgb8", 0, 2, 0, vec![]),
        picture("rgb8", u32::MAX, u32::MAX, u32::MAX, vec![0; 12]),
        picture("16UC1", 1, u32::MAX, 0, vec![0; 12]),
        picture("yuyv", u32::MAX, 1, u32::MAX, vec![0; 12]),
        picture("bayer_rggb8", 1, 4, 1, vec![0; 4]),
    ];
    for message in broken {
        let text = format!("{message:?}");
        let error = bridge().from_message::<Image, _>(message).unwrap_err();
        assert!(matches!(error.kind(), ErrorKind::Format | ErrorKind::InvalidInput), "{text}: {error}");
    }
    let error = bridge().from_message::<Image, _>(picture("nv21", 2, 2, 2, vec![0; 6])).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    let compressed = |format: &str, data: &[u8]| sensor_msgs::CompressedImage {
        format: format.into(),
        data: data.into(),
        ..Default::default()
    };
    assert!(bridge().from_message::<Image, _>(compressed("jpeg", b"\xff\xd8\xff")).is_err());
    assert!(bridge().from_message::<Image, _>(compressed("16UC1; compressedDepth", &[0; 13])).is_err());
}

#[test]
fn inverse_depth_is_read() {
    let samples =
        Image::new(vec![0_u16, 100, 200], 3, 1, PixelFormat::Grey, opendr_engine::data::Layout::Hwc);
    let png = opendr_vision::encode_depth_png(&samples.unwrap()).unwrap();
    let mut data = [0_i32.to_le_bytes(), 300_f32.to_le_bytes(), 50_f32.to_le_bytes()].concat();
    data.extend(png);
    let format = "32FC1; compressedDepth png".to_owned();
    let message = sensor_msgs::CompressedImage { format, data, ..Default::default() };
    let image: Image = bridge().from_message(message).unwrap();
    let Pixels::F32(metres) = image.pixels() else { panic!() };
    assert!(metres[0].is_nan());
    assert_eq!(metres[1..], [6.0, 2.0]);
}

fn field(name: &str, offset: u32, datatype: u8) -> PointField {
    PointField { name: name.into(), offset, datatype, count: 1 }
}

#[test]
fn clouds_of_any_layout() {
    // y before x, doubles, a gap, a ring, packed colours; two rows with padding.
    let fields = vec![
        field("y", 0, PointField::FLOAT64),
        field("x", 8, PointField::FLOAT32),
        field("z", 12, PointField::INT16),
        field("ring", 14, PointField::UINT16),
        field("reflectivity", 16, PointField::UINT8),
        field("rgb", 20, PointField::FLOAT32),
    ];
    let point = |x: f32, y: f64, z: i16, echo: u8| {
        let mut bytes = y.to_le_bytes().to_vec();
        bytes.extend(x.to_le_bytes());
        bytes.extend(z.to_le_bytes());
        bytes.extend([0xff, 0xff, echo, 0, 0, 0, 30, 20, 10, 0]);
        bytes
    };
    let mut data = point(1.0, 2.0, -3, 4);
    data.extend([0xee; 3]);
    data.extend(point(5.0, f64::NAN, 7, 255));
    let message = PointCloud2 {
        width: 1,
        height: 2,
        point_step: 24,
        row_step: 27,
        fields: fields.clone(),
        data,
        ..Default::default()
    };
    let cloud: PointCloud = bridge().from_message(message.clone()).unwrap();
    assert_eq!(cloud.shape(), [2, 7]);
    assert_eq!(cloud.as_slice()[..7], [1.0, 2.0, -3.0, 4.0, 10.0, 20.0, 30.0]);
    assert!(cloud.as_slice()[8].is_nan() && cloud.as_slice()[10] == 255.0);
    let broken = [
        PointCloud2 { point_step: 0, ..message.clone() },
        PointCloud2 { row_step: 23, ..message.clone() },
        PointCloud2 { height: 3, ..message.clone() },
        PointCloud2 { width: u32::MAX, height: u32::MAX, ..message.clone() },
        PointCloud2 { fields: fields[1..].to_vec(), ..message.clone() },
        PointCloud2 { point_step: 22, ..message.clone() },
        PointCloud2 {
            fields: vec![field("x", u32::MAX, 7), field("y", 0, 7), field("z", 0, 7)],
            ..message.clone()
        },
        PointCloud2 { fields: vec![field("x", 0, 99), field("y", 0, 7), field("z", 0, 7)], ..message },
    ];
    for message in broken {
        let text = format!("{message:?}");
        assert!(bridge().from_message::<PointCloud, _>(message).is_err(), "{text}");
    }
}

#[test]
fn the_best_hypothesis_and_turned_boxes() {
    let result = |class_id: &str, score| vision_msgs::ObjectHypothesisWithPose {
        hypothesis: vision_msgs::ObjectHypothesis { class_id: class_id.into(), score },
        ..Default::default()
    };
    let center = vision_msgs::Pose2D {
        position: vision_msgs::Point2D { x: 10.0, y: 20.0 },
        theta: std::f64::consts::FRAC_PI_2,
    };
    let detection = vision_msgs::Detection2D {
        results: vec![result("cat", 0.25), result("dog", 0.5), result("cow", f64::NAN)],
        bbox: vision_msgs::BoundingBox2D { center, size_x: 4.0, size_y: 8.0 },
        ..Default::default()
    };
    let message = vision_msgs::Detection2DArray {
        detections: vec![detection, Default::default()],
        ..Default::default()
    };
    let boxes: BoundingBoxList = bridge().from_message(message).unwrap();
    assert_eq!((&boxes.boxes[0].name, boxes.boxes[0].confidence), (&Name::from("dog"), 0.5));
    let [left, top, right, bottom] = boxes.boxes[0].corners();
    assert!((left - 6.0).abs() < 1e-5 && (top - 18.0).abs() < 1e-5, "{left} {top}");
    assert!((right - 14.0).abs() < 1e-5 && (bottom - 22.0).abs() < 1e-5, "{right} {bottom}");
    assert_eq!(boxes.boxes[1].confidence, 0.0);
}

#[test]
fn nan_is_handled() {
    let info = sensor_msgs::CameraInfo { p: [f64::NAN; 12], ..Default::default() };
    let error = bridge().from_message::<Calibration, _>(info).unwrap_err().to_string();
    assert!(error.contains("NaN"), "{error}");
    assert!(bridge().from_message::<Calibration, _>(sensor_msgs::CameraInfo::default()).is_err());
    let dim = |size| std_msgs::MultiArrayDimension { size, ..Default::default() };
    let layout = |sizes: &[u32]| std_msgs::MultiArrayLayout {
        dim: sizes.iter().map(|size| dim(*size)).collect(),
        ..Default::default()
    };
    for sizes in [&[2, 2][..], &[u32::MAX, u32::MAX, u32::MAX], &[3, 1, 1], &[0]] {
        let message = std_msgs::Float32MultiArray { layout: layout(sizes), data: vec![0.0; 3] };
        assert!(bridge().from_message::<Timeseries, _>(message).is_err(), "{sizes:?}");
    }
    let row = std_msgs::Float32MultiArray { data: vec![1.0, 2.0], ..Default::default() };
    assert_eq!(bridge().from_message::<Timeseries, _>(row).unwrap().shape(), [2, 1]);
}
