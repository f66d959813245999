//! ImageNet: a folder of images for each class.

use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Progress, Result, Value, ValueType};

use crate::class_folders::{ClassFolders, SPLITS};
use crate::class_table::ClassTable;
use crate::fields::lines;
use crate::folder::{PICTURES, files_in, folders_in, part_folder, path_inside, read_text};
use crate::picture_files::{PictureWriter, split_name, write_each};
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

/// Files with the class names of folders: `n01440764 tench, Tinca tinca`.
const WORDS: [&str; 4] = ["LOC_synset_mapping.txt", "synset_words.txt", "words.txt", "synsets.txt"];

/// A data set of images in class folders. Class indices follow the order of the folders' names.
#[derive(Debug)]
pub struct ImageNet(ClassFolders);

/// Returns the folder of a part: one of the usual names, or the folder itself.
fn part(path: &Path, split: Option<&str>) -> Result<PathBuf> {
    Ok(part_folder(path, split, &SPLITS)?.unwrap_or_else(|| path.to_owned()))
}

/// Returns the file with the class of each image of a flat folder: `ILSVRC2012_val_00000001.JPEG 65`.
fn map_file(folder: &Path) -> Option<PathBuf> {
    let name = folder.file_name()?.to_str()?;
    let above = folder.parent()?;
    let names = [format!("{name}.txt"), format!("{name}_map.txt")];
    names.into_iter().flat_map(|name| [folder.join(&name), above.join(&name)]).find(|file| file.is_file())
}

/// Returns the class names of folders, if a file defines them.
fn words(path: &Path, root: &Path) -> Result<BTreeMap<String, String>> {
    let folders = [path, root, root.parent().unwrap_or(root)];
    let file =
        folders.iter().flat_map(|folder| WORDS.map(|name| folder.join(name))).find(|file| file.is_file());
    let text = file.map(|file| read_text(&file)).transpose()?.unwrap_or_default();
    let pair = |(_, line): (u64, &str)| {
        let (synset, word) = line.trim().split_once([' ', '\t'])?;
        Some((synset.to_owned(), word.trim().to_owned()))
    };
    Ok(lines(&text).filter_map(pair).collect())
}

impl ImageNet {
    fn from_folders(root: PathBuf, words: &BTreeMap<String, String>) -> Self {
        let pictures_in = |folder: &Path| files_in(folder, PICTURES);
        Self(ClassFolders::new(root, pictures_in, |folder| words.get(&folder).cloned().unwrap_or(folder)))
    }

    fn from_map(
        root: PathBuf,
        map: &Path,
        words: &BTreeMap<String, String>,
        problems: &Problems,
    ) -> Result<Self> {
        let numbers: HashMap<&str, u32> = words.keys().map(String::as_str).zip(0..).collect();
        let mut samples = Vec::new();
        for (number, line) in lines(&read_text(map)?) {
            let read = || {
                let (name, class) =
                    line.trim().rsplit_once([' ', '\t', ',']).ok_or("has no class after the name")?;
                path_inside(&root, name.trim())?;
                let class = numbers.get(class).copied().map_or_else(|| class.parse(), Ok);
                let class: u32 =
                    class.map_err(|_| "has neither a class index nor a synset after the name")?;
                if !words.is_empty() && class as usize >= words.len() {
                    return Err(format!("has class {class}, but there are {} classes", words.len()));
                }
                Ok::<_, String>((class, name.trim().to_owned()))
            };
            match read() {
                Ok(sample) => samples.push(sample),
                Err(message) => problems.report(Problem::at_line(map, number, message))?,
            }
        }
        Ok(Self(ClassFolders { root, classes: words.values().map(String::as_str).collect(), samples }))
    }
}

impl Dataset for ImageNet {}

impl DatasetIterator for ImageNet {
    fn len(&self) -> usize {
        self.0.samples.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let image = opendr_vision::open(self.0.file(index)?)?;
        Ok(Sample { data: vec![image.into()], target: self.target(index)? })
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

impl Format for ImageNet {
    const NAME: &'static str = "imagenet";
    const ALIASES: &'static [&'static str] = &["image_folder", "imagefolder"];
    const ABOUT: &'static str = "images in a folder for each class";
    const LAYOUT: &'static str = "val/CLASS/*.JPEG (or CLASS/*.JPEG); synset_words.txt or LOC_synset_mapping.txt where \
                                  folders are synsets; val.txt (\"NAME CLASS\") for a flat folder";
    const TARGETS: &'static [ValueType] = &[ValueType::Category];

    fn recognise(path: &Path) -> Recognition {
        let Ok(root) = part(path, None) else { return Recognition::No("a folder".into()) };
        if WORDS.iter().any(|name| path.join(name).is_file()) && root.is_dir() {
            return Recognition::Certain;
        }
        let folders = folders_in(&root);
        let usual = ["images", "labels", "annotations"];
        let classes = || {
            let first = folders.iter().take(8);
            let mut full = first.filter(|folder| !files_in(&root.join(folder), PICTURES).is_empty());
            full.next().is_some()
        };
        if !folders.iter().any(|folder| usual.contains(&folder.to_lowercase().as_str()))
            && folders.len() > 1
            && classes()
        {
            return Recognition::Possible;
        }
        Recognition::No("two or more folders with images, one for each class".into())
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let root = part(path, options.split.as_deref())?;
        let words = words(path, &root)?;
        let dataset = match map_file(&root) {
            Some(map) if !files_in(&root, PICTURES).is_empty() => {
                Self::from_map(root, &map, &words, problems)?
            }
            _ => Self::from_folders(root, &words),
        };
        if dataset.is_empty() {
            let path = dataset.0.root.display();
            return Err(Error::not_found(format!("no class folders with images in {path}")));
        }
        Ok(dataset)
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let root = path.join(split_name(options)?);
        let mut classes = ClassTable::new(&dataset.classes());
        let mut writers = HashMap::new();
        write_each(dataset, problems, progress, |index| {
            let (class, folder) = classes.folder(dataset, index, &root)?;
            let writer = match writers.entry(class) {
                Entry::Occupied(entry) => entry.into_mut(),
                Entry::Vacant(entry) => entry.insert(PictureWriter::new(dataset, folder, options)?),
            };
            writer.place(index).map(drop)
        })
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;

    use super::*;
    use crate::folder::TemporaryFolder;

    fn open(path: &Path, split: Option<&str>) -> Result<ImageNet> {
        let options = OpenOptions { split: split.map(str::to_owned), target: None };
        ImageNet::open(path, &options, &Problems::strict())
    }

    #[test]
    fn folders_are_classes() {
        let (folder, other) = (TemporaryFolder::new(), TemporaryFolder::new());
        for name in ["val/n02/b.png", "val/n01/a.png", "val/n02/c.JPEG", "train/n01/d.png"] {
            folder.picture(name, 4, 4);
        }
        assert_eq!(ImageNet::recognise(folder.path()), Recognition::Possible);
        folder.write("synset_words.txt", "n01 tench, Tinca tinca\nn02 cock\nn03 hen\n");
        assert_eq!(ImageNet::recognise(folder.path()), Recognition::Certain);
        let dataset = open(folder.path(), None).unwrap();
        let names: Vec<_> = (0..3).map(|at| dataset.name(at)).collect();
        assert_eq!(names, ["n01/a.png", "n02/b.png", "n02/c.JPEG"]);
        let Some(Value::Category(category)) = dataset.get(1).unwrap().target else { panic!() };
        assert_eq!((category.class, category.description.as_deref()), (1, Some("cock")));
        let options = WriteOptions { split: Some("val".into()), link: true };
        ImageNet::write(&dataset, other.path(), &options, &Problems::strict(), &Silent).unwrap();
        let again = open(other.path(), None).unwrap();
        // The classes of the copy follow the order of its folder names.
        assert_eq!(again.classes().iter().collect::<Vec<_>>(), ["cock", "tench, Tinca tinca"]);
        assert_eq!((again.len(), again.get(2).unwrap().data), (3, dataset.get(0).unwrap().data));
        assert!(open(folder.path(), Some("test")).unwrap_err().to_string().contains("train, val"));
    }

    #[test]
    fn flat_folders_have_a_file_of_classes() {
        let folder = TemporaryFolder::new();
        folder.picture("val/a.png", 4, 4);
        folder.write("val.txt", "a.png 1\n../b.png 0\nc.png x\nd.png 2\n");
        folder.write("words.txt", "n01 tench\nn02 cock\n");
        let problems = Problems::skipping();
        let dataset = ImageNet::open(folder.path(), &OpenOptions::default(), &problems).unwrap();
        assert_eq!((dataset.len(), problems.count()), (1, 3));
        let messages: Vec<_> = problems.list().iter().map(|problem| problem.to_string()).collect();
        assert!(
            messages[0].contains("val.txt:2")
                && messages[1].contains("synset")
                && messages[2].contains("class 2, but there are 2 classes"),
            "{messages:?}"
        );
        assert!(matches!(dataset.target(0).unwrap(), Some(Value::Category(category)) if category.class == 1));
    }
}
