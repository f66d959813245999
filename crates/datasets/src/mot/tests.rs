use opendr_engine::Silent;
use opendr_engine::target::TrackingAnnotation;
use proptest::prelude::*;

use super::row::RowKind;
use super::*;
use crate::folder::TemporaryFolder;

const TRUTH: &str = "2,1,11,20,30,40,1,1,0.75\n1,1,10,20,30,40,1,1,1\n1,7,50,60,10,20,0,8,0.5\n";

fn challenge() -> TemporaryFolder {
    TemporaryFolder::new()
        .with("train/A/gt/gt.txt", TRUTH)
        .with("train/A/det/det.txt", "1,-1,9,19,31,41,0.875\n")
        .with(
            "train/A/seqinfo.ini",
            "[Sequence]\nname=A\nimDir=img1\nframeRate=10\nseqLength=2\nimWidth=4\nimHeight=3\n",
        )
        .with_picture("train/A/img1/000001.jpg")
        .with_picture("train/A/img1/000002.jpg")
        .with("train/B/gt/gt.txt", "3,4,1,2,3,4,1,-1,-1,-1\n")
        .with("test/C/det/det.txt", "1,-1,1,2,3,4,0.5,-1,-1,-1\n")
}

fn open(folder: &TemporaryFolder, problems: &Problems) -> Result<Mot> {
    Mot::open(folder.path(), &OpenOptions::default(), problems)
}

fn tracks(mot: &Mot, index: usize) -> TrackingAnnotationList {
    match mot.get(index).unwrap().target {
        Some(Value::TrackingAnnotationList(tracks)) => tracks,
        other => panic!("{other:?}"),
    }
}

#[test]
fn sequences_follow_one_another() {
    let folder = challenge();
    assert_eq!(Mot::recognise(folder.path()), Recognition::Certain);
    let mot = open(&folder, &Problems::strict()).unwrap();
    let names: Vec<_> = mot.sequences().iter().map(MotSequence::name).collect();
    assert_eq!((names, mot.len()), (vec!["A", "B"], 5));
    assert_eq!([1, 2, 4].map(|index| mot.sequence_and_frame(index).unwrap()), [(0, 1), (1, 0), (1, 2)]);
    assert_eq!(mot.sequences()[0].image_size(), Some([4, 3]));
    let first = tracks(&mot, 0);
    assert_eq!(first.mot_text(), "1,1,10,20,30,40,1,-1,-1,-1\n1,7,50,60,10,20,0,-1,-1,-1\n");
    assert_eq!(first.classes.label(&first.annotations[1].bounding_box.name), Some("distractor"));
    let second = mot.get(1).unwrap();
    assert_eq!(second.data[0].header(), &Header::new(100_000_000, "A"));
    // Detections are data if tracks are the target, and not if boxes are to be learned.
    let sample = mot.get(0).unwrap();
    let Value::BoundingBoxList(found) = &sample.data[1] else { panic!("{sample:?}") };
    assert_eq!(found.boxes[0].corners(), [9.0, 19.0, 40.0, 60.0]);
    assert!(matches!(&second.data[1], Value::BoundingBoxList(found) if found.boxes.is_empty()));
    let options = OpenOptions { target: Some(ValueType::BoundingBoxList), ..OpenOptions::default() };
    let boxes = Mot::open(folder.path(), &options, &Problems::strict()).unwrap();
    assert_eq!(boxes.get(0).unwrap().data.len(), 1);
    assert_eq!(mot.sequences()[0].ground_truth(2)[0].visibility, 0.75);
    assert!(mot.get(2).unwrap().data.is_empty());
    assert_eq!(tracks(&mot, 4).annotations[0].id, 4);
    assert_eq!(mot.detections(0).unwrap().boxes[0].confidence, 0.875);
    assert_eq!([0, 1, 2].map(|index| mot.sequence(index)), [Some(0), Some(0), Some(1)]);
    assert_eq!((mot.name(1), mot.image_size(1)), ("A/000002".to_owned(), Some([4, 3])));
    assert!(mot.path(1).unwrap().ends_with("train/A/img1/000002.jpg") && mot.path(2).is_none());
    assert!(mot.get(5).is_err() && mot.detections(5).is_none());
}

#[test]
fn parts_and_boxes_are_selected() {
    let folder = challenge();
    let options = OpenOptions { split: Some("test".into()), target: Some(ValueType::BoundingBoxList) };
    let mot = Mot::open(folder.path(), &options, &Problems::strict()).unwrap();
    assert_eq!((mot.len(), mot.sequences()[0].name()), (1, "C"));
    let options = OpenOptions { split: None, ..options };
    let boxes = Mot::open(folder.path(), &options, &Problems::strict()).unwrap().get(0).unwrap().target;
    assert!(matches!(boxes, Some(Value::BoundingBoxList(boxes)) if boxes.boxes.len() == 1));
    let missing = OpenOptions { split: Some("../x".into()), target: None };
    let error = Mot::open(folder.path(), &missing, &Problems::strict()).unwrap_err();
    assert!(error.to_string().contains("there are test, train"), "{error}");
}

#[test]
fn bare_files_are_sequences() {
    let folder = TemporaryFolder::new()
        .with("TUD/gt.txt", "1,1,399,182,121,229,1,-1,-1,-1\n")
        .with("TUD/test.txt", "x");
    assert_eq!(open(&folder, &Problems::strict()).unwrap().sequences()[0].name(), "TUD");
    let folder = TemporaryFolder::new().with("a.txt", TRUTH).with("b.txt", "4,1,1,2,3,4,1\n");
    assert_eq!(Mot::recognise(folder.path()), Recognition::Possible);
    assert_eq!(open(&folder, &Problems::strict()).unwrap().len(), 6);
    let file = Mot::open(&folder.path().join("b.txt"), &OpenOptions::default(), &Problems::strict()).unwrap();
    assert_eq!(file.len(), 4);
    let yolo = TemporaryFolder::new().with("a.txt", "0 0.5 0.5 0.1 0.1\n");
    assert!(matches!(Mot::recognise(yolo.path()), Recognition::No(_)));
    assert!(open(&yolo, &Problems::strict()).unwrap_err().to_string().contains("no sequence in"));
}

#[test]
fn broken_rows_are_reported_and_skipped() {
    for (line, wanted) in [
        ("1,2,3,4,5", "gt.txt:4: has 5 fields instead of 6 to 10"),
        ("1,2,3,4,nan,6,1,1,1", "gt.txt:4: has \"nan\" in field 5"),
        ("1,2,3,4,5,6,1,14,1", "gt.txt:4: has class 14"),
        ("1,2,3,4,5,6,1,1,1.5", "gt.txt:4: has visibility 1.5"),
        ("0,2,3,4,5,6,1,1,1", "gt.txt:4: has frame 0"),
        ("9000000000,2,3,4,5,6,1,1,1", "gt.txt:4: has frame 9000000000"),
        ("3,2,3,4,5,6,1,1,1", "gt.txt:4: has frame 3, but the sequence has 2"),
        ("1,-1,3,4,5,6,1,1,1", "gt.txt:4: has object id -1"),
        ("1,7,3,4,5,6,1,1,1", "gt.txt:4: has object 7 twice"),
        ("1,2,3,4,0,6,1,1,1", "gt.txt:4: has a box of 0 x 6 pixels"),
    ] {
        let folder = challenge().with("train/A/gt/gt.txt", format!("{TRUTH}{line}\n"));
        let error = open(&folder, &Problems::strict()).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
        let problems = Problems::skipping();
        assert_eq!((open(&folder, &problems).unwrap().len(), problems.count()), (5, 1));
    }
}

#[test]
fn broken_folders_are_reported() {
    for (name, text, wanted) in [
        ("train/A/seqinfo.ini", "imDir=../..\n", "seqinfo.ini:1: has \"../..\" as imDir"),
        ("train/A/seqinfo.ini", "seqLength=99999999999\n", "seqinfo.ini:1: has \"99999999999\" as seqLength"),
        ("train/A/seqinfo.ini", "seqLength=3\n", "seqLength is 3, but the last image is number 2"),
        ("train/A/img1/000004.jpg", "", "the image before it is number 2"),
        ("train/A/img1/x.jpg", "", "its name is not a number"),
    ] {
        let folder = challenge().with(name, text);
        let error = open(&folder, &Problems::strict()).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
    }
    // A broken image affects no others.
    let folder = challenge().with("train/A/img1/000002.jpg", "no picture");
    let mot = open(&folder, &Problems::strict()).unwrap();
    assert!(mot.get(0).is_ok() && mot.get(1).is_err() && mot.get(2).is_ok());
}

#[test]
fn what_is_written_is_read() {
    let (folder, copy) = (challenge(), TemporaryFolder::new());
    let mot = open(&folder, &Problems::strict()).unwrap();
    Mot::write(&mot, copy.path(), &WriteOptions::default(), &Problems::strict(), &Silent).unwrap();
    let again = open(&copy, &Problems::strict()).unwrap();
    assert_eq!(again.len(), mot.len());
    for index in 0..mot.len() {
        assert_eq!(tracks(&again, index).annotations, tracks(&mot, index).annotations, "{index}");
        assert_eq!(again.get(index).unwrap().data.len(), mot.get(index).unwrap().data.len());
        let boxes = |mot: &Mot| mot.detections(index).unwrap().boxes;
        assert_eq!(boxes(&again), boxes(&mot), "{index}");
    }
}

#[test]
fn results_both_ways() {
    let folder = TemporaryFolder::new();
    let path = folder.path().join("A.txt");
    let track = TrackingAnnotation::from_mot(&[2.0, 5.0, 1.0, 2.0, 3.0, 4.0, 0.5]).unwrap();
    let list = TrackingAnnotationList::from(vec![track.clone()]);
    write_mot_results(&path, &list).unwrap();
    assert_eq!(open_mot_results(&path).unwrap(), list);
    let lost = TrackingAnnotationList::from(vec![TrackingAnnotation { id: -1, ..track }]);
    assert!(write_mot_results(&path, &lost).is_err());
}

proptest! {
    #[test]
    fn any_line_is_read_or_refused(line in "[-0-9.,enaif ]{0,60}") {
        for kind in [RowKind::GroundTruth, RowKind::Detections] {
            MotRow::parse(&line, kind).ok();
        }
    }
}
