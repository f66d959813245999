//! CamVid: road scenes with semantic masks, as colours or class indices.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use opendr_engine::data::PixelFormat;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Classes, Heatmap};
use opendr_engine::{Error, Progress, Result, ResultExt, Value, ValueType};

use crate::fields::lines;
use crate::folder::{PICTURES, files_in, past_end, read_text, write_file};
use crate::label_png::{IGNORED, LabelMap, open_labels, save_labels};
use crate::picture_files::{PictureWriter, open_picture, split_name, write_each};
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

const SPLITS: [&str; 3] = ["val", "test", "train"];

/// Folders of images and masks of a data set without parts.
const WHOLE: [[&str; 2]; 3] = [
    ["images", "labels"],
    ["701_StillsRaw_full", "LabeledApproved_full"],
    ["701_StillsRaw_full", "701_StillsLabeled"],
];

/// Classes of masks with class indices (SegNet's selection); 11 is ignored.
const NUMBERED: [&str; 11] = [
    "Sky",
    "Building",
    "Pole",
    "Road",
    "Pavement",
    "Tree",
    "SignSymbol",
    "Fence",
    "Car",
    "Pedestrian",
    "Bicyclist",
];

/// Colours of CamVid (`label_colors.txt`); `Void` is ignored.
const COLOURS: &str = "64 128 64 Animal\n192 0 128 Archway\n0 128 192 Bicyclist\n0 128 64 Bridge\n128 0 0 Building\n\
    64 0 128 Car\n64 0 192 CartLuggagePram\n192 128 64 Child\n192 192 128 Column_Pole\n64 64 128 Fence\n\
    128 0 192 LaneMkgsDriv\n192 0 64 LaneMkgsNonDriv\n128 128 64 Misc_Text\n192 0 192 MotorcycleScooter\n\
    128 64 64 OtherMoving\n64 192 128 ParkingBlock\n64 64 0 Pedestrian\n128 64 128 Road\n128 128 192 RoadShoulder\n\
    0 0 192 Sidewalk\n192 128 128 SignSymbol\n128 128 128 Sky\n64 128 192 SUVPickupTruck\n0 0 64 TrafficCone\n\
    0 64 64 TrafficLight\n192 64 128 Train\n128 128 0 Tree\n192 128 192 Truck_Bus\n64 0 64 Tunnel\n\
    192 192 0 VegetationMisc\n0 0 0 Void\n64 192 0 Wall\n";

/// The class of each colour.
type ColourTable = HashMap<[u8; 3], u32>;

/// A CamVid data set: semantic masks, 255 for ignored pixels.
#[derive(Debug)]
pub struct CamVid {
    pictures: PathBuf,
    masks: PathBuf,
    /// Names of images and masks.
    samples: Vec<(String, String)>,
    classes: Classes,
    /// Classes by colour; `None` for masks with class indices.
    colours: Option<ColourTable>,
}

/// Reads lines `red green blue name` or `name,red,green,blue` into classes by colour, and their names.
fn colour_table(file: &Path, text: &str, problems: &Problems) -> Result<(ColourTable, Vec<String>)> {
    let (mut table, mut names) = (HashMap::new(), Vec::new());
    for (number, line) in lines(text) {
        let fields: Vec<_> =
            line.split([',', ' ', '\t']).map(str::trim).filter(|field| !field.is_empty()).collect();
        let (name, colour) = match fields.as_slice() {
            [name, colour @ ..] if line.contains(',') && colour.len() == 3 => (*name, colour),
            [red, green, blue, name] => (*name, &[*red, *green, *blue][..]),
            _ => ("", &[][..]),
        };
        let samples: Vec<u8> = colour.iter().filter_map(|sample| sample.parse().ok()).collect();
        match <[u8; 3]>::try_from(samples) {
            Ok(colour) if ["void", "unlabelled", "unlabeled"].contains(&name.to_lowercase().as_str()) => {
                table.insert(colour, IGNORED);
            }
            Ok(colour) if names.len() < IGNORED as usize => {
                table.insert(colour, names.len() as u32);
                names.push(name.to_owned());
            }
            // The header of a table.
            _ if number == 1 && line.contains("name") => {}
            _ => problems.report(Problem::at_line(
                file,
                number,
                "the line is not a name and red, green, blue of 0 to 255",
            ))?,
        }
    }
    Ok((table, names))
}

/// Returns the folders of images and masks of a part.
fn folders(path: &Path, split: Option<&str>) -> Option<[PathBuf; 2]> {
    let parts = split.map_or_else(|| SPLITS.to_vec(), |split| vec![split]);
    let of_part = parts.iter().flat_map(|part| {
        ["annot", "_labels", "_label"].map(|end| [path.join(part), path.join(format!("{part}{end}"))])
    });
    let whole = WHOLE.iter().filter(|_| split.is_none()).map(|pair| pair.map(|name| path.join(name)));
    of_part.chain(whole).find(|[pictures, masks]| pictures.is_dir() && masks.is_dir())
}

impl CamVid {
    fn sample(&self, index: usize) -> Result<&(String, String)> {
        self.samples.get(index).ok_or_else(|| past_end(index, self.samples.len()))
    }

    fn map(&self, index: usize) -> Result<Heatmap> {
        let path = self.masks.join(&self.sample(index)?.1);
        let count = self.classes.len() as u32;
        let read = || match &self.colours {
            None => open_labels(&path)?.mapped(|label| match label {
                label if label < count => Some(label),
                label if label == count || label == IGNORED => Some(IGNORED),
                _ => None,
            }),
            Some(table) => {
                let image = opendr_vision::open(&path)?;
                let rgb = image.hwc_u8(PixelFormat::Rgb);
                let pixels = rgb.as_chunks().0;
                let wrong = |colour: &[u8; 3]| Error::format(format!("no class has the colour {colour:?}"));
                let class = |colour| table.get(colour).copied().ok_or_else(|| wrong(colour));
                let size = [image.width() as u32, image.height() as u32];
                Ok(LabelMap { size, labels: pixels.iter().map(class).collect::<Result<_>>()? })
            }
        };
        let map = read().and_then(|map| map.into_heatmap(self.classes.clone()));
        map.context(|| path.display().to_string())
    }
}

impl Dataset for CamVid {}

impl DatasetIterator for CamVid {
    fn len(&self) -> usize {
        self.samples.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let map = self.map(index)?;
        let size = if let [height, width] = map.shape() { [*width as u32, *height as u32] } else { [0, 0] };
        let image = open_picture(&self.pictures.join(&self.sample(index)?.0), size)?;
        Ok(Sample { data: vec![image.into()], target: Some(map.into()) })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(Some(self.map(index)?.into()))
    }

    fn name(&self, index: usize) -> String {
        self.sample(index).map_or_else(|_| index.to_string(), |(name, _)| name.clone())
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.sample(index).ok().map(|(name, _)| self.pictures.join(name))
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

impl Format for CamVid {
    const NAME: &'static str = "camvid";
    const ABOUT: &'static str =
        "CamVid: semantic masks of road scenes, as class indices (11 classes) or colours (31)";
    const LAYOUT: &'static str = "val/*.png and valannot/*.png (class indices), val_labels/*_L.png (colours, class_dict.csv), \
                                  or 701_StillsRaw_full and LabeledApproved_full";
    const TARGETS: &'static [ValueType] = &[ValueType::Heatmap];

    fn recognise(path: &Path) -> Recognition {
        match folders(path, None) {
            Some([pictures, _]) if pictures.ends_with("images") && !path.join("codes.txt").is_file() => {
                Recognition::No("codes.txt beside images and labels".into())
            }
            Some(_) => Recognition::Certain,
            None => Recognition::No(
                "val and valannot (or val_labels), or 701_StillsRaw_full and its labels".into(),
            ),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let [pictures, masks] = folders(path, options.split.as_deref()).ok_or_else(|| {
            let split = options.split.as_deref().unwrap_or("val");
            let path = path.display();
            Error::not_found(format!("no {split} and {split}annot (or {split}_labels) in {path}"))
        })?;
        let mut samples = Vec::new();
        for name in files_in(&pictures, PICTURES) {
            let stem = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem);
            let known = ["", "_L", "_P"].map(|end| format!("{stem}{end}.png"));
            match known.into_iter().find(|mask| masks.join(mask).is_file()) {
                Some(mask) => samples.push((name.clone(), mask)),
                None => {
                    let message = format!("its mask is missing in {}", masks.display());
                    problems.report(Problem::new(pictures.join(&name), message))?;
                }
            }
        }
        let numbered = samples.first().is_none_or(|(_, mask)| open_labels(&masks.join(mask)).is_ok());
        let tables = ["class_dict.csv", "label_colors.txt"].map(|name| path.join(name));
        let (colours, names) = if numbered {
            let codes = path.join("codes.txt");
            let codes = if codes.is_file() { read_text(&codes)? } else { NUMBERED.join("\n") };
            let named = lines(&codes).map(|(_, line)| line.trim().to_owned()).take(IGNORED as usize);
            (None, named.collect())
        } else {
            let (file, text) = match tables.into_iter().find(|file| file.is_file()) {
                Some(file) => (file.clone(), read_text(&file)?),
                None => (PathBuf::new(), COLOURS.to_owned()),
            };
            let (table, names) = colour_table(&file, &text, problems)?;
            (Some(table), names)
        };
        Ok(Self { pictures, masks, samples, classes: names.into(), colours })
    }

    /// Writes masks with class indices, and the names of the classes to `codes.txt`.
    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let split = split_name(options)?;
        let pictures = PictureWriter::new(dataset, path.join(split), options)?;
        let masks = path.join(format!("{split}annot"));
        write_each(dataset, problems, progress, |index| {
            let map = LabelMap::from_target(dataset.target(index)?.as_ref())?;
            let placed = pictures.place(index)?;
            let mask = masks.join(&placed.name).with_extension("png");
            save_labels(&map.of_size(placed.size)?, &mask, false)
        })?;
        let names: String = dataset.classes().iter().flat_map(|name| [name, "\n"]).collect();
        if names.is_empty() { Ok(()) } else { write_file(&path.join("codes.txt"), names.as_bytes()) }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;
    use opendr_engine::data::Image;
    use proptest::prelude::*;

    use super::*;
    use crate::folder::TemporaryFolder;

    fn open(path: &Path) -> Result<CamVid> {
        CamVid::open(path, &OpenOptions::default(), &Problems::strict())
    }

    fn labels(dataset: &CamVid) -> Heatmap {
        match dataset.get(0).unwrap().target {
            Some(Value::Heatmap(map)) => map,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn numbers_are_read_and_written() {
        let (folder, other) = (TemporaryFolder::new(), TemporaryFolder::new());
        folder.picture("test/a.png", 2, 2);
        let mask = folder.path().join("testannot/a.png");
        save_labels(&LabelMap { size: [2, 2], labels: vec![0, 10, 11, 255] }, &mask, false).unwrap();
        assert_eq!(CamVid::recognise(folder.path()), Recognition::Certain);
        let dataset = open(folder.path()).unwrap();
        let map = labels(&dataset);
        assert_eq!(map.to_string(), "[[  0  10]\n [255 255]]");
        CamVid::write(&dataset, other.path(), &WriteOptions::default(), &Problems::strict(), &Silent)
            .unwrap();
        assert_eq!(labels(&open(other.path()).unwrap()), map);
        save_labels(&LabelMap { size: [2, 2], labels: vec![0, 12, 0, 0] }, &mask, false).unwrap();
        assert!(dataset.target(0).unwrap_err().to_string().contains("label 12 at column 1, row 0"));
        std::fs::remove_file(mask).unwrap();
        assert!(open(folder.path()).unwrap_err().to_string().contains("its mask is missing"));
    }

    #[test]
    fn colours_are_classes() {
        let folder = TemporaryFolder::new();
        folder.picture("701_StillsRaw_full/a.png", 3, 1);
        folder.write("LabeledApproved_full/a_L.png", "");
        let mask = folder.path().join("LabeledApproved_full/a_L.png");
        let colours = vec![64, 128, 64, 0, 0, 0, 64, 192, 0];
        opendr_vision::save(&Image::from_rgb8(colours, 3, 1).unwrap(), &mask).unwrap();
        let dataset = open(folder.path()).unwrap();
        assert_eq!((labels(&dataset).to_string(), dataset.classes().len()), ("[[  0 255  30]]".into(), 31));
        folder.write("class_dict.csv", "name,r,g,b\nAnimal,64,128,64\nVoid,0,0,0\n");
        let error = open(folder.path()).unwrap().get(0).unwrap_err().to_string();
        assert!(error.contains("a_L.png: no class has the colour [64, 192, 0]"), "{error}");
        folder.write("class_dict.csv", "name,r,g,b\nAnimal,64,128,640\n");
        assert!(
            open(folder.path())
                .unwrap_err()
                .to_string()
                .contains("class_dict.csv:2: the line is not a name and red")
        );
    }

    proptest! {
        #[test]
        fn any_table_is_refused_or_read(text in "[a-z0-9, \n\tVoid.-]{0,60}") {
            let problems = Problems::skipping();
            let (table, names) = colour_table(Path::new("a.csv"), &text, &problems).unwrap();
            prop_assert!(table.values().all(|class| *class == IGNORED || (*class as usize) < names.len()));
        }
    }
}
