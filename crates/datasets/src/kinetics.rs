//! Clips in a folder for each class, the layout of Kinetics, UCF101 and HMDB51.

use std::fs;
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Progress, Result, ResultExt, Value, ValueType};

use crate::class_folders::{ClassFolders, SPLITS};
use crate::class_table::ClassTable;
use crate::clip::{CLIPS, frame_of, open_clip};
use crate::folder::{PICTURES, files_in, folders_in, has_extension, names_in, part_folder};
use crate::picture_files::{split_name, write_each};
use crate::{Format, OpenOptions, Problems, Recognition, WriteOptions};

/// Clips in class folders. Class indices follow the order of the folders' names. A clip is a video file, a `.npy`,
/// or a folder of images as frames.
#[derive(Debug)]
pub struct Kinetics(ClassFolders);

/// Returns the clips in a folder.
fn clips_in(folder: &Path) -> Vec<String> {
    let mut names = names_in(folder).unwrap_or_default();
    names.retain(|name| {
        let path = folder.join(name);
        if path.is_dir() { !files_in(&path, PICTURES).is_empty() } else { has_extension(name, CLIPS) }
    });
    names
}

impl Dataset for Kinetics {}

impl DatasetIterator for Kinetics {
    fn len(&self) -> usize {
        self.0.samples.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let clip = open_clip(&self.0.file(index)?)?;
        Ok(Sample { data: vec![Value::Video(clip)], target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        self.0.target(index)
    }

    fn name(&self, index: usize) -> String {
        self.0.name(index)
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.0.file(index).ok()
    }

    fn classes(&self) -> Classes {
        self.0.classes.clone()
    }
}

impl Format for Kinetics {
    const NAME: &'static str = "kinetics";
    const ALIASES: &'static [&'static str] = &["ucf101", "hmdb51", "video_folder"];
    const ABOUT: &'static str = "clips in a folder for each class, as Kinetics, UCF101 and HMDB51";
    const LAYOUT: &'static str =
        "train/CLASS/*.mp4 (or CLASS/*.mp4); a clip may also be a folder of its frames, or a .npy";
    const TARGETS: &'static [ValueType] = &[ValueType::Category];

    fn recognise(path: &Path) -> Recognition {
        let root = part_folder(path, None, &SPLITS).ok().flatten();
        let root = root.as_deref().unwrap_or(path);
        let classes = folders_in(root).into_iter().filter(|class| !clips_in(&root.join(class)).is_empty());
        if classes.take(2).count() == 2 {
            return Recognition::Possible;
        }
        Recognition::No("two or more folders with clips, one for each class".into())
    }

    fn read_index(path: &Path, options: &OpenOptions, _: &Problems) -> Result<Self> {
        let root = part_folder(path, options.split.as_deref(), &SPLITS)?.unwrap_or_else(|| path.to_owned());
        let clips = ClassFolders::new(root, clips_in, |folder| folder);
        if clips.samples.is_empty() {
            let (root, layout) = (clips.root.display(), Self::LAYOUT);
            return Err(Error::not_found(format!("no clips in {root}; the layout is {layout}")));
        }
        Ok(Self(clips))
    }

    /// Videos are copied or linked; other clips become folders of images.
    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let root = path.join(split_name(options)?);
        let mut classes = ClassTable::new(&dataset.classes());
        write_each(dataset, problems, progress, |index| {
            let (_, folder) = classes.folder(dataset, index, &root)?;
            fs::create_dir_all(&folder).context(|| format!("making {}", folder.display()))?;
            let source = dataset
                .path(index)
                .filter(|path| path.is_file() && has_extension(&path.to_string_lossy(), CLIPS));
            let extension = source.as_deref().and_then(Path::extension);
            let mut name = format!("{index:06}");
            if let Some(extension) = extension {
                name.push('.');
                name.push_str(&extension.to_string_lossy());
            }
            let to = folder.join(name);
            let Some(source) = source else { return write_frames(dataset, index, &to) };
            if options.link && fs::hard_link(&source, &to).is_ok() {
                return Ok(());
            }
            fs::copy(&source, &to).map(drop).context(|| format!("writing {}", to.display()))
        })
    }
}

/// Writes the frames of a clip as images into `folder`.
fn write_frames(dataset: &dyn DatasetIterator, index: usize, folder: &Path) -> Result<()> {
    let sample = dataset.get(index)?;
    let clip = sample.data.iter().find_map(|datum| match datum {
        Value::Video(clip) => Some(clip),
        _ => None,
    });
    let clip = clip.ok_or_else(|| Error::invalid_input("the sample has no clip"))?;
    fs::create_dir_all(folder).context(|| format!("making {}", folder.display()))?;
    (0..clip.shape()[1]).try_for_each(|number| {
        opendr_vision::save(&frame_of(clip, number)?, folder.join(format!("{number:06}.png")))
    })
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;

    use super::*;
    use crate::folder::TemporaryFolder;
    use crate::npy_from_values;

    fn open(path: &Path, split: Option<&str>) -> Result<Kinetics> {
        let options = OpenOptions { split: split.map(str::to_owned), target: None };
        Kinetics::open(path, &options, &Problems::strict())
    }

    #[test]
    fn folders_are_classes_and_clips() {
        let (folder, other) = (TemporaryFolder::new(), TemporaryFolder::new());
        for frame in 0..3 {
            folder.picture(&format!("train/jump/first/{frame}.png"), 6, 4);
            folder.picture(&format!("train/jump/second/{frame}.png"), 6, 4);
        }
        assert!(matches!(Kinetics::recognise(folder.path()), Recognition::No(_)));
        folder.write("train/run/quick.npy", npy_from_values(&[0.5; 3 * 2 * 4], &[3, 2, 2, 2]).unwrap());
        folder.write("train/none/readme.txt", "no clip");
        assert_eq!(Kinetics::recognise(folder.path()), Recognition::Possible);
        let dataset = open(folder.path(), None).unwrap();
        let names: Vec<_> = (0..dataset.len()).map(|at| dataset.name(at)).collect();
        assert_eq!(names, ["jump/first", "jump/second", "run/quick.npy"]);
        assert_eq!(dataset.classes().iter().collect::<Vec<_>>(), ["jump", "run"]);
        let sample = dataset.get(2).unwrap();
        assert!(matches!(&sample.target, Some(Value::Category(category)) if category.class == 1));
        assert!(matches!(&sample.data[..], [Value::Video(clip)] if clip.shape() == [3, 2, 2, 2]));
        let options = WriteOptions { split: Some("val".into()), link: false };
        Kinetics::write(&dataset, other.path(), &options, &Problems::strict(), &Silent).unwrap();
        let again = open(other.path(), Some("val")).unwrap();
        for index in 0..3 {
            assert_eq!(again.get(index).unwrap(), dataset.get(index).unwrap(), "{index}");
        }
        assert!(open(folder.path(), Some("test")).unwrap_err().to_string().contains("there are train"));
    }
}
