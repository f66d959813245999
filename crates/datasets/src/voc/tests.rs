use opendr_engine::Silent;
use proptest::prelude::*;

use super::*;
use crate::folder::TemporaryFolder;
use crate::label_png::save_labels;

const XML: &str = "<annotation>\n<folder>VOC</folder>\n<filename>a.png</filename>\n\
<size><width>40</width><height>30</height><depth>3</depth></size>\n<object><name>dog</name>\n<difficult>0</difficult>\
<bndbox><xmin>2</xmin><ymin>3</ymin>\n<xmax>11</xmax><ymax>22.5</ymax></bndbox></object>\n\
<object><name>car</name><difficult>1</difficult><bndbox><ymin>1</ymin><xmin>1</xmin><xmax>40</xmax><ymax>30</ymax>\
</bndbox></object>\n</annotation>";

fn small() -> TemporaryFolder {
    let folder = TemporaryFolder::new();
    folder.write("Annotations/a.xml", XML);
    folder.write("ImageSets/Main/val.txt", "a\n");
    folder.picture("JPEGImages/a.png", 40, 30);
    folder
}

fn open(path: &Path, target: Option<ValueType>) -> Result<Voc> {
    Voc::open(path, &OpenOptions { split: None, target }, &Problems::strict())
}

#[test]
fn corners_count_from_one() {
    let folder = small();
    assert_eq!(Voc::recognise(folder.path()), Recognition::Certain);
    let voc = open(folder.path(), None).unwrap();
    assert_eq!((voc.len(), voc.name(0), voc.classes().len()), (1, "a.png".into(), 20));
    let (list, size) = voc.boxes(0).unwrap();
    assert_eq!((list.boxes[0].clone(), size), (BoundingBox::new(11, 1.0, 2.0, 10.0, 20.5, 1.0), [40, 30]));
    assert_eq!(list.boxes[1].corners(), [0.0, 0.0, 40.0, 30.0]);
    let difficult = list.boxes[1].segment.as_deref().unwrap();
    assert!(difficult.iscrowd && difficult.segmentation.is_empty());
    assert_eq!(voc.get(0).unwrap().target, Some(list.into()));
}

#[test]
fn what_is_written_is_read() {
    let (folder, other) = (small(), TemporaryFolder::new());
    folder.write("Annotations/a.xml", XML.replace("dog", "hot &amp; dog"));
    let mask = LabelMap { size: [40, 30], labels: (0..1200).map(|at| at / 40 % 3).collect() };
    save_labels(&mask, &folder.path().join("SegmentationObject/a.png"), true).unwrap();
    let voc = open(folder.path(), None).unwrap();
    assert_eq!(voc.classes().iter().collect::<Vec<_>>(), ["car", "hot & dog"]);
    let (list, _) = voc.boxes(0).unwrap();
    assert!(list.boxes.iter().all(|found| found.segment.as_deref().unwrap().area == 400.0));
    Voc::write(&voc, other.path(), &WriteOptions::default(), &Problems::strict(), &Silent).unwrap();
    let again = open(other.path(), None).unwrap();
    assert_eq!(again.get(0).unwrap(), voc.get(0).unwrap());
    assert!(other.path().join("ImageSets/Main/train.txt").is_file());
}

#[test]
fn masks_keep_their_indices() {
    let (folder, other) = (small(), TemporaryFolder::new());
    let mask = LabelMap { size: [40, 30], labels: (0..1200).map(|at| [0, 15, 255][at % 3]).collect() };
    save_labels(&mask, &folder.path().join("SegmentationClass/a.png"), true).unwrap();
    let voc = open(folder.path(), Some(ValueType::Heatmap)).unwrap();
    let Some(Value::Heatmap(map)) = voc.target(0).unwrap() else { panic!() };
    assert_eq!((map.shape(), map.classes.len()), (&[30, 40][..], 21));
    Voc::write(&voc, other.path(), &WriteOptions::default(), &Problems::strict(), &Silent).unwrap();
    assert_eq!(open(other.path(), None).unwrap().get(0).unwrap(), voc.get(0).unwrap());
    save_labels(
        &LabelMap { size: [40, 30], labels: vec![21; 1200] },
        &folder.path().join("SegmentationClass/a.png"),
        true,
    )
    .unwrap();
    assert!(voc.target(0).unwrap_err().to_string().contains("label 21 at column 0, row 0"));
}

#[test]
fn broken_files_are_reported() {
    let folder = small();
    let error = |from: &str, to: &str| {
        assert!(XML.contains(from), "{from}");
        folder.write("Annotations/a.xml", XML.replace(from, to));
        let error = open(folder.path(), None).unwrap_err().to_string();
        assert!(error.contains("Annotations/a.xml"), "{error}");
        error
    };
    assert!(error("</annotation>", "").contains("a.xml:"));
    assert!(error("<xmax>11</xmax>", "").contains("a.xml:6: <bndbox> has no <xmax>"));
    assert!(error("<xmax>11<", "<xmax>NaN<").contains("\"NaN\", not a finite number"));
    assert!(error("<xmax>11<", "<xmax>0<").contains("a box from 2,3 to 0,22.5"));
    assert!(error("<xmin>2</xmin>", "<xmin>200</xmin>").contains("a box from 200"));
    assert!(error("<width>40<", "<width>x<").contains("not a number of pixels"));
    assert!(error("<name>dog</name>", "").contains("<object> has no <name>"));
    assert!(error("annotation>", "other>").contains("<other> instead of <annotation>"));
    assert!(error("<annotation>", "<!DOCTYPE a [<!ENTITY b \"c\">]><annotation>").contains("not the XML"));
    folder.write("Annotations/a.xml", XML.replace("<width>40", "<width>41"));
    let voc = open(folder.path(), None).unwrap();
    assert!(voc.get(0).unwrap_err().to_string().contains("40x30 pixels, its annotation is for 41x30"));
    folder.write("Annotations/a.xml", XML.replace("a.png", "../../a.png"));
    std::fs::remove_file(folder.path().join("JPEGImages/a.png")).unwrap();
    assert!(open(folder.path(), None).unwrap_err().to_string().contains("is outside of the folder"));
    folder.write("Annotations/a.xml", XML.replace("<xmax>11<", "<xmax>x<"));
    let problems = Problems::skipping();
    assert!(Voc::open(folder.path(), &OpenOptions::default(), &problems).unwrap().is_empty());
    assert_eq!(problems.list()[0].location, Some(crate::Location::Line(6)));
    folder.write("ImageSets/Main/val.txt", "../a\n");
    assert!(open(folder.path(), None).unwrap_err().to_string().contains("val.txt:1: the file name"));
}

#[test]
fn labelling_programs_write_files_beside_pictures() {
    let folder = TemporaryFolder::new();
    folder.write("a.xml", XML.replace("dog", "robot"));
    folder.picture("a.png", 40, 30);
    assert_eq!(Voc::recognise(folder.path()), Recognition::Possible);
    assert_eq!(open(folder.path(), None).unwrap().get(0).unwrap().data.len(), 1);
}

#[test]
fn deep_files_are_errors() {
    let deep = format!("<annotation>{}{}</annotation>", "<a>".repeat(300_000), "</a>".repeat(300_000));
    assert_eq!(
        Annotation::new(Path::new("a.xml"), &deep).map(|annotation| annotation.objects.len()).ok(),
        Some(0)
    );
    assert!(Annotation::new(Path::new("a.xml"), &deep[..deep.len() / 2]).is_err());
    let wide = format!("<annotation>{}</annotation>", "<a/>".repeat(1_100_000));
    assert!(Annotation::new(Path::new("a.xml"), &wide).is_err());
}

proptest! {
    #[test]
    fn mutated_annotations_are_refused_or_read(at in 0usize..500, bytes in "[<>/&a-z0-9\"!\\-]{0,4}", cut in 0usize..5) {
        let start = at % XML.len();
        let text = format!("{}{bytes}{}", &XML[..start], &XML[(start + cut).min(XML.len())..]);
        let _ = Annotation::new(Path::new("a.xml"), &text);
    }
}
