use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::Name;
use opendr_engine::{Silent, Value, ValueType};
use proptest::prelude::*;

use super::labels::{object_from_line, track_from_line};
use super::*;
use crate::folder::{TemporaryFolder, real_data};
use crate::{Format, OpenOptions, Problems, Recognition, WriteOptions};

const CAR: &str = "Car 0.25 1 -1.5 599.5 156.25 629.75 189.5 2.5 1.5 3.5 -16 2.5 58.5 -1.25";
const IGNORED: &str = "DontCare -1 -1 -10 503 169 590 190 -1 -1 -1 -1000 -1000 -1000 -10";
const CALIBRATION: &str = "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nP2: 700 0 600 40 0 700 170 0 0 0 1 0\n\
                           R0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: 0 -1 0 0 0 0 -1 -0.5 1 0 0 -0.25\n";

fn scenes() -> TemporaryFolder {
    let mut folder = TemporaryFolder::new().with("ImageSets/val.txt", "000001\n");
    for id in ["000000", "000001"] {
        let scan: Vec<u8> = [1.0f32, 2.0, 3.0, 0.5].iter().flat_map(|number| number.to_le_bytes()).collect();
        folder = folder
            .with(&format!("training/label_2/{id}.txt"), format!("{CAR}\n{IGNORED}\n"))
            .with(&format!("training/calib/{id}.txt"), CALIBRATION)
            .with(&format!("training/velodyne/{id}.bin"), scan)
            .with_picture(&format!("training/image_2/{id}.png"));
    }
    folder
}

fn open(folder: &Path, options: &OpenOptions) -> Result<Kitti> {
    Kitti::open(folder, options, &Problems::strict())
}

#[test]
fn scenes_have_clouds_or_pictures() {
    let folder = scenes();
    assert_eq!(Kitti::recognise(folder.path()), Recognition::Certain);
    let kitti = open(folder.path(), &OpenOptions::default()).unwrap();
    assert_eq!((kitti.len(), kitti.name(1), kitti.ids().len()), (2, "000001".to_owned(), 2));
    let sample = kitti.get(0).unwrap();
    let Value::PointCloudWithCalibration(scan) = &sample.data[0] else { panic!() };
    assert_eq!(
        (scan.cloud.shape(), scan.image_shape, scan.calibration.p2[0][3]),
        ([1, 4], Some([3, 4]), 40.0)
    );
    let Some(Value::BoundingBox3DList(boxes)) = &sample.target else { panic!() };
    assert_eq!(boxes.boxes[0].dimensions, [3.5, 2.5, 1.5]);
    assert_eq!(boxes.boxes[1].name, Name::from("DontCare"));
    assert!(kitti.path(0).unwrap().ends_with("velodyne/000000.bin"));
    let flat = OpenOptions { target: Some(ValueType::BoundingBoxList), split: Some("val".into()) };
    let kitti = open(folder.path(), &flat).unwrap();
    assert_eq!((kitti.len(), kitti.name(0)), (1, "000001".to_owned()));
    let sample = kitti.get(0).unwrap();
    assert!(matches!(sample.data[..], [Value::Image(_)]));
    let Some(Value::BoundingBoxList(boxes)) = sample.target else { panic!() };
    assert_eq!(boxes.boxes[0].corners(), [599.5, 156.25, 629.75, 189.5]);
    let wrong = OpenOptions { target: Some(ValueType::PoseList), split: None };
    assert!(open(folder.path(), &wrong).is_err());
}

#[test]
fn wrong_calibrations_are_reported_by_line() {
    for (from, to, wanted) in [
        ("R0_rect", "R1_rect", "c.txt at R0_rect: this matrix is missing"),
        ("700 0 600", "700 0", "c.txt:2: P2 has 11 numbers instead of 12"),
        ("700 0 600", "700 nan 600", "c.txt:2: P2 has \"nan\" instead of a finite number"),
        ("P2: 700", "P2: 0", "c.txt:2: P2 has focal lengths 0 and 700"),
        ("R0_rect: 1 0 0 0 1 0", "R0_rect: 1 0 0 1 0 0", "c.txt:3: R0_rect is singular"),
        ("R0_rect: 1 0 0 0 1 0", "R0_rect: 0 1 0 1 0 0", "c.txt:3: R0_rect is not a rotation"),
        ("0 -1 0 0", "0 -2 0 0", "c.txt:4: Tr_velo_to_cam is not a rotation"),
    ] {
        let error = calibration_from_kitti(&CALIBRATION.replace(from, to), Path::new("c.txt")).unwrap_err();
        assert!(error.to_string().starts_with(wanted), "{error}");
    }
    let read = calibration_from_kitti(CALIBRATION, Path::new("c.txt")).unwrap();
    assert_eq!(calibration_from_kitti(&kitti_from_calibration(&read), Path::new("c.txt")).unwrap(), read);
    // The tracking benchmark has other names of matrices.
    let tracking = CALIBRATION.replace("R0_rect:", "R_rect").replace("velo_to_cam:", "velo_cam");
    assert_eq!(calibration_from_kitti(&tracking, Path::new("c.txt")).unwrap(), read);
}

#[test]
fn broken_scenes_are_reported() {
    for (name, bytes, wanted) in [
        ("label_2/000001.txt", &b"Car 1 2"[..], "000001.txt:1: has 3 fields instead of 15 to 16"),
        ("velodyne/000001.bin", &[0; 20], "000001.bin at byte 16: 20 bytes are not a multiple of 16"),
        ("velodyne/000001.bin", &[0xff; 16], "000001.bin at byte 0: point 0 has a value"),
        ("calib/000001.txt", b"P2: 1", "000001.txt:1: P2 has 1 numbers"),
    ] {
        let folder = scenes().with(&format!("training/{name}"), bytes);
        let kitti = open(folder.path(), &OpenOptions::default()).unwrap();
        assert!(kitti.get(0).is_ok());
        let error = kitti.get(1).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
    }
    let folder = scenes();
    std::fs::remove_file(folder.path().join("training/velodyne/000001.bin")).unwrap();
    let error = open(folder.path(), &OpenOptions::default()).unwrap_err();
    assert!(error.to_string().contains("000001.bin: is missing"), "{error}");
    let problems = Problems::skipping();
    let kitti = Kitti::open(folder.path(), &OpenOptions::default(), &problems).unwrap();
    assert_eq!((kitti.len(), problems.count()), (1, 1));
    let folder = scenes().with("ImageSets/val.txt", "../../etc/passwd\n");
    let val = OpenOptions { split: Some("val".into()), target: None };
    assert!(open(folder.path(), &val).unwrap_err().to_string().contains("val.txt:1: the file name"));
}

#[test]
fn wrong_lines_are_refused() {
    for (from, to, wanted) in [
        ("Car", "Tree", "has class \"Tree\""),
        ("629.75", "29.75", "has a box from (599.5, 156.25) to (29.75"),
        ("58.5", "NaN", "has \"NaN\" in field 14"),
        ("3.5", "-3.5", "has a box 2.5 high"),
        ("-1.25", "-71.6", "has rotation_y -71.6"),
        ("0.25 1", "0.25 x", "has \"x\" in field 3"),
    ] {
        let error = object_from_line(&CAR.replacen(from, to, 1)).unwrap_err();
        assert!(error.starts_with(wanted), "{error}");
    }
    assert!(track_from_line(&format!("0 -1 {IGNORED}")).is_ok());
    assert!(track_from_line(&format!("0 -1 {CAR}")).unwrap_err().starts_with("has object id -1"));
    assert!(track_from_line(&format!("-1 0 {CAR}")).unwrap_err().starts_with("has frame -1"));
}

#[test]
fn what_is_written_is_read() {
    let (folder, copy) = (scenes(), TemporaryFolder::new());
    for target in Kitti::TARGETS {
        let options = OpenOptions { target: Some(*target), split: None };
        let kitti = open(folder.path(), &options).unwrap();
        Kitti::write(&kitti, copy.path(), &WriteOptions::default(), &Problems::strict(), &Silent).unwrap();
        let again = open(copy.path(), &options).unwrap();
        assert_eq!(again.len(), 2);
        let mut data = kitti.get(1).unwrap().data;
        if let Value::PointCloudWithCalibration(scan) = &mut data[0] {
            // Only boxes in the image have images as data.
            scan.image_shape = None;
        }
        assert_eq!(again.get(1).unwrap().data, data, "{target:?}");
        assert_eq!(again.target(1).unwrap(), kitti.target(1).unwrap(), "{target:?}");
    }
}

#[test]
fn sequences_follow_one_another() {
    let labels = format!("1 3 {CAR}\n0 3 {CAR}\n1 -1 {IGNORED}\n1 -1 {IGNORED}\n");
    let folder = TemporaryFolder::new()
        .with("training/label_02/0000.txt", &labels)
        .with("training/label_02/0001.txt", format!("2 5 {CAR}\n"))
        .with_picture("training/image_02/0000/000000.png")
        .with_picture("training/image_02/0000/000001.png");
    assert_eq!(KittiTracking::recognise(folder.path()), Recognition::Certain);
    let open = |problems: &Problems| KittiTracking::open(folder.path(), &OpenOptions::default(), problems);
    let tracks = open(&Problems::strict()).unwrap();
    assert_eq!((tracks.len(), tracks.name(1)), (5, "0000/000001".to_owned()));
    assert_eq!([0, 1, 2, 4].map(|at| tracks.sequence(at).unwrap()), [0, 0, 1, 1]);
    let sample = tracks.get(1).unwrap();
    let Some(Value::TrackingAnnotation3DList(list)) = sample.target else { panic!() };
    assert_eq!(list.annotations.iter().map(|track| track.id).collect::<Vec<_>>(), [3, -1, -1]);
    assert_eq!(list.header, Header::new(100_000_000, "0000"));
    assert!(matches!(sample.data[..], [Value::Image(_)]));
    assert!(tracks.get(5).is_err());
    for (line, wanted) in [
        (format!("0 3 {CAR}\n"), "0000.txt:5: has object 3 twice"),
        (format!("7 3 {CAR}\n"), "0000.txt: labels frame 7, but the last recorded frame is 1"),
    ] {
        std::fs::write(folder.path().join("training/label_02/0000.txt"), format!("{labels}{line}")).unwrap();
        let error = open(&Problems::strict()).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
        let problems = Problems::skipping();
        assert_eq!((open(&problems).unwrap().len(), problems.count()), (5, 1));
    }
}

#[test]
fn real_scenes_are_read() {
    let Some(root) = real_data("kitti/object_vis") else { return };
    let kitti = open(&root, &OpenOptions::default()).unwrap();
    assert_eq!(kitti.len(), 2);
    let sample = kitti.get(1).unwrap();
    let Value::PointCloudWithCalibration(scan) = &sample.data[0] else { panic!() };
    assert_eq!((scan.cloud.len(), scan.image_shape), (120_268, Some([375, 1242])));
    let Some(Value::BoundingBox3DList(boxes)) = &sample.target else { panic!() };
    assert_eq!((boxes.boxes.len(), boxes.boxes[1].location), (7, [-16.53, 2.39, 58.49]));
}

proptest! {
    #[test]
    fn any_line_is_read_or_refused(
        line in "[-0-9.enaifCar ]{0,90}", changes in prop::collection::vec((0usize..70, " |[-0-9x.]"), 0..5)
    ) {
        let mut car = CAR.to_owned();
        for (at, text) in changes {
            car.replace_range(at..=at, &text);
        }
        for line in [&line, &car] {
            object_from_line(line).ok();
            track_from_line(line).ok();
            calibration_from_kitti(&format!("P2: {line}\nR0_rect: {line}"), Path::new("c.txt")).ok();
        }
    }
}
