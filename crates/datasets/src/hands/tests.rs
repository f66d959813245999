use opendr_engine::Silent;
use opendr_engine::data::{Image, Layout, PixelFormat};

use super::*;
use crate::folder::TemporaryFolder;

const LABELS: &str = "RGB,Depth,One,Punch\n\
                      D:\\set\\color_1.png,D:\\set\\color_1.png,[0 0 0 0],[1 2 3 4]\n\
                      D:\\set\\color_2.png,D:\\set\\color_2.png,[1 1 2 2],[1 2 3 4]\n";

fn with_depth(folder: TemporaryFolder, name: &str) -> TemporaryFolder {
    let depth =
        Image::new((0..12).map(|at| at * 1000).collect::<Vec<u16>>(), 4, 3, PixelFormat::Grey, Layout::Hwc);
    let path = folder.path().join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    save_depth(&depth.unwrap(), path).unwrap();
    folder
}

fn hands() -> TemporaryFolder {
    let folder = TemporaryFolder::new()
        .with("Subject1/Subject1.txt", LABELS)
        .with_picture("Subject1/Subject1/color_1.png")
        .with_picture("Subject1/Subject1/color_2.png")
        .with("Subject4/Subject4.txt", "RGB,Depth,One\ncolor_1.png,depth_1.png,[1 2 3 4]\n")
        .with_picture("Subject4/Subject4/color_1.png");
    [
        "Subject1/Subject1_Depth/depth_1.png",
        "Subject1/Subject1_Depth/depth_2.png",
        "Subject4/Subject4_Depth/depth_1.png",
    ]
    .into_iter()
    .fold(folder, with_depth)
}

fn open(folder: &TemporaryFolder, split: Option<&str>) -> Result<Hands> {
    let options = OpenOptions { split: split.map(str::to_owned), target: None };
    Hands::open(folder.path(), &options, &Problems::strict())
}

fn class(hands: &Hands, index: usize) -> (i64, String) {
    match hands.target(index).unwrap() {
        Some(Value::Category(category)) => {
            (category.class, category.description.as_deref().unwrap().to_owned())
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn subjects_have_gestures() {
    let folder = hands();
    assert_eq!(Hands::recognise(folder.path()), Recognition::Certain);
    let all = open(&folder, None).unwrap();
    assert_eq!(all.classes().iter().collect::<Vec<_>>(), ["One", "One_AND_Punch", "Punch"]);
    assert_eq!([0, 1, 2].map(|at| class(&all, at).0), [2, 1, 0]);
    let sample = all.get(0).unwrap();
    let [Value::Image(colour), Value::Image(depth)] = &sample.data[..] else { panic!() };
    assert_eq!((colour.channels(), depth.channels(), depth.width()), (3, 1, 4));
    assert!(matches!(depth.pixels(), opendr_engine::data::Pixels::U16(samples) if samples[11] == 11_000));
    let test = open(&folder, Some("test")).unwrap();
    assert_eq!((test.len(), class(&test, 0)), (1, (0, "One".to_owned())));
    assert_eq!(open(&folder, Some("train")).unwrap().len(), 2);
    assert!(open(&folder, Some("Subject9")).is_err());
}

#[test]
fn broken_labels_are_reported_by_line() {
    for (line, wanted) in [
        ("color_1.png,color_1.png,[1 2 3 4]", "Subject1.txt:4: has 1 boxes, but the first line has 2"),
        (
            "color_1.png,color_1.png,[0 0 0 0],[1 2 x 4]",
            "Subject1.txt:4: has \"[1 2 x 4]\" as the box of Punch",
        ),
        ("color_1.png,color_1.png,[0 0 0 0],[0 0 0 0]", "Subject1.txt:4: has no gesture"),
        ("color_9.png,color_1.png,[0 0 0 0],[1 2 3 4]", "Subject1.txt:4: refers to "),
        ("..,color_1.png,[0 0 0 0],[1 2 3 4]", "Subject1.txt:4: the file name \"..\""),
        ("x", "Subject1.txt:4: has 1 fields instead of 4"),
    ] {
        let folder = hands().with("Subject1/Subject1.txt", format!("{LABELS}{line}\n"));
        let error = open(&folder, None).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
        let problems = Problems::skipping();
        let skipped = Hands::open(folder.path(), &OpenOptions::default(), &problems).unwrap();
        assert_eq!((skipped.len(), problems.count()), (3, 1));
    }
    let folder = hands().with("Subject1/Subject1_Depth/depth_2.png", "no picture");
    let broken = open(&folder, None).unwrap();
    assert!(broken.get(0).is_ok() && broken.get(1).is_err());
}

#[test]
fn what_is_written_is_read() {
    let (folder, copy) = (hands(), TemporaryFolder::new());
    let hands = open(&folder, None).unwrap();
    let options = WriteOptions { split: Some("train".into()), link: false };
    Hands::write(&hands, copy.path(), &options, &Problems::strict(), &Silent).unwrap();
    assert_eq!(Hands::recognise(copy.path()), Recognition::Certain);
    let again = open(&copy, Some("train")).unwrap();
    let samples = |hands: &Hands| {
        let mut samples: Vec<_> =
            (0..hands.len()).map(|at| (class(hands, at), hands.get(at).unwrap())).collect();
        samples.sort_by_key(|(class, _)| class.0);
        samples
    };
    assert_eq!(samples(&again), samples(&hands));
    std::fs::remove_file(again.depth_path(0).unwrap()).unwrap();
    assert!(
        open(&copy, Some("train")).unwrap_err().to_string().contains("is missing beside its colour image")
    );
}
