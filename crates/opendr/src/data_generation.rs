//! Generation of labelled data sets from embedded worlds.

use std::path::{Path, PathBuf};

use opendr_datasets::{self as datasets, Problems, WriteOptions};
use opendr_engine::data::{Image, Layout, PixelFormat};
use opendr_engine::dataset::{Dataset, DatasetIterator, ReadAheadDatasetIterator, Sample, Subset};
use opendr_engine::{Error, Progress, Result};
use opendr_simulation::person_scenes::{PersonScenes, PersonTarget, RenderedScene};
use opendr_simulation::sphere_view::{Subject, SubjectViews};
use opendr_simulation::street::StreetScans;
use serde::Serialize;

opendr_engine::choices! {
    /// World of which labelled data is generated.
    pub enum GeneratedWorld {
        /// Persons in rooms and streets: boxes, masks, depth, normals, camera poses.
        Persons = "persons",
        /// The same with COCO's 17 key points.
        PersonKeypoints = "person_keypoints",
        /// Heads of persons from a grid of azimuths, a class for each person.
        Faces = "faces",
        /// Products from a grid of azimuths, a class for each product.
        Objects = "objects",
        /// Lidar scans of streets with 3D boxes.
        Street = "street",
    }
}

/// Options of [`generate`].
#[derive(Debug, Clone, PartialEq)]
pub struct GenerationOptions {
    /// Number of samples.
    pub frames: usize,
    /// Width and height of images, pixels; of faces and objects the smaller one is the side.
    pub size: [usize; 2],
    /// Seed; a sample depends on the seed and its index only.
    pub seed: u64,
    /// Format to write, as `opendr data formats` lists them; that of the world when `None`.
    pub format: Option<String>,
    /// Name of the written split.
    pub split: Option<String>,
    /// Whether depth (16-bit PNG, millimetres) and normals (PNG) of each image are written; only persons have them.
    pub geometry: bool,
    /// Number of threads.
    pub threads: usize,
}

impl Default for GenerationOptions {
    fn default() -> Self {
        Self {
            frames: 1000,
            size: [640, 480],
            seed: 0,
            format: None,
            split: None,
            geometry: false,
            threads: 1,
        }
    }
}

/// What [`generate`] wrote.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Generated {
    /// Number of written samples.
    pub samples: usize,
    /// Format of the data set.
    pub format: String,
    /// Contact sheet of some samples with their labels.
    pub contact_sheet: Option<PathBuf>,
}

/// Persons of the world of faces.
const FACES: u32 = 100;
/// Samples in the contact sheet.
const SHEET: usize = 24;

impl GeneratedWorld {
    /// Returns the format that is written by default.
    pub fn format(self) -> &'static str {
        match self {
            Self::Persons | Self::PersonKeypoints => "coco",
            Self::Faces | Self::Objects => "imagenet",
            Self::Street => "kitti",
        }
    }

    /// Returns the world as a data set, which is rendered when it is read.
    ///
    /// # Errors
    /// `InvalidParam` for a size that cannot be rendered.
    pub fn dataset(self, options: &GenerationOptions) -> Result<Box<dyn DatasetIterator>> {
        let GenerationOptions { frames, size, seed, .. } = *options;
        let persons = |target| PersonScenes::new(seed, frames, size, target);
        let views = |subject| SubjectViews::new(seed, subject, FACES, frames, size[0].min(size[1]));
        Ok(match self {
            Self::Persons => Box::new(persons(PersonTarget::Boxes)?),
            Self::PersonKeypoints => Box::new(persons(PersonTarget::Poses)?),
            Self::Faces => Box::new(views(Subject::Face)?),
            Self::Objects => Box::new(views(Subject::Object)?),
            Self::Street => Box::new(StreetScans::new(seed, frames)),
        })
    }

    fn persons(self) -> Option<PersonTarget> {
        match self {
            Self::Persons => Some(PersonTarget::Boxes),
            Self::PersonKeypoints => Some(PersonTarget::Poses),
            _ => None,
        }
    }
}

/// Renders a labelled data set of a world into the folder `out`, with a contact sheet.
///
/// # Errors
/// `InvalidParam` for no frames, an unknown format, or geometry of a world without images of scenes; `InvalidInput` for a format
/// that does not have the labels of the world; `Io` if a file cannot be written.
pub fn generate(
    world: GeneratedWorld,
    out: &Path,
    options: &GenerationOptions,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<Generated> {
    if options.frames == 0 {
        return Err(Error::invalid_param("no frames are to be rendered; give at least 1"));
    }
    let format = datasets::find_format(options.format.as_deref().unwrap_or(world.format()))?;
    let dataset: Box<dyn DatasetIterator> = match (options.geometry, world.persons()) {
        (false, _) => world.dataset(options)?,
        (true, Some(target)) => Box::new(WithGeometry::new(options, target, out)?),
        (true, None) => {
            return Err(Error::invalid_param(format!(
                "the world {} has no depth and normals; render persons or person_keypoints",
                world.name()
            )));
        }
    };
    let ahead = ReadAheadDatasetIterator::new(&dataset, options.threads);
    let write = WriteOptions { split: options.split.clone(), link: false };
    (format.write)(&ahead, out, &write, problems, progress)?;
    let samples = dataset.len();
    let has_images = matches!(dataset.get(0)?.data.first(), Some(opendr_engine::Value::Image(_)));
    let contact_sheet = has_images.then(|| out.join("contact_sheet.png"));
    if let Some(file) = &contact_sheet {
        let count = SHEET.min(samples);
        let indices = (0..count).map(|at| at * samples / count).collect();
        opendr_vision::save(&datasets::contact_sheet(&Subset::new(&dataset, indices)?, problems)?, file)?;
    }
    Ok(Generated { samples, format: format.name.to_owned(), contact_sheet })
}

/// Persons whose depth, normals and camera are written beside the data set when a sample is rendered.
struct WithGeometry {
    scenes: PersonScenes,
    folder: PathBuf,
}

/// Camera of an image, as it is written beside depth and normals.
#[derive(Serialize)]
struct CameraFile {
    /// Focal length, pixels.
    focal_length: f32,
    /// Principal point, pixels.
    principal_point: [f32; 2],
    /// Position in the world, metres.
    position: [f32; 3],
    /// Axes of the camera in the world: ahead, left, up.
    axes: [[f32; 3]; 3],
}

impl WithGeometry {
    fn new(options: &GenerationOptions, target: PersonTarget, out: &Path) -> Result<Self> {
        for name in ["depth", "normals", "cameras"] {
            std::fs::create_dir_all(out.join(name))?;
        }
        let scenes = PersonScenes::new(options.seed, options.frames, options.size, target)?;
        Ok(Self { scenes, folder: out.to_owned() })
    }

    fn write(&self, index: usize, scene: &RenderedScene) -> Result<()> {
        let file =
            |kind: &str, end: &str| self.folder.join(kind).join(format!("{}.{end}", self.scenes.name(index)));
        let (width, height) = (scene.image.width(), scene.image.height());
        let millimetres =
            |depth: &f32| if *depth < RenderedScene::RANGE { (1000.0 * depth).round() as u16 } else { 0 };
        let depth: Vec<u16> = scene.depth.iter().map(millimetres).collect();
        let depth = Image::new(depth, width, height, PixelFormat::Grey, Layout::Hwc)?;
        opendr_vision::save_depth(&depth, file("depth", "png"))?;
        let level = |part: &f32| (127.5 * (part + 1.0)).round() as u8;
        let normals = scene.normals.as_flattened().iter().map(level).collect();
        opendr_vision::save(&Image::from_rgb8(normals, width, height)?, file("normals", "png"))?;
        let camera = CameraFile {
            focal_length: scene.focal_length,
            principal_point: [width, height].map(|pixels| 0.5 * pixels as f32),
            position: scene.pose.position,
            axes: scene.pose.axes,
        };
        let text = serde_json::to_vec(&camera)
            .map_err(|error| Error::io("writing the camera").with_source(error))?;
        opendr_engine::atomic_file::replace_file(&file("cameras", "json"), &text)
    }
}

impl Dataset for WithGeometry {}

impl DatasetIterator for WithGeometry {
    fn len(&self) -> usize {
        self.scenes.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (scene, poses) = self.scenes.render(index)?;
        self.write(index, &scene)?;
        Ok(self.scenes.sample(index, scene, poses))
    }

    fn name(&self, index: usize) -> String {
        self.scenes.name(index)
    }

    fn image_size(&self, index: usize) -> Option<[u32; 2]> {
        self.scenes.image_size(index)
    }

    fn classes(&self) -> opendr_engine::target::Classes {
        self.scenes.classes()
    }
}
