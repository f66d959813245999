//! COCO panoptic: masks of things and stuff, a PNG for each image, described in one JSON file.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::model::member_path;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, Heatmap, Rle, Segment, Segmentation};
use opendr_engine::{Error, Progress, Result, ResultExt, Value, ValueType};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::annotation::{Fault, check_box};
use super::categories::Categories;
use super::file_writer::{CategoryIds, FileWriter};
use super::index::{Entry, Index, Picture};
use super::locate;
use super::record::flag;
use super::segment_map::SegmentMap;
use super::source::Source;
use crate::folder::past_end;
use crate::label_png::{IGNORED, LabelMap};
use crate::picture_files::{PictureWriter, Placed, open_picture, split_name, write_each};
use crate::{Format, OpenOptions, Problems, Recognition, WriteOptions};

/// Factor of the class in label maps, as in the panoptic quality metric.
const LABEL_DIVISOR: u32 = 1000;

/// A COCO panoptic data set: a box with its mask for every segment, things and stuff, or a label map (class times
/// 1000 plus instance index; class 255 outside of segments).
#[derive(Debug)]
pub struct CocoPanoptic {
    folder: PathBuf,
    masks: PathBuf,
    index: Index,
    source: Source,
    target: ValueType,
}

/// An entry of `annotations`.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Record {
    image_id: i64,
    file_name: String,
    segments_info: Vec<SegmentRecord>,
}

#[derive(Debug, Serialize, Deserialize)]
struct SegmentRecord {
    id: u32,
    category_id: i64,
    #[serde(default, deserialize_with = "flag", serialize_with = "number")]
    iscrowd: bool,
    #[serde(default)]
    bbox: [f32; 4],
    #[serde(default)]
    area: f32,
}

fn number<S: serde::Serializer>(flag: &bool, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_u8(u8::from(*flag))
}

impl Entry for Record {
    fn image_id(&self) -> i64 {
        self.image_id
    }

    fn id(&self) -> Option<i64> {
        // One entry for each image.
        Some(self.image_id)
    }

    fn check(&self, size: [u32; 2], categories: &Categories) -> Result<(), Fault> {
        member_path(&self.file_name).map_err(|error| ("file_name", error.to_string()))?;
        let mut ids = HashSet::new();
        self.segments_info.iter().try_for_each(|segment| {
            let (id, category) = (segment.id, segment.category_id);
            if id == 0 || id >= 1 << 24 || !ids.insert(id) {
                return Err((
                    "segments_info",
                    format!("id {id} occurs twice, or is not a valid colour other than black"),
                ));
            }
            if categories.class(category).is_none() {
                let count = categories.ids().len();
                return Err((
                    "segments_info",
                    format!("category_id {category} is not one of the {count} categories"),
                ));
            }
            check_box(segment.bbox, size)
        })
    }
}

impl CocoPanoptic {
    fn picture(&self, index: usize) -> Result<&Picture> {
        self.index.pictures.get(index).ok_or_else(|| past_end(index, self.index.pictures.len()))
    }

    fn picture_path(&self, index: usize) -> Result<PathBuf> {
        Ok(self.folder.join(member_path(&self.source.file_name(self.picture(index)?)?)?))
    }

    /// Returns the segments of an image and the map of their pixels.
    fn segments(&self, index: usize) -> Result<(Record, SegmentMap)> {
        let mut annotation = None;
        self.source.annotations(self.index.annotations_of(index), |record: Record| {
            annotation = Some(record);
            Ok(())
        })?;
        let record = annotation
            .ok_or_else(|| Error::format(format!("image {} has no annotation", self.name(index))))?;
        let path = self.masks.join(member_path(&record.file_name)?);
        let ids: Vec<_> = record.segments_info.iter().map(|segment| segment.id).collect();
        let image = open_picture(&path, self.picture(index)?.size)?;
        let map = SegmentMap::new(&image, &ids).context(|| path.display().to_string())?;
        Ok((record, map))
    }

    fn boxes(&self, index: usize) -> Result<BoundingBoxList> {
        let (record, map) = self.segments(index)?;
        let boxes = record.segments_info.iter().zip(map.masks()?).map(|(segment, rle)| {
            let class = self.index.categories.class(segment.category_id).map_or(-1, |class| class as i64);
            let (area, iscrowd) = (rle.area() as f32, segment.iscrowd);
            let outline = Segment { segmentation: Segmentation::Rle(rle), area, iscrowd };
            let [left, top, width, height] = segment.bbox;
            BoundingBox {
                segment: Some(Box::new(outline)),
                ..BoundingBox::new(class, left, top, width, height, 1.0)
            }
        });
        let boxes = BoundingBoxList::from(boxes.collect::<Vec<_>>());
        Ok(BoundingBoxList { image_id: Some(self.picture(index)?.id), classes: self.classes(), ..boxes })
    }

    /// Returns the label map: class times 1000 plus instance index from 1, which is 0 for crowds and stuff.
    fn label_map(&self, index: usize) -> Result<Heatmap> {
        let (record, map) = self.segments(index)?;
        let (mut labels, mut counts) = (Vec::new(), HashMap::new());
        for SegmentRecord { category_id, iscrowd, .. } in &record.segments_info {
            let class = self.index.categories.class(*category_id).unwrap_or_default();
            let next = counts.entry(class).or_insert(u32::from(self.index.categories.is_thing(class)));
            let object = if *iscrowd { 0 } else { std::mem::replace(next, *next + 1) };
            if object >= LABEL_DIVISOR {
                return Err(Error::unsupported(format!(
                    "a class has over {LABEL_DIVISOR} objects; read boxes instead"
                )));
            }
            labels.push(class as u32 * LABEL_DIVISOR + object);
        }
        let label = |place: &Option<u32>| place.map_or(IGNORED * LABEL_DIVISOR, |at| labels[at as usize]);
        LabelMap { size: map.size, labels: map.places.iter().map(label).collect() }
            .into_heatmap(self.classes())
    }
}

impl Dataset for CocoPanoptic {}

impl DatasetIterator for CocoPanoptic {
    fn len(&self) -> usize {
        self.index.pictures.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let image = open_picture(&self.picture_path(index)?, self.picture(index)?.size)?;
        Ok(Sample { data: vec![image.into()], target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(Some(match self.target {
            ValueType::Heatmap => self.label_map(index)?.into(),
            _ => self.boxes(index)?.into(),
        }))
    }

    fn name(&self, index: usize) -> String {
        let name = self.picture(index).and_then(|picture| self.source.file_name(picture));
        name.unwrap_or_else(|_| index.to_string())
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.picture_path(index).ok()
    }

    fn image_size(&self, index: usize) -> Option<[u32; 2]> {
        self.picture(index).ok().map(|picture| picture.size).filter(|size| !size.contains(&0))
    }

    fn classes(&self) -> Classes {
        self.index.categories.classes().clone()
    }

    fn class_ids(&self) -> Vec<i64> {
        self.index.categories.ids().to_vec()
    }

    fn id(&self, index: usize) -> Option<i64> {
        self.picture(index).ok().map(|picture| picture.id)
    }
}

fn is_panoptic(file: &Path) -> bool {
    locate::name_begins(file, &["panoptic_"]) || locate::begins_with_key(file, &["segments_info"])
}

impl Format for CocoPanoptic {
    const NAME: &'static str = "coco_panoptic";
    const ALIASES: &'static [&'static str] = &["panoptic"];
    const ABOUT: &'static str =
        "COCO panoptic: masks of things and stuff as PNG files, described in one JSON file";
    const LAYOUT: &'static str =
        "annotations/panoptic_val2017.json, annotations/panoptic_val2017/*.png, val2017/*.jpg";
    const TARGETS: &'static [ValueType] = &[ValueType::BoundingBoxList, ValueType::Heatmap];

    fn recognise(path: &Path) -> Recognition {
        let files = locate::annotation_files(path);
        // Beside instances, the format must be named by the user.
        let other = files.iter().any(|file| locate::name_begins(file, &["instances_", "person_keypoints_"]));
        match files.iter().take(64).any(|file| is_panoptic(file)) {
            true if other => Recognition::Possible,
            true => Recognition::Certain,
            false => Recognition::No("annotations/panoptic_val2017.json and its folder of PNG files".into()),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let mut files = locate::annotation_files(path);
        files.retain(|file| is_panoptic(file));
        if files.is_empty() {
            let path = path.display();
            return Err(Error::not_found(format!("no panoptic annotations (panoptic_*.json) in {path}")));
        }
        let file =
            locate::choose(&files, options.split.as_deref(), &[]).context(|| path.display().to_string())?;
        let target = options.target.unwrap_or(ValueType::BoundingBoxList);
        let index = Index::new::<Record>(file, problems)?;
        if target == ValueType::Heatmap && index.categories.ids().len() > IGNORED as usize {
            return Err(Error::unsupported("label maps support at most 255 categories; read boxes instead"));
        }
        let source = Source::new(file)?;
        let first = index.pictures.first().map(|picture| source.file_name(picture)).transpose()?;
        let folder = locate::picture_folder(path, file, Path::new(&first.unwrap_or_default()));
        Ok(Self { folder, masks: file.with_extension(""), index, source, target })
    }

    /// Writes boxes with RLE masks. Data sets do not distinguish things from stuff: all are written as things.
    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let split = split_name(options)?;
        let pictures = PictureWriter::new(dataset, path.join(split), options)?;
        let masks = path.join(format!("annotations/panoptic_{split}"));
        let mut file = FileWriter::new(&masks.with_extension("json"))?;
        let mut categories = CategoryIds::new(dataset);
        std::fs::create_dir_all(&masks).context(|| format!("making {}", masks.display()))?;
        write_each(dataset, problems, progress, |index| {
            let Some(Value::BoundingBoxList(list)) = dataset.target(index)? else {
                return Err(Error::invalid_input("panoptic masks need boxes with masks, no other targets"));
            };
            let placed = pictures.place(index)?;
            let file_name = Path::new(&placed.name).with_extension("png").to_string_lossy().into_owned();
            let image_id = dataset.id(index).unwrap_or(index as i64 + 1);
            let segments_info = write_masks(&list, &placed, &masks.join(&file_name), &mut categories)?;
            file.picture(image_id, &placed)?;
            file.annotation(&Record { image_id, file_name, segments_info })
        })?;
        let category = |(id, name)| json!({"id": id, "name": name, "supercategory": "none", "isthing": 1});
        let categories: Vec<_> = categories.iter().map(category).collect();
        file.finish(&categories)
    }
}

fn write_masks(
    list: &BoundingBoxList,
    placed: &Placed,
    path: &Path,
    categories: &mut CategoryIds,
) -> Result<Vec<SegmentRecord>> {
    let [width, height] = placed.size;
    let (mut masks, mut records) = (Vec::new(), Vec::new());
    for (at, found) in list.boxes.iter().enumerate() {
        let rle: &Rle = match found.segment.as_deref().map(|segment| &segment.segmentation) {
            Some(Segmentation::Rle(rle)) if rle.size() == [height, width] => rle,
            _ => {
                return Err(Error::invalid_input(format!(
                    "box {at} has no RLE mask of its image's size, which panoptic masks need"
                )));
            }
        };
        let category_id = categories.category(&found.name, &list.classes)?;
        let iscrowd = found.segment.as_deref().is_some_and(|segment| segment.iscrowd);
        let bbox = [found.left, found.top, found.width, found.height];
        records.push(SegmentRecord {
            id: at as u32 + 1,
            category_id,
            iscrowd,
            bbox,
            area: rle.area() as f32,
        });
        masks.push(rle);
    }
    opendr_vision::save(&SegmentMap::from_masks(&masks, placed.size)?.image()?, path)?;
    Ok(records)
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;

    use super::*;
    use crate::folder::{TemporaryFolder, real_data};

    fn open(path: &Path, target: Option<ValueType>) -> Result<CocoPanoptic> {
        CocoPanoptic::open(path, &OpenOptions { split: None, target }, &Problems::strict())
    }

    /// Two segments of an image of 3x2 pixels, and a pixel outside of both.
    fn small(segments: &str) -> TemporaryFolder {
        let folder = TemporaryFolder::new();
        let json = format!(
            r#"{{"images":[{{"id":9,"file_name":"a.png","width":3,"height":2}}],"annotations":[{{"image_id":9,
            "file_name":"a.png","segments_info":[{segments}]}}],"categories":[{{"id":184,"name":"tree","isthing":0}},{{"id":1,"name":"person"}}]}}"#
        );
        folder.write("annotations/panoptic_val.json", json);
        folder.picture("val/a.png", 3, 2);
        folder.write("annotations/panoptic_val/a.png", "");
        let masks = [[true, true, false, false, true, false], [false, false, false, true, false, true]];
        let masks = masks.map(|mask| Rle::from_mask(&mask, 2, 3).unwrap());
        let image = SegmentMap::from_masks(&[&masks[0], &masks[1]], [3, 2]).unwrap().image().unwrap();
        opendr_vision::save(&image, folder.path().join("annotations/panoptic_val/a.png")).unwrap();
        folder
    }

    const SEGMENTS: &str = r#"{"id":2,"category_id":1,"iscrowd":1,"bbox":[0,1,3,1],"area":2},
        {"id":1,"category_id":184,"iscrowd":0,"bbox":[0,0,2,2],"area":3}"#;

    #[test]
    fn segments_are_boxes_or_a_map() {
        let (folder, other) = (small(SEGMENTS), TemporaryFolder::new());
        assert_eq!(CocoPanoptic::recognise(folder.path()), Recognition::Certain);
        let dataset = open(folder.path(), None).unwrap();
        let list = dataset.boxes(0).unwrap();
        let areas: Vec<_> = list.boxes.iter().map(|found| found.segment.as_deref().unwrap()).collect();
        assert_eq!((areas[0].area, areas[0].iscrowd, areas[1].area), (2.0, true, 3.0));
        assert_eq!((list.image_id, dataset.class_ids()), (Some(9), vec![1, 184]));
        let map = open(folder.path(), Some(ValueType::Heatmap)).unwrap().label_map(0).unwrap();
        assert_eq!(map.to_string(), "[[  1000   1000 255000]\n [     0   1000      0]]");
        CocoPanoptic::write(&dataset, other.path(), &WriteOptions::default(), &Problems::strict(), &Silent)
            .unwrap();
        let again = open(other.path(), None).unwrap();
        assert_eq!(
            (again.get(0).unwrap(), again.class_ids()),
            (dataset.get(0).unwrap(), dataset.class_ids())
        );
    }

    #[test]
    fn broken_segments_are_reported() {
        let error = |from: &str, to: &str| {
            let folder = small(&SEGMENTS.replace(from, to));
            open(folder.path(), None).and_then(|dataset| dataset.get(0)).unwrap_err().to_string()
        };
        assert!(error("184", "185").contains("annotations[0].segments_info: line 1, byte"));
        assert!(error("\"id\":2", "\"id\":1").contains("id 1 occurs twice"));
        assert!(
            error("\"id\":2", "\"id\":3")
                .contains("a.png: segment 2 at column 0, row 1 is not in segments_info")
        );
    }

    #[test]
    fn coco128_is_read() {
        let Some(folder) = real_data("coco128/panoptic_segmentation") else { return };
        let dataset = open(&folder, None).unwrap();
        assert_eq!((dataset.len(), dataset.classes().len()), (48, 133));
        for index in 0..4 {
            let Some(Value::BoundingBoxList(list)) = dataset.get(index).unwrap().target else { panic!() };
            let (record, _) = dataset.segments(index).unwrap();
            for (found, segment) in list.boxes.iter().zip(&record.segments_info) {
                let outline = found.segment.as_deref().unwrap();
                assert_eq!((outline.area, outline.iscrowd), (segment.area, segment.iscrowd));
            }
        }
    }
}
