//! KITTI's detection benchmark.

use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::BoundingBox3DList;
use opendr_engine::{Error, Header, Progress, Result, Value, ValueType};

use crate::fields::lines;
use crate::folder::{PICTURES, files_in, past_end, path_inside, read_text};
use crate::kitti::labels::{flat_from_boxes, object_from_line};
use crate::kitti::{Scene, folder_with, write};
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

const FOLDERS: [&str; 3] = ["label_2", "image_2", "velodyne"];

/// KITTI's detection benchmark: a sample is a scene with its boxes.
///
/// Samples with 3D boxes have clouds with their calibration, samples with boxes in the image have images. Regions
/// without labels are boxes of the class `DontCare`. The test part has no targets.
#[derive(Debug)]
pub struct Kitti {
    root: PathBuf,
    ids: Vec<String>,
    scenes: Vec<Scene>,
    labelled: bool,
    target: ValueType,
}

impl Kitti {
    /// Returns the names of the scenes, e.g. `000007`.
    pub fn ids(&self) -> &[String] {
        &self.ids
    }

    fn id(&self, index: usize) -> Result<&str> {
        self.ids.get(index).map(String::as_str).ok_or_else(|| past_end(index, self.ids.len()))
    }

    fn boxes(&self, id: &str) -> Result<BoundingBox3DList> {
        let path = self.root.join("label_2").join(format!("{id}.txt"));
        let text = read_text(&path)?;
        let mut boxes = BoundingBox3DList { header: header(id), ..BoundingBox3DList::default() };
        for (number, line) in lines(&text) {
            let found = object_from_line(line).map_err(|message| Problem::at_line(&path, number, message))?;
            boxes.boxes.push(found);
        }
        Ok(boxes)
    }

    /// Returns the scenes of a list in `ImageSets`, or all scenes in the folders.
    fn list(root: &Path, above: &Path, part: Option<&str>, problems: &Problems) -> Result<Vec<String>> {
        let set = part.and_then(|part| path_inside(&above.join("ImageSets"), &format!("{part}.txt")).ok());
        if let Some(path) = set.filter(|path| path.is_file()) {
            let mut ids = Vec::new();
            for (number, line) in lines(&read_text(&path)?) {
                match path_inside(root, line.trim()) {
                    Ok(_) => ids.push(line.trim().to_owned()),
                    Err(message) => problems.report(Problem::at_line(&path, number, message))?,
                }
            }
            return Ok(ids);
        }
        if matches!(part, Some("train" | "val" | "trainval")) {
            let path = above.join("ImageSets").join(format!("{}.txt", part.unwrap_or_default()));
            return Err(Error::not_found(format!(
                "the list {} is missing; create it, or use the part \"training\"",
                path.display()
            )));
        }
        let extensions: [&[&str]; 3] = [&["txt"], PICTURES, &["bin"]];
        let mut ids: Vec<_> = FOLDERS
            .iter()
            .zip(extensions)
            .flat_map(|(folder, extensions)| files_in(&root.join(folder), extensions))
            .filter_map(|name| Some(name.rsplit_once('.')?.0.to_owned()))
            .collect();
        ids.sort_unstable();
        ids.dedup();
        Ok(ids)
    }
}

fn header(id: &str) -> Header {
    Header { frame_id: Some(id.into()), ..Header::default() }
}

/// Returns the files of scene `id`; reports missing files of folders that exist.
fn scene(root: &Path, id: &str, pictures: &[String], problems: &Problems) -> Result<Option<Scene>> {
    let mut is_complete = true;
    let mut file = |folder: &str, name: String| {
        let path = root.join(folder).join(name);
        if path.is_file() {
            return Ok(Some(path));
        }
        if root.join(folder).is_dir() {
            is_complete = false;
            problems.report(Problem::new(path, "is missing, but other files of its folder exist; add it"))?;
        }
        Ok::<_, Error>(None)
    };
    if root.join("label_2").is_dir() {
        file("label_2", format!("{id}.txt"))?;
    }
    let extension =
        PICTURES.iter().find(|extension| pictures.binary_search(&format!("{id}.{extension}")).is_ok());
    let scene = Scene {
        picture: file("image_2", format!("{id}.{}", extension.unwrap_or(&"png")))?,
        cloud: file("velodyne", format!("{id}.bin"))?,
        calibration: file("calib", format!("{id}.txt"))?,
    };
    Ok(is_complete.then_some(scene))
}

impl Dataset for Kitti {}

impl DatasetIterator for Kitti {
    fn len(&self) -> usize {
        self.ids.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let target = self.target(index)?;
        let (id, scene) = (self.id(index)?, self.scenes.get(index).cloned().unwrap_or_default());
        Ok(Sample { data: scene.data(self.target, &header(id))?, target })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let id = self.id(index)?;
        if !self.labelled {
            return Ok(None);
        }
        let boxes = self.boxes(id)?;
        Ok(Some(match self.target {
            ValueType::BoundingBoxList => Value::BoundingBoxList(flat_from_boxes(&boxes)),
            _ => Value::BoundingBox3DList(boxes),
        }))
    }

    fn name(&self, index: usize) -> String {
        self.id(index).map_or_else(|_| index.to_string(), str::to_owned)
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.scenes.get(index)?.path(self.target)
    }
}

impl Format for Kitti {
    const NAME: &'static str = "kitti";
    const ALIASES: &'static [&'static str] = &["kitti_object", "kitti_detection"];
    const ABOUT: &'static str = "KITTI's detection benchmark: 3D boxes in lidar scans and images";
    const LAYOUT: &'static str = "[training|testing/] with label_2/000000.txt, image_2/000000.png, velodyne/000000.bin and \
                                  calib/000000.txt, as far as they exist; ImageSets/train.txt and val.txt for these parts";
    const TARGETS: &'static [ValueType] = &[ValueType::BoundingBox3DList, ValueType::BoundingBoxList];

    fn recognise(path: &Path) -> Recognition {
        match folder_with(path, None, &FOLDERS) {
            Ok(Some(folder)) if folder.join("label_2").is_dir() || folder.join("image_2").is_dir() => {
                Recognition::Certain
            }
            Ok(Some(folder)) if !files_in(&folder.join("velodyne"), &["bin"]).is_empty() => {
                Recognition::Possible
            }
            _ => Recognition::No("a folder label_2, image_2 or velodyne with .bin files".into()),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let target = options.target.unwrap_or(ValueType::BoundingBox3DList);
        let part = options.split.as_deref();
        let root = folder_with(path, part, &FOLDERS)?.ok_or_else(|| {
            Error::not_found(format!("no KITTI data in {}; the layout is {}", path.display(), Self::LAYOUT))
        })?;
        let above = if root == path { root.as_path() } else { path };
        let pictures = files_in(&root.join("image_2"), PICTURES);
        let (mut ids, mut scenes) = (Vec::new(), Vec::new());
        for id in Self::list(&root, above, part, problems)? {
            if let Some(scene) = scene(&root, &id, &pictures, problems)? {
                ids.push(id);
                scenes.push(scene);
            }
        }
        let labelled = root.join("label_2").is_dir();
        Ok(Self { root, ids, scenes, labelled, target })
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        write::write(dataset, path, options, problems, progress)
    }
}
