use opendr_engine::Silent;
use opendr_engine::target::{BoundingBox, Name, Segmentation};
use proptest::prelude::*;

use super::*;
use crate::folder::{TemporaryFolder, real_data};

fn small() -> TemporaryFolder {
    let folder = TemporaryFolder::new();
    folder.write(
        "data.yaml",
        "path: /home/me/set\ntrain: images/train\nval: ../images/val\nnames: [cat, dog]\n",
    );
    folder.picture("images/val/a.png", 40, 20);
    folder.picture("images/val/more/b.png", 10, 10);
    folder.picture("images/train/c.png", 10, 10);
    folder.write("labels/val/a.txt", "1 0.5 0.5 0.25 0.5\n\n0 0.1 0.1 0.2 0.2 0.75\n");
    folder
}

fn open(path: &Path, split: Option<&str>) -> Result<Yolo> {
    let options = OpenOptions { split: split.map(str::to_owned), target: None };
    Yolo::open(path, &options, &Problems::strict())
}

fn boxes(yolo: &Yolo, at: usize) -> Result<BoundingBoxList> {
    match yolo.target(at)? {
        Some(Value::BoundingBoxList(list)) => Ok(list),
        other => panic!("{other:?}"),
    }
}

#[test]
fn fractions_become_pixels() {
    let folder = small();
    assert_eq!(Yolo::recognise(folder.path()), Recognition::Certain);
    let yolo = open(folder.path(), None).unwrap();
    assert_eq!((yolo.len(), yolo.name(0), yolo.name(1)), (2, "a.png".into(), "more/b.png".into()));
    let list = boxes(&yolo, 0).unwrap();
    assert_eq!(list.boxes[0], BoundingBox::new(1, 15.0, 5.0, 10.0, 10.0, 1.0));
    assert_eq!((list.boxes[1].confidence, list.label(&list.boxes[1])), (0.75, Some("cat")));
    assert_eq!(boxes(&yolo, 1).unwrap().boxes, []);
    assert_eq!(yolo.get(0).unwrap().target, Some(list.into()));
    assert!(open(folder.path(), Some("train")).is_err(), "no labels there");
    assert!(open(folder.path(), Some("other")).unwrap_err().to_string().contains("train, val"));
}

#[test]
fn polygons_are_read_and_written() {
    let (folder, other) = (small(), TemporaryFolder::new());
    folder.write("labels/val/a.txt", "1 0.25 0.5 0.75 0.5 0.75 1\n");
    let yolo = open(folder.path(), Some("val")).unwrap();
    let list = boxes(&yolo, 0).unwrap();
    let segment = list.boxes[0].segment.as_deref().unwrap();
    assert_eq!(segment.segmentation, Segmentation::Polygons(vec![vec![10.0, 10.0, 30.0, 10.0, 30.0, 20.0]]));
    assert_eq!((segment.area, list.boxes[0].corners()), (100.0, [10.0, 10.0, 30.0, 20.0]));
    let options = WriteOptions { split: Some("val".into()), link: false };
    Yolo::write(&yolo, other.path(), &options, &Problems::strict(), &Silent).unwrap();
    let again = open(other.path(), None).unwrap();
    assert_eq!((again.len(), again.classes()), (2, yolo.classes()));
    assert_eq!(boxes(&again, 0).unwrap(), list);
    assert_eq!(again.get(0).unwrap().data, yolo.get(0).unwrap().data);
    let text = std::fs::read_to_string(other.path().join("data.yaml")).unwrap();
    assert_eq!(text, "train: images/val\nval: images/val\nnames:\n  0: \"cat\"\n  1: \"dog\"\n");
}

#[test]
fn broken_lines_are_reported() {
    let folder = small();
    let error = |text: &str| {
        folder.write("labels/val/a.txt", text);
        let error = boxes(&open(folder.path(), None).unwrap(), 0).unwrap_err().to_string();
        assert!(error.contains("labels/val/a.txt:"), "{error}");
        error.rsplit_once("a.txt").unwrap().1.to_owned()
    };
    assert!(
        error("0 .5 .5 .5 .5\n2 .5 .5 .5 .5")
            .starts_with(":2: has class 2, which is not one of the 2 classes")
    );
    assert!(error("-1 .5 .5 .5 .5").contains("class -1"));
    assert!(error("0 .5 .5 NaN .5").contains("\"NaN\" in field 4"));
    assert!(error("0 1.5 .5 .5 .5").contains("outside of its image"));
    assert!(error("0 300 200 100 50").contains("fractions of the image"));
    assert!(error("0 .5 .5 -.5 .5").contains("-0.5 x 0.5"));
    assert!(error("0 .5 .5 .5").contains("has 4 fields"));
    assert!(error("0 .1 .1 .2 .2 .3 7").contains("a corner outside"));
    assert!(error("x .5 .5 .5 .5").contains("instead of an integer"));
}

#[test]
fn lists_are_limited_to_the_folder() {
    let folder = small();
    folder.write("data.yaml", "val: val.txt\nnames:\n  3: cat\n  1: dog\n");
    folder.write("val.txt", "./images/val/a.png\nimages/val/../../../x.png\n");
    folder.write("labels/val/a.txt", "3 .5 .5 .5 .5");
    assert!(open(folder.path(), None).unwrap_err().to_string().contains("val.txt:2: the file name"));
    let problems = Problems::skipping();
    let yolo = Yolo::open(folder.path(), &OpenOptions::default(), &problems).unwrap();
    assert_eq!((yolo.len(), problems.count(), yolo.class_ids()), (1, 1, vec![1, 3]));
    assert_eq!(boxes(&yolo, 0).unwrap().boxes[0].name, Name::Index(1));
    folder.write("data.yaml", "val: images/val\nkpt_shape: [17, 3]\nnames: [person]\n");
    assert!(open(folder.path(), None).unwrap_err().to_string().contains("keypoints are not supported"));
}

#[cfg(unix)]
#[test]
fn cyclic_links_are_reported() {
    let folder = small();
    std::os::unix::fs::symlink("..", folder.path().join("images/val/more/loop")).unwrap();
    assert!(open(folder.path(), None).unwrap_err().to_string().contains("a link to a folder above it"));
    let problems = Problems::skipping();
    let yolo = Yolo::open(folder.path(), &OpenOptions::default(), &problems).unwrap();
    assert_eq!((yolo.len(), problems.count()), (2, 1));
}

#[test]
fn coco128_is_read() {
    let Some(folder) = real_data("coco128") else { return };
    for path in [folder.join("object_detection"), folder] {
        for split in [None, Some("val"), Some("val2017")] {
            let yolo = open(&path, split).unwrap();
            assert_eq!((yolo.len(), yolo.classes().len()), (65, 80), "{split:?}");
            let count: usize = (0..yolo.len()).map(|at| boxes(&yolo, at).unwrap().boxes.len()).sum();
            assert!(count > 400, "{count}");
        }
    }
}

proptest! {
    #[test]
    fn mutated_labels_are_refused_or_read(at in 0usize..60, bytes in proptest::collection::vec(any::<u8>(), 0..4)) {
        let mut text = b"1 0.5 0.5 0.25 0.5\n0 0.1 0.1 0.2 0.2 0.3 0.3".to_vec();
        let start = at % text.len();
        text.splice(start..(start + 2).min(text.len()), bytes);
        for line in String::from_utf8_lossy(&text).lines() {
            if let Ok(found) = label::box_from_line(line, [40, 20], Ok) {
                prop_assert!(found.corners().iter().all(|number| number.is_finite()));
            }
        }
    }

    #[test]
    fn any_yaml_is_refused_or_read(text in "[a-z0-9:\\[\\]{}'\"#| \n-]{0,60}") {
        let _ = yaml::Keys::new(Path::new("data.yaml"), &text);
    }
}
