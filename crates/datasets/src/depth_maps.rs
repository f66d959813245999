//! Depth maps: images, and for each a PNG of 16 bits with the depth of every pixel.

use std::path::{Path, PathBuf};

use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Heatmap, HeatmapValues};
use opendr_engine::{Error, Progress, Result, ResultExt, Value, ValueType};
use opendr_vision::{Decoder, encode_depth_png};

use crate::folder::{PICTURES, files_in, read_text, write_file};
use crate::image_pairs::ImagePairs;
use crate::picture_files::{PictureWriter, open_picture, split_name, write_each};
use crate::{Format, OpenOptions, Problems, Recognition, WriteOptions};

/// Names of parts as folders, the preferred one first.
const SPLITS: [&str; 3] = ["val", "test", "train"];
/// Folders of images beside the folder `depth`.
const IMAGES: [&str; 3] = ["images", "rgb", "color"];
/// Folders of KITTI's selection for validation (`data_depth_selection.zip`).
const KITTI: [&str; 3] = ["depth_selection/val_selection_cropped", "val_selection_cropped", ""];
/// Units per metre: millimetres, and those of KITTI.
const MILLIMETRES: f64 = 1000.0;
const KITTI_UNITS: f64 = 256.0;
/// File with the units per metre of a data set, beside the folders of images and depths.
const UNITS_FILE: &str = "units_per_metre.txt";

/// A data set of depth maps: metres, 0 for pixels that were not measured.
#[derive(Debug)]
pub struct DepthMaps {
    /// Images and their depth maps.
    pairs: ImagePairs,
    units_per_metre: f64,
}

/// Folders of images and depth maps.
struct Folders {
    images: PathBuf,
    depths: PathBuf,
    is_kitti: bool,
}

impl Folders {
    /// Returns the folders of a part.
    fn find(path: &Path, split: Option<&str>) -> Option<Self> {
        let parts = split.map_or_else(|| SPLITS.to_vec(), |split| vec![split]);
        let whole = split.is_none().then(|| path.to_owned());
        let of_part = parts.iter().map(|part| path.join(part)).chain(whole.clone());
        let own = of_part.flat_map(|folder| {
            IMAGES.map(|name| Self {
                images: folder.join(name),
                depths: folder.join("depth"),
                is_kitti: false,
            })
        });
        let kitti = KITTI.iter().filter(|_| split.is_none_or(|split| split == "val")).map(|folder| {
            let folder = path.join(folder);
            Self { images: folder.join("image"), depths: folder.join("groundtruth_depth"), is_kitti: true }
        });
        own.chain(kitti).find(|folders| {
            !files_in(&folders.depths, &["png"]).is_empty() && !files_in(&folders.images, PICTURES).is_empty()
        })
    }

    /// Returns the depth map of an image.
    fn depth_of(&self, image: &str) -> PathBuf {
        let stem = image.rsplit_once('.').map_or(image, |(stem, _)| stem);
        let name = match self.is_kitti {
            true => stem.replace("_sync_image_", "_sync_groundtruth_depth_"),
            false => stem.to_owned(),
        };
        self.depths.join(format!("{name}.png"))
    }

    /// Reads the units per metre: those of the file beside the folders or in that of the data set, else those of the layout.
    fn units(&self, path: &Path) -> Result<f64> {
        let beside = self.depths.parent().unwrap_or(path);
        let file =
            [beside, path].map(|folder| folder.join(UNITS_FILE)).into_iter().find(|file| file.is_file());
        match file {
            Some(file) => {
                units_from_text(&read_text(&file)?).context(|| format!("reading {}", file.display()))
            }
            None => Ok(if self.is_kitti { KITTI_UNITS } else { MILLIMETRES }),
        }
    }
}

fn units_from_text(text: &str) -> Result<f64> {
    let units = text.trim().parse().ok().filter(|units| (1e-3..=1e6).contains(units));
    units.ok_or_else(|| {
        Error::format(format!(
            "{text:.40?} is not the number of units per metre; write one number, such as 1000"
        ))
    })
}

impl DepthMaps {
    fn depths(&self, index: usize) -> Result<Heatmap> {
        let [_, file] = self.pairs.get(index)?;
        let image = Decoder::default().open_depth(file)?;
        let Pixels::U16(units) = image.pixels() else {
            return Err(Error::internal("a depth image without 16 bits"));
        };
        let metres = units.iter().map(|units| (f64::from(*units) / self.units_per_metre) as f32).collect();
        Heatmap::from_scores(metres, &[image.height(), image.width()])
    }
}

/// Returns the depths of a sample and its width and height.
fn metres(target: Option<&Value>) -> Result<(&[f32], [usize; 2])> {
    let Some(Value::Heatmap(map)) = target else {
        let other = target.map_or("nothing", |target| target.as_value_ref().value_type().name());
        return Err(Error::invalid_input(format!("depth maps are needed, not {other}")));
    };
    match (map.values(), map.shape()) {
        (HeatmapValues::Scores(metres), &[height, width]) => Ok((metres, [width, height])),
        (_, shape) => Err(Error::invalid_input(format!(
            "a map of shape {shape:?} is not one of depths; scores [height, width] in metres are needed"
        ))),
    }
}

/// Converts depths to an image of 16 bits; what is not positive and finite becomes 0.
fn depth_image(metres: &[f32], [width, height]: [usize; 2], units_per_metre: f64) -> Result<Image> {
    let units = |metres: &f32| match f64::from(*metres) * units_per_metre {
        units if !(units > 0.0 && units.is_finite()) => Ok(0),
        units if units.round() <= f64::from(u16::MAX) => Ok(units.round() as u16),
        _ => Err(Error::invalid_input(format!(
            "a depth of {metres} m does not fit into 16 bits of 1/{units_per_metre} m; set what is farther away to 0"
        ))),
    };
    let samples = metres.iter().map(units).collect::<Result<Vec<u16>>>()?;
    Image::new(samples, width, height, PixelFormat::Grey, Layout::Hwc)
}

/// Returns the finest of the usual units that all depths of a data set fit into; samples that cannot be read have none.
fn units_for(dataset: &dyn DatasetIterator) -> f64 {
    let farthest = |index: usize| {
        let target = dataset.target(index).ok().flatten();
        let (metres, _) = metres(target.as_ref()).ok()?;
        metres.iter().copied().filter(|metres| metres.is_finite()).reduce(f32::max)
    };
    let farthest = (0..dataset.len()).filter_map(farthest).fold(0.0, f32::max);
    let fits = (f64::from(farthest) * MILLIMETRES).round() <= f64::from(u16::MAX);
    if fits { MILLIMETRES } else { KITTI_UNITS }
}

impl Dataset for DepthMaps {}

impl DatasetIterator for DepthMaps {
    fn len(&self) -> usize {
        self.pairs.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let map = self.depths(index)?;
        let size = if let [height, width] = map.shape() { [*width as u32, *height as u32] } else { [0, 0] };
        let image = open_picture(&self.pairs.get(index)?[0], size)?;
        Ok(Sample { data: vec![image.into()], target: Some(map.into()) })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(Some(self.depths(index)?.into()))
    }

    fn name(&self, index: usize) -> String {
        self.pairs.name(index)
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.pairs.image(index)
    }
}

impl Format for DepthMaps {
    const NAME: &'static str = "depth_maps";
    const ALIASES: &'static [&'static str] = &["depth", "kitti_depth"];
    const ABOUT: &'static str =
        "images with the depth of each pixel, as PNG files of 16 bits; also KITTI's selection for validation";
    const LAYOUT: &'static str = "[PART/]images/NAME.jpg (or rgb, color) and [PART/]depth/NAME.png in millimetres, 0 for pixels without a depth; \
                                  units_per_metre.txt for other units (TUM: 5000); or val_selection_cropped/image and \
                                  val_selection_cropped/groundtruth_depth (256 units per metre)";
    const TARGETS: &'static [ValueType] = &[ValueType::Heatmap];

    fn recognise(path: &Path) -> Recognition {
        match Folders::find(path, None) {
            Some(_) => Recognition::Certain,
            None => Recognition::No("a folder depth of PNG files beside images, rgb or color".into()),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let folders = Folders::find(path, options.split.as_deref()).ok_or_else(|| {
            let split = options.split.as_deref().map_or(String::new(), |split| format!("{split}/"));
            Error::not_found(format!("no {split}images with {split}depth/NAME.png in {}", path.display()))
        })?;
        let pairs = ImagePairs::find(&folders.images, "depth map", |name| folders.depth_of(name), problems)?;
        Ok(Self { pairs, units_per_metre: folders.units(path)? })
    }

    /// Writes depths in millimetres, or in KITTI's units where the farthest is more than 65.535 m away.
    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let folder = path.join(split_name(options)?);
        let pictures = PictureWriter::new(dataset, folder.join("images"), options)?;
        let units = units_for(dataset);
        write_file(&folder.join(UNITS_FILE), format!("{units}\n").as_bytes())?;
        write_each(dataset, problems, progress, |index| {
            let target = dataset.target(index)?;
            let (metres, size) = metres(target.as_ref())?;
            let depth = encode_depth_png(&depth_image(metres, size, units)?)?;
            let placed = pictures.place(index)?;
            if placed.size != size.map(|side| side as u32) {
                let [width, height] = placed.size;
                return Err(Error::invalid_input(format!(
                    "the depth map has {}x{} pixels, its image has {width}x{height}",
                    size[0], size[1]
                )));
            }
            write_file(&folder.join("depth").join(&placed.name).with_extension("png"), &depth)
        })
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;
    use opendr_vision::save_depth;

    use super::*;
    use crate::folder::TemporaryFolder;

    fn open(path: &Path) -> Result<DepthMaps> {
        DepthMaps::open(path, &OpenOptions::default(), &Problems::strict())
    }

    fn depths(dataset: &DepthMaps) -> Vec<f32> {
        match dataset.get(0).unwrap().target {
            Some(Value::Heatmap(map)) => metres(Some(&map.into())).unwrap().0.to_vec(),
            other => panic!("{other:?}"),
        }
    }

    fn write_depth(folder: &TemporaryFolder, name: &str, units: Vec<u16>, width: usize) {
        folder.write(name, "");
        let height = units.len() / width;
        let image = Image::new(units, width, height, PixelFormat::Grey, Layout::Hwc).unwrap();
        save_depth(&image, folder.path().join(name)).unwrap();
    }

    #[test]
    fn millimetres_are_read_and_written() {
        let (folder, other) = (TemporaryFolder::new(), TemporaryFolder::new());
        folder.picture("rgb/a.jpg", 2, 2);
        write_depth(&folder, "depth/a.png", vec![0, 1500, 1, 65535], 2);
        assert_eq!(DepthMaps::recognise(folder.path()), Recognition::Certain);
        let dataset = open(folder.path()).unwrap();
        assert_eq!(depths(&dataset), [0.0, 1.5, 0.001, 65.535]);
        DepthMaps::write(&dataset, other.path(), &WriteOptions::default(), &Problems::strict(), &Silent)
            .unwrap();
        assert_eq!(depths(&open(other.path()).unwrap()), depths(&dataset));
        assert_eq!(read_text(&other.path().join("train/units_per_metre.txt")).unwrap(), "1000\n");
    }

    #[test]
    fn kitti_has_units_of_its_own() {
        let (folder, other) = (TemporaryFolder::new(), TemporaryFolder::new());
        let root = "depth_selection/val_selection_cropped";
        let image = "2011_09_26_drive_0002_sync_image_0000000005_image_02.png";
        folder.picture(&format!("{root}/image/{image}"), 2, 1);
        let depth = image.replace("sync_image", "sync_groundtruth_depth");
        write_depth(&folder, &format!("{root}/groundtruth_depth/{depth}"), vec![20480, 256], 2);
        let dataset = open(folder.path()).unwrap();
        assert_eq!(depths(&dataset), [80.0, 1.0]);
        DepthMaps::write(&dataset, other.path(), &WriteOptions::default(), &Problems::strict(), &Silent)
            .unwrap();
        assert_eq!(depths(&open(other.path()).unwrap()), [80.0, 1.0]);
    }

    #[test]
    fn parts_may_state_their_units() {
        let folder = TemporaryFolder::new();
        folder.picture("val/images/a.png", 1, 1);
        write_depth(&folder, "val/depth/a.png", vec![5000], 1);
        folder.write("units_per_metre.txt", "5000\n");
        assert_eq!(depths(&open(folder.path()).unwrap()), [1.0]);
        folder.write("val/units_per_metre.txt", "500");
        assert_eq!(depths(&open(folder.path()).unwrap()), [10.0]);
        for text in ["", "many", "0", "-1", "inf", "1 2"] {
            folder.write("val/units_per_metre.txt", text);
            let error = open(folder.path()).unwrap_err().to_string();
            assert!(error.contains("units_per_metre.txt") && error.contains("units per metre"), "{error}");
        }
    }

    #[test]
    fn broken_samples_are_reported() {
        let folder = TemporaryFolder::new();
        folder.picture("images/a.png", 2, 2);
        write_depth(&folder, "depth/a.png", vec![1, 2], 2);
        let error = open(folder.path()).unwrap().get(0).unwrap_err().to_string();
        assert!(error.contains("has 2x2 pixels, its annotation is for 2x1"), "{error}");
        folder.picture("images/b.png", 2, 2);
        assert!(open(folder.path()).unwrap_err().to_string().contains("b.png is missing"));
        folder.write("depth/b.png", "no PNG");
        let error = open(folder.path()).unwrap().target(1).unwrap_err().to_string();
        assert!(error.contains("b.png"), "{error}");
    }

    #[test]
    fn depths_that_do_not_fit_are_refused() {
        let image = depth_image(&[f32::NAN, -1.0, f32::INFINITY, 0.0005], [2, 2], MILLIMETRES).unwrap();
        assert_eq!(image.pixels(), &Pixels::from(vec![0_u16, 0, 0, 1]));
        let error = depth_image(&[300.0], [1, 1], KITTI_UNITS).unwrap_err().to_string();
        assert!(error.contains("a depth of 300 m"), "{error}");
        let labels = Heatmap::from_labels(vec![1], &[1, 1]).unwrap();
        assert!(metres(Some(&labels.into())).is_err());
    }
}
