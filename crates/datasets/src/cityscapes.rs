//! Cityscapes: street scenes with semantic masks, a folder for each city.

use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Classes, Heatmap};
use opendr_engine::{Error, Progress, Result, ResultExt, Value, ValueType};

use crate::folder::{files_in, folders_in, past_end, path_inside};
use crate::label_png::{IGNORED, LabelMap, open_labels, save_labels};
use crate::picture_files::{PictureWriter, open_picture, split_name, write_each};
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

const SPLITS: [&str; 3] = ["val", "test", "train"];

/// The evaluated classes by their label ids (`labelIds`); their positions are the `labelTrainIds`.
const CLASSES: [(i64, &str); 19] = [
    (7, "road"),
    (8, "sidewalk"),
    (11, "building"),
    (12, "wall"),
    (13, "fence"),
    (17, "pole"),
    (19, "traffic light"),
    (20, "traffic sign"),
    (21, "vegetation"),
    (22, "terrain"),
    (23, "sky"),
    (24, "person"),
    (25, "rider"),
    (26, "car"),
    (27, "truck"),
    (28, "bus"),
    (31, "train"),
    (32, "motorcycle"),
    (33, "bicycle"),
];

/// Highest label id.
const LAST_LABEL: u32 = 33;

/// A Cityscapes data set: masks of the 19 evaluated classes, 255 for other pixels.
#[derive(Debug)]
pub struct Cityscapes {
    root: PathBuf,
    split: String,
    /// City and name without `_leftImg8bit.png`.
    samples: Vec<(String, String)>,
}

/// Returns the class of a label id; 255 for classes that are not evaluated, such as the licence plate, whose id is
/// -1.
fn class_from_label(label: u32) -> Option<u32> {
    let class = CLASSES.iter().position(|(id, _)| *id == i64::from(label));
    class.map(|class| class as u32).or((label <= LAST_LABEL || label == IGNORED).then_some(IGNORED))
}

impl Cityscapes {
    fn sample(&self, index: usize) -> Result<&(String, String)> {
        self.samples.get(index).ok_or_else(|| past_end(index, self.samples.len()))
    }

    fn picture_path(&self, index: usize) -> Result<PathBuf> {
        let (city, name) = self.sample(index)?;
        let folder = self.root.join("leftImg8bit").join(&self.split).join(city);
        Ok(folder.join(format!("{name}_leftImg8bit.png")))
    }

    fn map(&self, index: usize) -> Result<Heatmap> {
        let (city, name) = self.sample(index)?;
        let folder = self.root.join("gtFine").join(&self.split).join(city);
        let labels = folder.join(format!("{name}_gtFine_labelIds.png"));
        let trained = folder.join(format!("{name}_gtFine_labelTrainIds.png"));
        let by_class = !labels.is_file() && trained.is_file();
        let path = if by_class { trained } else { labels };
        let map = open_labels(&path)?.mapped(|label| match by_class {
            true => (label < CLASSES.len() as u32 || label == IGNORED).then_some(label),
            false => class_from_label(label),
        });
        map.and_then(|map| map.into_heatmap(self.classes())).context(|| path.display().to_string())
    }
}

impl Dataset for Cityscapes {}

impl DatasetIterator for Cityscapes {
    fn len(&self) -> usize {
        self.samples.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let map = self.map(index)?;
        let size = if let [height, width] = map.shape() { [*width as u32, *height as u32] } else { [0, 0] };
        let image = open_picture(&self.picture_path(index)?, size)?;
        Ok(Sample { data: vec![image.into()], target: Some(map.into()) })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(Some(self.map(index)?.into()))
    }

    fn name(&self, index: usize) -> String {
        self.sample(index).map_or_else(|_| index.to_string(), |(city, name)| format!("{city}/{name}.png"))
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.picture_path(index).ok()
    }

    fn classes(&self) -> Classes {
        CLASSES.iter().map(|(_, name)| *name).collect()
    }

    fn class_ids(&self) -> Vec<i64> {
        CLASSES.iter().map(|(id, _)| *id).collect()
    }
}

impl Format for Cityscapes {
    const NAME: &'static str = "cityscapes";
    const ABOUT: &'static str = "Cityscapes: semantic masks of street scenes, 19 classes";
    const LAYOUT: &'static str =
        "leftImg8bit/val/CITY/*_leftImg8bit.png, gtFine/val/CITY/*_gtFine_labelIds.png";
    const TARGETS: &'static [ValueType] = &[ValueType::Heatmap];

    fn recognise(path: &Path) -> Recognition {
        match path.join("leftImg8bit").is_dir() && path.join("gtFine").is_dir() {
            true => Recognition::Certain,
            false => Recognition::No("folders leftImg8bit and gtFine".into()),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let pictures = path.join("leftImg8bit");
        let there = folders_in(&pictures);
        let usual = SPLITS.iter().find(|split| there.iter().any(|name| name == *split)).copied();
        let split = options.split.as_deref().or(usual).unwrap_or("val");
        if !there.iter().any(|name| name == split) {
            let (path, there) = (pictures.display(), there.join(", "));
            return Err(Error::not_found(format!("no part {split:?} in {path}; the parts are: {there}")));
        }
        let mut dataset = Self { root: path.to_owned(), split: split.to_owned(), samples: Vec::new() };
        for city in folders_in(&pictures.join(split)) {
            let folder = pictures.join(split).join(&city);
            for file in files_in(&folder, &["png"]) {
                match file.strip_suffix("_leftImg8bit.png") {
                    Some(name) => dataset.samples.push((city.clone(), name.to_owned())),
                    None => problems.report(Problem::new(
                        folder.join(file),
                        "the file name is not of the form *_leftImg8bit.png",
                    ))?,
                }
            }
        }
        Ok(dataset)
    }

    /// Writes label ids if the classes of the data set are those of Cityscapes, otherwise the class indices for
    /// training (`labelTrainIds`).
    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let split = split_name(options)?;
        let own = dataset.classes().iter().eq(CLASSES.iter().map(|(_, name)| *name));
        let folder = path.join("leftImg8bit").join(split).join("city");
        let pictures = PictureWriter::new(dataset, folder.clone(), options)?;
        let masks = path.join("gtFine").join(split).join("city");
        write_each(dataset, problems, progress, |index| {
            let map = LabelMap::from_target(dataset.target(index)?.as_ref())?;
            let label = |class: u32| CLASSES.get(class as usize).map_or(0, |(id, _)| *id as u32);
            let map = if own { map.mapped(|class| Some(label(class)))? } else { map };
            let placed = pictures.place(index)?;
            let stem = Path::new(&placed.name).with_extension("");
            let stem = stem.to_string_lossy();
            let stem = stem.trim_end_matches("_leftImg8bit");
            let kind = if own { "labelIds" } else { "labelTrainIds" };
            let mask =
                path_inside(&masks, &format!("{stem}_gtFine_{kind}.png")).map_err(Error::invalid_input)?;
            save_labels(&map.of_size(placed.size)?, &mask, false)?;
            // Cityscapes uses PNG files only.
            let to = folder.join(format!("{stem}_leftImg8bit.png"));
            if placed.name.ends_with(".png") {
                return Ok(std::fs::rename(folder.join(&placed.name), to)?);
            }
            opendr_vision::save(&opendr_vision::open(folder.join(&placed.name))?, to)?;
            Ok(std::fs::remove_file(folder.join(&placed.name))?)
        })
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;

    use super::*;
    use crate::folder::TemporaryFolder;

    fn small() -> TemporaryFolder {
        let folder = TemporaryFolder::new();
        folder.picture("leftImg8bit/val/ulm/ulm_0_leftImg8bit.png", 3, 2);
        let map = LabelMap { size: [3, 2], labels: vec![0, 7, 33, 16, 26, 255] };
        save_labels(&map, &folder.path().join("gtFine/val/ulm/ulm_0_gtFine_labelIds.png"), false).unwrap();
        folder
    }

    fn open(path: &Path) -> Result<Cityscapes> {
        Cityscapes::open(path, &OpenOptions::default(), &Problems::strict())
    }

    #[test]
    fn label_ids_become_classes() {
        let (folder, other) = (small(), TemporaryFolder::new());
        assert_eq!(Cityscapes::recognise(folder.path()), Recognition::Certain);
        let dataset = open(folder.path()).unwrap();
        let Some(Value::Heatmap(map)) = dataset.get(0).unwrap().target else { panic!() };
        let mut wanted = Heatmap::from_labels(vec![255, 0, 18, 255, 13, 255], &[2, 3]).unwrap();
        wanted.classes = dataset.classes();
        assert_eq!((map, dataset.name(0)), (wanted, "ulm/ulm_0.png".into()));
        Cityscapes::write(&dataset, other.path(), &WriteOptions::default(), &Problems::strict(), &Silent)
            .unwrap();
        assert_eq!(open(other.path()).unwrap().get(0).unwrap(), dataset.get(0).unwrap());
    }

    #[test]
    fn broken_masks_are_reported() {
        let folder = small();
        let mask = folder.path().join("gtFine/val/ulm/ulm_0_gtFine_labelIds.png");
        save_labels(&LabelMap { size: [3, 2], labels: vec![0, 0, 0, 0, 77, 0] }, &mask, false).unwrap();
        let error = open(folder.path()).unwrap().get(0).unwrap_err().to_string();
        assert!(error.contains("labelIds.png: label 77 at column 1, row 1"), "{error}");
        save_labels(&LabelMap { size: [2, 2], labels: vec![0; 4] }, &mask, false).unwrap();
        assert!(open(folder.path()).unwrap().get(0).unwrap_err().to_string().contains("3x2"));
        folder.write("leftImg8bit/val/ulm/other.png", "");
        assert!(open(folder.path()).unwrap_err().to_string().contains("other.png"));
    }
}
