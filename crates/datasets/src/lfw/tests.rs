use opendr_engine::Silent;

use super::*;
use crate::folder::{TemporaryFolder, real_data};

fn faces() -> TemporaryFolder {
    TemporaryFolder::new()
        .with_picture("lfw/Ann/Ann_0001.jpg")
        .with_picture("lfw/Ann/Ann_0002.jpg")
        .with_picture("lfw/Bob_B/Bob_B_0001.jpg")
        .with("pairs.txt", "2\t1\nAnn\t1\t2\nAnn\t1\tBob_B\t1\nAnn\t2\t2\nBob_B\t1\tAnn\t2\n")
}

fn open(folder: &TemporaryFolder, split: Option<&str>) -> Result<Lfw> {
    let options = OpenOptions { split: split.map(str::to_owned), target: None };
    Lfw::open(folder.path(), &options, &Problems::strict())
}

fn classes(lfw: &Lfw) -> Vec<i64> {
    let class = |index| match lfw.target(index).unwrap() {
        Some(Value::Category(category)) => category.class,
        other => panic!("{other:?}"),
    };
    (0..lfw.len()).map(class).collect()
}

#[test]
fn pairs_of_lfw_are_read() {
    let folder = faces();
    assert_eq!(Lfw::recognise(folder.path()), Recognition::Certain);
    let lfw = open(&folder, None).unwrap();
    assert_eq!((classes(&lfw), lfw.fold(1), lfw.fold(2)), (vec![1, 0, 1, 0], Some(0), Some(1)));
    assert_eq!(lfw.name(1), "Ann_0001.jpg Bob_B_0001.jpg");
    assert_eq!(lfw.get(3).unwrap().data.len(), 2);
    assert_eq!(classes(&open(&folder, Some("2")).unwrap()), [1, 0]);
    assert!(open(&folder, Some("3")).is_err() && lfw.get(4).is_err());
}

#[test]
fn broken_lists_are_reported_by_line() {
    for (line, wanted) in [
        ("Ann 1", "pairs.txt:6: has 2 fields instead of 3 or 4"),
        ("Ann x 2", "pairs.txt:6: has \"x\" instead of an image number"),
        ("../Ann 1 2", "pairs.txt:6: the file name"),
        ("Ann 1 9", "pairs.txt:6: refers to "),
    ] {
        let text = std::fs::read_to_string(faces().path().join("pairs.txt")).unwrap();
        let folder = faces().with("pairs.txt", format!("{text}{line}\n"));
        assert!(open(&folder, None).unwrap_err().to_string().contains(wanted), "{line}");
        let problems = Problems::skipping();
        let lfw = Lfw::open(folder.path(), &OpenOptions::default(), &problems).unwrap();
        assert_eq!((lfw.len(), problems.count()), (4, 1));
    }
    let folder = faces().with("lfw/Ann/Ann_0002.jpg", "no picture");
    let lfw = open(&folder, None).unwrap();
    assert!(lfw.get(0).is_err() && lfw.get(1).is_ok());
}

#[test]
fn what_is_written_is_read() {
    let (folder, copy) = (faces(), TemporaryFolder::new());
    let lfw = open(&folder, None).unwrap();
    Lfw::write(&lfw, copy.path(), &WriteOptions::default(), &Problems::strict(), &Silent).unwrap();
    let again = open(&copy, None).unwrap();
    assert_eq!(classes(&again), classes(&lfw));
    assert_eq!(again.get(1).unwrap().data, lfw.get(1).unwrap().data);
    let wrong = copy.with("pairs.csv", "a,b,c\n000000_a.jpg,000000_b.png,Maybe\n");
    assert!(
        open(&wrong, None)
            .unwrap_err()
            .to_string()
            .contains("pairs.csv:2: has \"Maybe\" instead of Yes or No")
    );
}

#[test]
fn real_pairs_are_read() {
    let Some(root) = real_data("face_verification") else { return };
    let lfw = Lfw::open(&root, &OpenOptions::default(), &Problems::strict()).unwrap();
    let same = classes(&lfw).iter().filter(|class| **class == 1).count();
    assert_eq!((lfw.len(), same, Lfw::recognise(&root)), (300, 38, Recognition::Possible));
    assert_eq!(lfw.get(0).unwrap().data.len(), 2);
}
