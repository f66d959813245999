use opendr_engine::Silent;
use opendr_engine::data::SkeletonSequence;
use proptest::prelude::*;

use super::*;
use crate::folder::{TemporaryFolder, real_data};
use crate::npy_from_values;

/// Two frames; body 7 stands still in both, body 8 moves, body 9 is in one frame.
fn ntu() -> String {
    let body = |id: u32, x: f32| {
        let joints: String =
            (0..25).map(|joint| format!("{} {joint} 0.5 0 0 0 0 0 0 0 0 2\n", x + joint as f32)).collect();
        format!("{id} 0 1 1 1 1 0 0.1 0.2 2\n25\n{joints}")
    };
    format!("2\n3\n{}{}{}2\n{}{}", body(9, 5.0), body(7, 1.0), body(8, 2.0), body(7, 1.0), body(8, 4.0))
}

fn open(folder: &TemporaryFolder, split: Option<&str>) -> Result<Skeletons> {
    let options = OpenOptions { split: split.map(str::to_owned), target: None };
    Skeletons::open(folder.path(), &options, &Problems::strict())
}

fn sequence_of(skeletons: &Skeletons, index: usize) -> SkeletonSequence {
    match skeletons.get(index).unwrap().data.remove(0) {
        Value::SkeletonSequence(sequence) => sequence,
        other => panic!("{other:?}"),
    }
}

#[test]
fn bodies_keep_their_place() {
    let sequence = skeleton_from_ntu(&ntu()).unwrap();
    assert_eq!(sequence.shape(), [1, 3, 2, 25, 2]);
    let at = |axis: usize, frame: usize, joint: usize, person: usize| {
        sequence.as_slice()[((axis * 2 + frame) * 25 + joint) * 2 + person]
    };
    // Body 8 moves most; of the others, the first in the file is kept.
    assert_eq!([at(0, 0, 3, 0), at(0, 1, 3, 0), at(1, 1, 24, 0), at(2, 0, 0, 0)], [5.0, 7.0, 24.0, 0.5]);
    assert_eq!([at(0, 0, 0, 1), at(0, 1, 0, 1)], [5.0, 0.0]);
}

#[test]
fn broken_recordings_are_reported_by_line() {
    for (from, to, line, wanted) in [
        ("2\n3\n", "99999999999\n3\n", 1, "has an invalid number of frames"),
        ("2\n3\n", "2\n-3\n", 2, "has an invalid number of bodies"),
        ("\n25\n", "\n24\n", 4, "has 24 joints instead of 25"),
        ("5 0 0.5", "nan 0 0.5", 5, "has \"nan\" in field 1"),
        ("5 0 0.5 0 0 0 0 0 0 0 0 2", "5", 5, "has 1 fields instead of 3 to 12"),
    ] {
        let (at, message) = skeleton_from_ntu(&ntu().replacen(from, to, 1)).unwrap_err();
        assert!(at == line && message.starts_with(wanted), "{at}: {message}");
    }
    let text = ntu();
    assert!(skeleton_from_ntu(&text[..text.len() - 30]).unwrap_err().1.starts_with("the file is truncated"));
    assert!(skeleton_from_ntu("1\n0\n").unwrap_err().1.starts_with("no frame has a body"));
}

#[test]
fn names_have_class_and_part() {
    let folder = TemporaryFolder::new()
        .with("S001C001P001R001A013.skeleton", ntu())
        .with("S001C002P003R002A060.skeleton", "x");
    let all = open(&folder, None).unwrap();
    assert_eq!((Skeletons::recognise(folder.path()), all.len()), (Recognition::Certain, 2));
    let Some(Value::Category(category)) = all.get(0).unwrap().target else { panic!() };
    assert_eq!((category.class, category.description.as_deref()), (12, Some("A013")));
    assert!(all.get(1).unwrap_err().to_string().contains("A060.skeleton:1: has \"x\""));
    for (part, name) in
        [("xsub_train", "A013"), ("xsub_val", "A060"), ("xview_train", "A060"), ("xview_val", "A013")]
    {
        let skeletons = open(&folder, Some(part)).unwrap();
        assert!(skeletons.len() == 1 && skeletons.name(0).contains(name), "{part}");
    }
    assert!(open(&folder, Some("other")).is_err());
    let wrong = TemporaryFolder::new().with("S001C001P001R001A121.skeleton", ntu());
    assert!(open(&wrong, None).unwrap_err().to_string().contains("its name has action 121"));
}

#[test]
fn what_is_written_is_read() {
    let folder = TemporaryFolder::new()
        .with("val_data.npy", npy_from_values(&[1.0, 2.0, 3.0, 4.0], &[2, 1, 2, 1, 1]).unwrap())
        .with("val_label.npy", npy_from_values(&[1_i64, 0], &[2]).unwrap())
        .with("label_map.txt", "sit\nwave\n");
    let skeletons = open(&folder, None).unwrap();
    let Some(Value::Category(category)) = skeletons.get(0).unwrap().target else { panic!() };
    assert_eq!((category.class, category.description.as_deref()), (1, Some("wave")));
    assert_eq!(sequence_of(&skeletons, 1).as_slice(), [3.0, 4.0]);
    let copy = TemporaryFolder::new();
    let options = WriteOptions { split: Some("train".into()), link: false };
    Skeletons::write(&skeletons, copy.path(), &options, &Problems::strict(), &Silent).unwrap();
    let again = open(&copy, None).unwrap();
    assert_eq!(
        (0..2).map(|at| again.get(at).unwrap()).collect::<Vec<_>>(),
        (0..2).map(|at| skeletons.get(at).unwrap()).collect::<Vec<_>>()
    );
}

#[test]
fn broken_arrays_are_reported() {
    let good = npy_from_values(&[1.0, f32::NAN], &[2, 1, 1, 1, 1]).unwrap();
    for (data, labels, wanted) in [
        (npy_from_values(&[1.0], &[1]).unwrap(), vec![0_i64], "val_data.npy: has shape [1]"),
        (good.clone(), vec![0, 1, 2], "val_label.npy: has 3 classes for 2 samples"),
        (good.clone(), vec![0, -1], "val_label.npy at sample 1: has class -1"),
    ] {
        let folder = TemporaryFolder::new()
            .with("val_data.npy", data)
            .with("val_label.npy", npy_from_values(&labels, &[labels.len()]).unwrap());
        let error = open(&folder, None).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
    }
    let folder = TemporaryFolder::new()
        .with("val_data.npy", good)
        .with("val_label.npy", npy_from_values(&[0_i64, 1], &[2]).unwrap());
    let skeletons = open(&folder, None).unwrap();
    assert!(skeletons.get(0).is_ok());
    assert!(skeletons.get(1).unwrap_err().to_string().contains("sample 1: value 0 is NaN"));
}

#[test]
fn real_poses_are_read() {
    let Some(root) = real_data("skeleton") else { return };
    let options = |file: &str| OpenOptions { split: Some(file.into()), target: None };
    for (part, len, frames) in [("jhmdb_GT_test_1", 176, 40), ("jhmdb_GT_train_1", 433, 33)] {
        let poses = Skeletons::open(&root, &options(part), &Problems::strict()).unwrap();
        assert_eq!((poses.len(), poses.class(0).is_ok()), (len, true));
        let [one, channels, length, joints, persons] = sequence_of(&poses, 0).shape();
        assert_eq!([one, channels, joints, persons], [1, 2, 15, 1]);
        assert!(length == frames || part.contains("train"));
    }
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(at in 0usize..2000, byte in "[-0-9 .x\n]", cut in 0usize..4000) {
        let mut text = ntu();
        let at = at.min(text.len() - 1);
        text.replace_range(at..=at, &byte);
        text.truncate(cut.min(text.len()));
        skeleton_from_ntu(&text).ok();
    }
}
