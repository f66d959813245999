use opendr_engine::Silent;
use opendr_engine::target::{BoundingBox, Name, Segmentation};
use proptest::prelude::*;

use super::*;
use crate::folder::{TemporaryFolder, real_data};

const FILE: &str = "annotations/instances_val2017.json";

/// Two images, unordered annotations, gaps in the category ids, and an unknown key.
const SMALL: &str = r#"{"info": {"about": "a \"]}\" b"},
"images": [{"id": 139, "file_name": "a.png", "width": 40, "height": 30, "license": 1},
           {"id": 7, "file_name": "b.png", "width": 20, "height": 20}],
"annotations": [
 {"id": 3, "image_id": 7, "category_id": 90, "bbox": [1, 2, 3.25, 4], "area": 6.5, "iscrowd": 0,
  "segmentation": [[1.5, 2, 4, 2, 4, 6]]},
 {"id": 1, "image_id": 139, "category_id": 18, "bbox": [0, 0, 40, 30]},
 {"id": 2, "image_id": 7, "category_id": 18, "bbox": [0, 0, 20, 20], "area": 390, "iscrowd": 1,
  "segmentation": {"size": [20, 20], "counts": [5, 390, 5]}}],
"categories": [{"id": 90, "name": "toothbrush"}, {"id": 18, "name": "dog"}]}"#;

fn small() -> TemporaryFolder {
    let scratch = TemporaryFolder::new();
    scratch.write(FILE, SMALL);
    scratch.picture("val2017/a.png", 40, 30);
    scratch.picture("val2017/b.png", 20, 20);
    scratch
}

fn open(path: &Path, problems: &Problems) -> Result<Coco> {
    Coco::open(path, &OpenOptions::default(), problems)
}

fn boxes(coco: &Coco, at: usize) -> BoundingBoxList {
    match coco.target(at).unwrap() {
        Some(Value::BoundingBoxList(list)) => list,
        other => panic!("{other:?}"),
    }
}

/// Returns the problems of opening `text` in skip mode; strict mode must fail with the first.
fn problems_of(text: &str) -> Vec<String> {
    let scratch = TemporaryFolder::new();
    let path = scratch.write("a.json", text);
    let problems = Problems::skipping();
    let opened = open(&path, &problems);
    let strict = open(&path, &Problems::strict()).map(|_| ()).unwrap_err().to_string();
    let cut = |text: String| {
        text.replace(&format!("{}: ", path.display()), "").replace(&*path.to_string_lossy(), "")
    };
    let mut found: Vec<_> = problems.list().iter().map(|problem| cut(problem.to_string())).collect();
    found.extend(opened.err().map(|error| cut(error.to_string())));
    assert_eq!(cut(strict), found[0]);
    found
}

#[test]
fn pictures_have_their_annotations() {
    let scratch = small();
    assert_eq!(Coco::recognise(scratch.path()), Recognition::Certain);
    let coco = open(scratch.path(), &Problems::strict()).unwrap();
    assert_eq!((coco.len(), coco.class_ids()), (2, vec![18, 90]));
    assert_eq!(coco.classes().iter().collect::<Vec<_>>(), ["dog", "toothbrush"]);
    assert_eq!((coco.name(1), coco.id(1), coco.image_size(0)), ("b.png".into(), Some(7), Some([40, 30])));
    let first = boxes(&coco, 0);
    assert_eq!(first.boxes, [BoundingBox::new(0, 0.0, 0.0, 40.0, 30.0, 1.0)]);
    let second = boxes(&coco, 1);
    assert_eq!((second.image_id, second.boxes.len()), (Some(7), 2));
    let [brush, dog] = [0, 1].map(|at| second.boxes[at].segment.as_deref().unwrap());
    assert_eq!((second.boxes[0].name.clone(), brush.area, brush.iscrowd), (Name::Index(1), 6.5, false));
    assert_eq!(brush.segmentation, Segmentation::Polygons(vec![vec![1.5, 2.0, 4.0, 2.0, 4.0, 6.0]]));
    assert!(dog.iscrowd && matches!(&dog.segmentation, Segmentation::Rle(rle) if rle.area() == 390));
    let sample = coco.get(1).unwrap();
    assert!(matches!(&sample.data[..], [Value::Image(image)] if image.width() == 20));
    assert!(coco.get(2).is_err());
}

#[test]
fn what_is_written_is_read() {
    let (scratch, other) = (small(), TemporaryFolder::new());
    let coco = open(scratch.path(), &Problems::strict()).unwrap();
    let options = WriteOptions { split: Some("mine".into()), link: true };
    Coco::write(&coco, other.path(), &options, &Problems::strict(), &Silent).unwrap();
    let again = open(other.path(), &Problems::strict()).unwrap();
    assert_eq!((again.class_ids(), again.classes()), (coco.class_ids(), coco.classes()));
    for at in 0..2 {
        assert_eq!(again.get(at).unwrap(), coco.get(at).unwrap());
        assert_eq!((again.name(at), again.id(at)), (coco.name(at), coco.id(at)));
    }
    let file = other.path().join("only.json");
    Coco::write(&coco, &file, &options, &Problems::strict(), &Silent).unwrap();
    assert_eq!(boxes(&open(&file, &Problems::strict()).unwrap(), 1), boxes(&coco, 1));
    let left: Vec<_> =
        std::fs::read_dir(other.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 3, "{left:?}");
}

#[test]
fn results_have_the_ids_of_the_file() {
    let scratch = small();
    let coco = open(scratch.path(), &Problems::strict()).unwrap();
    let mut found = BoundingBoxList::from(vec![BoundingBox::new(1, 1.0, 2.0, 3.0, 4.0, 0.5)]);
    let entries = |found: &BoundingBoxList| {
        let entries = coco_results(&coco, 1, found)?;
        Ok::<_, Error>(
            entries.iter().map(|entry| (entry.image_id, entry.category_id.clone())).collect::<Vec<_>>(),
        )
    };
    assert_eq!(entries(&found).unwrap(), [(Some(7), Name::Index(90))]);
    found.classes = ["person", "dog"].into_iter().collect();
    assert_eq!(entries(&found).unwrap(), [(Some(7), Name::Index(18))]);
    found.boxes[0].name = Name::Index(0);
    assert!(entries(&found).unwrap_err().to_string().contains("no class \"person\""));
}

#[test]
fn poses_keep_visibility_and_region() {
    let scratch = TemporaryFolder::new();
    let points: Vec<f32> = (0..17).flat_map(|at| [at as f32, 2.0, (at % 3) as f32]).collect();
    let path = scratch.write(
        "annotations/person_keypoints_val.json",
        format!(
            r#"{{"images":[{{"id":5,"file_name":"a.png","width":40,"height":30}}],"categories":[{{"id":1,"name":"person"}}],
            "annotations":[{{"image_id":5,"category_id":1,"bbox":[1,2,30,20],"area":300.5,"iscrowd":0,"keypoints":{points:?},
            "num_keypoints":11}}]}}"#
        ),
    );
    scratch.picture("val/a.png", 40, 30);
    let coco = open(scratch.path(), &Problems::strict()).unwrap();
    let Some(Value::PoseList(list)) = coco.target(0).unwrap() else { panic!() };
    let confidences = [0, 1, 2].map(|at| list.poses[0].keypoints[at].confidence);
    assert_eq!(confidences, [0.0, 0.5, 1.0]);
    let region = list.poses[0].region.as_deref().unwrap();
    assert_eq!((region.width, region.segment.as_deref().unwrap().area), (30.0, 300.5));
    let other = scratch.path().join("written");
    Coco::write(&coco, &other, &WriteOptions::default(), &Problems::strict(), &Silent).unwrap();
    assert!(other.join("annotations/person_keypoints_train.json").is_file());
    assert_eq!(open(&other, &Problems::strict()).unwrap().target(0).unwrap(), Some(list.into()));
    let boxes = OpenOptions { target: Some(ValueType::BoundingBoxList), ..OpenOptions::default() };
    let coco = Coco::open(&path, &boxes, &Problems::strict()).unwrap();
    assert!(matches!(coco.target(0).unwrap(), Some(Value::BoundingBoxList(list)) if list.boxes.len() == 1));
}

#[test]
fn broken_entries_are_reported_with_their_place() {
    let broken = SMALL
        .replace("\"image_id\": 139", "\"image_id\": 140")
        .replace("[1, 2, 3.25, 4]", "[1, NaN, 3.25, 4]")
        .replace("\"size\": [20, 20]", "\"size\": [10, 40]");
    let found = problems_of(&broken);
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found[0].contains("annotations[0]") && found[0].contains("line 5, byte 2"), "{found:?}");
    assert!(found[0].contains("key \"bbox[1]\""), "{found:?}");
    assert!(
        found[1].contains("annotations[1].image_id: line 7") && found[1].contains("no image 140"),
        "{found:?}"
    );
    assert!(found[2].contains("annotations[2].segmentation") && found[2].contains("40x10"), "{found:?}");
}

#[test]
fn broken_files_are_reported() {
    let one = |from: &str, to: &str| {
        assert!(SMALL.contains(from), "{from}");
        let found = problems_of(&SMALL.replace(from, to));
        assert_eq!(found.len(), 1, "{found:?}");
        found[0].clone()
    };
    assert!(one("\"category_id\": 90", "\"category_id\": 91").contains("91 is not one of the 2 categories"));
    assert!(one("[1, 2, 3.25, 4]", "[100, 2, 3.25, 4]").contains("outside of its image of 20x20"));
    assert!(one("[1, 2, 3.25, 4]", "[1, 2, -3.25, 4]").contains("annotations[0].bbox"));
    assert!(one("[1, 2, 3.25, 4]", "[1, 2, 3.25]").contains("bbox"));
    assert!(one("[1.5, 2, 4, 2, 4, 6]", "[1.5, 2, 4]").contains("a polygon of 3 numbers"));
    assert!(one("[5, 390, 5]", "[5, 390]").contains("fill 395 pixels"));
    assert!(one("\"area\": 6.5", "\"area\": -6.5").contains("-6.5 is not a valid number of square pixels"));
    assert!(one("\"area\": 6.5", "\"area\": 1e60").contains("area"));
    assert!(one("\"id\": 3, ", "\"id\": 1, ").contains("2 annotations have the id 1"));
    assert!(one("\"images\"", "\"pictures\"").contains("images"));
    assert!(one("\"iscrowd\": 1", "\"iscrowd\": 7").contains("neither 0 nor 1"));
    let leaving = problems_of(&SMALL.replace("a.png", "../a.png"));
    assert!(leaving[0].contains("images[0]") && leaving[0].contains("could leave its folder"), "{leaving:?}");
    assert!(problems_of(&SMALL[..500])[0].contains("the file ends"));
    assert!(problems_of("[]")[0].contains("expected an object"));
    assert!(problems_of("")[0].contains("the file ends"));
    assert!(problems_of("\u{0}\u{1}binary")[0].contains("UTF-8"));
}

#[test]
fn broken_images_affect_no_others() {
    let scratch = small();
    std::fs::remove_file(scratch.path().join("val2017/a.png")).unwrap();
    scratch.picture("val2017/b.png", 21, 20);
    let coco = open(scratch.path(), &Problems::strict()).unwrap();
    assert!(coco.get(0).unwrap_err().to_string().contains("a.png"));
    assert!(coco.get(1).unwrap_err().to_string().contains("21x20 pixels, its annotation is for 20x20"));
    let problems = Problems::skipping();
    Coco::write(&coco, &scratch.path().join("out"), &WriteOptions::default(), &problems, &Silent).unwrap();
    assert_eq!(problems.count(), 1);
    assert_eq!(open(&scratch.path().join("out"), &Problems::strict()).unwrap().len(), 1);
}

#[test]
fn parts_are_chosen() {
    let scratch = TemporaryFolder::new();
    for split in ["train2017", "val2017"] {
        scratch.write(
            &format!("annotations/instances_{split}.json"),
            SMALL.replace("139", &split[split.len() - 4..]),
        );
    }
    scratch.write("annotations/captions_val2017.json", "{}");
    let id = |split: Option<&str>| {
        let options = OpenOptions { split: split.map(str::to_owned), ..OpenOptions::default() };
        Coco::open(scratch.path(), &options, &Problems::skipping()).map(|coco| coco.index.annotations.len())
    };
    assert_eq!(id(None).unwrap(), 3);
    assert_eq!((id(Some("train")).unwrap(), id(Some("train2017")).unwrap()), (3, 3));
    let other = TemporaryFolder::new();
    other.write("test_a.json", "[{\"image_id\": 7}]");
    other.write("test_b.json", SMALL);
    assert!(Coco::annotation_file(other.path(), &OpenOptions::default()).unwrap().ends_with("test_b.json"));
    let error = id(Some("test")).unwrap_err().to_string();
    assert!(error.contains("the parts are: val2017, train2017") || error.contains("val2017"), "{error}");
}

#[test]
fn real_poses_are_read() {
    let Some(folder) = real_data("mmpose_samples/coco") else { return };
    let options = OpenOptions { target: Some(ValueType::PoseList), ..OpenOptions::default() };
    let coco = Coco::open(&folder.join("test_coco.json"), &options, &Problems::strict()).unwrap();
    let poses = (0..coco.len()).map(|at| match coco.get(at).unwrap().target {
        Some(Value::PoseList(list)) => list.poses.len(),
        other => panic!("{other:?}"),
    });
    assert_eq!((coco.len(), poses.sum::<usize>()), (4, 14));
}

proptest! {
    #[test]
    fn mutated_files_are_refused_or_read(at in 0usize..1000, bytes in proptest::collection::vec(any::<u8>(), 0..4), cut in 0usize..4) {
        let mut text = SMALL.as_bytes().to_vec();
        let start = at % text.len();
        let end = (start + cut).min(text.len());
        text.splice(start..end, bytes);
        let scratch = TemporaryFolder::new();
        let path = scratch.write("a.json", &text);
        let _ = open(&path, &Problems::strict());
        if let Ok(coco) = open(&path, &Problems::skipping()) {
            for index in 0..coco.len() {
                let _ = (coco.get(index).is_ok(), coco.name(index));
                prop_assert!(coco.target(index).is_ok());
            }
        }
    }
}
