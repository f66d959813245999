//! Images in IDX files: MNIST, Fashion-MNIST, KMNIST and EMNIST.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;
use opendr_engine::data::{Image, Layout, PixelFormat};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Error, Result, ResultExt, Value, ValueType};

use crate::folder::{past_end, read_text};
use crate::{Format, OpenOptions, Problem, Problems, Recognition};

/// Largest size of a decompressed file in bytes: EMNIST's 814,255 images take 638 MB.
const MAX_BYTES: usize = 1 << 30;
/// Third byte of an IDX file of bytes; the fourth is the number of axes.
const UNSIGNED_BYTES: u8 = 8;
const CLASS_NAMES: &str = "classes.txt";
/// Parts and the first word of their file names.
const PARTS: [(&str, &str); 2] = [("test", "t10k"), ("train", "train")];
const FASHION: [&str; 10] =
    ["t-shirt", "trouser", "pullover", "dress", "coat", "sandal", "shirt", "sneaker", "bag", "ankle boot"];

/// Grey images with their class.
///
/// Class names are the lines of `classes.txt` beside the files. Without it, they are Fashion-MNIST's if the folder
/// name contains "fashion", otherwise numbers. Parts are `train` and `test`.
pub struct Mnist {
    pictures: Idx<3>,
    labels: Idx<1>,
    classes: Classes,
}

/// An array of bytes from an IDX file.
struct Idx<const AXES: usize> {
    path: PathBuf,
    shape: [usize; AXES],
    bytes: Vec<u8>,
}

impl<const AXES: usize> Idx<AXES> {
    fn read(path: PathBuf) -> Result<Self> {
        let read = || -> Result<(Vec<u8>, [usize; AXES])> {
            let file = File::open(&path)?;
            let mut reader: Box<dyn Read> = match path.extension().is_some_and(|end| end == "gz") {
                true => Box::new(MultiGzDecoder::new(file)),
                false => Box::new(file),
            };
            let mut head = [0; 4];
            reader.read_exact(&mut head)?;
            if head != [0, 0, UNSIGNED_BYTES, AXES as u8] {
                return Err(Error::format(format!("not an IDX file of bytes with {AXES} axes")));
            }
            let mut shape = [0; AXES];
            for size in &mut shape {
                let mut bytes = [0; 4];
                reader.read_exact(&mut bytes)?;
                *size = u32::from_be_bytes(bytes) as usize;
            }
            let count = shape.iter().try_fold(1usize, |count, size| count.checked_mul(*size));
            let count = count.filter(|count| *count <= MAX_BYTES).ok_or_else(|| {
                Error::format(format!(
                    "the header states an array of {shape:?}; the limit is {MAX_BYTES} bytes"
                ))
            })?;
            let mut bytes = Vec::new();
            reader.take(count as u64).read_to_end(&mut bytes)?;
            if bytes.len() < count {
                return Err(Error::format(format!(
                    "the file is truncated: it has {} of {count} bytes",
                    bytes.len()
                )));
            }
            Ok((bytes, shape))
        };
        let (bytes, shape) = read().context(|| format!("reading {}", path.display()))?;
        Ok(Self { path, shape, bytes })
    }

    /// Returns the part `index` along the first axis.
    fn part(&self, index: usize) -> Option<&[u8]> {
        let size = self.shape[1..].iter().product::<usize>();
        (index < self.shape[0]).then(|| self.bytes.get(index * size..(index + 1) * size)).flatten()
    }
}

impl Dataset for Mnist {}

impl DatasetIterator for Mnist {
    fn len(&self) -> usize {
        self.labels.shape[0]
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let pixels = self.pictures.part(index).ok_or_else(|| past_end(index, self.len()))?;
        let [_, height, width] = self.pictures.shape;
        let image = Image::new(pixels.to_vec(), width, height, PixelFormat::Grey, Layout::Hwc)?;
        Ok(Sample { data: vec![Value::Image(image)], target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let [class] = self.labels.part(index).ok_or_else(|| past_end(index, self.len()))? else {
            return Err(Error::internal("a label is a byte"));
        };
        let description = self.classes.name(i64::from(*class)).cloned();
        Ok(Some(Value::Category(Category { description, ..Category::new(i64::from(*class), Some(1.0)) })))
    }

    fn image_size(&self, _: usize) -> Option<[u32; 2]> {
        let [_, height, width] = self.pictures.shape;
        Some([u32::try_from(width).ok()?, u32::try_from(height).ok()?])
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

impl Format for Mnist {
    const NAME: &'static str = "mnist";
    const ALIASES: &'static [&'static str] = &["fashion_mnist", "kmnist", "emnist", "idx"];
    const ABOUT: &'static str = "MNIST: grey images with classes in IDX files, as in Fashion-MNIST";
    const LAYOUT: &'static str = "train-images-idx3-ubyte, train-labels-idx1-ubyte, the same with t10k for test, each also as .gz; optionally classes.txt";
    const TARGETS: &'static [ValueType] = &[ValueType::Category];

    fn recognise(path: &Path) -> Recognition {
        match PARTS.iter().any(|(_, start)| file(path, start, "images-idx3").is_some()) {
            true => Recognition::Certain,
            false => {
                Recognition::No("train-images-idx3-ubyte or t10k-images-idx3-ubyte, optionally .gz".into())
            }
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, _: &Problems) -> Result<Self> {
        let split = options.split.as_deref();
        let mut parts =
            PARTS.iter().filter(|(name, start)| split.is_none_or(|split| [*name, *start].contains(&split)));
        let files = parts
            .find_map(|(_, start)| file(path, start, "images-idx3").zip(file(path, start, "labels-idx1")));
        let (pictures, labels) = files.ok_or_else(|| {
            let part = split.map(|split| format!(" of part {split:?}")).unwrap_or_default();
            Error::not_found(format!(
                "no images and labels{part} in {}; the layout is {}",
                path.display(),
                Self::LAYOUT
            ))
        })?;
        let (pictures, labels) = (Idx::<3>::read(pictures)?, Idx::<1>::read(labels)?);
        if pictures.shape[0] != labels.shape[0] {
            let message =
                format!("has {} images, but there are {} labels", pictures.shape[0], labels.shape[0]);
            return Err(Problem::new(pictures.path, message).into());
        }
        let classes = class_names(path, labels.bytes.iter().copied().max().unwrap_or(0))?;
        Ok(Self { pictures, labels, classes })
    }
}

/// Returns the file of a part and kind.
fn file(folder: &Path, part: &str, kind: &str) -> Option<PathBuf> {
    let names = ["-ubyte.gz", "-ubyte"].map(|end| folder.join(format!("{part}-{kind}{end}")));
    names.into_iter().find(|path| path.is_file())
}

fn class_names(folder: &Path, highest: u8) -> Result<Classes> {
    let named = folder.join(CLASS_NAMES);
    let classes: Classes = if named.is_file() {
        read_text(&named)?.lines().map(str::trim).filter(|line| !line.is_empty()).collect()
    } else if folder.to_string_lossy().to_lowercase().contains("fashion") {
        FASHION.into_iter().collect()
    } else {
        return Ok((0..=highest).map(|class| class.to_string()).collect());
    };
    match classes.len() > usize::from(highest) {
        true => Ok(classes),
        false => {
            Err(Problem::new(named, format!("has {} classes, but a label is {highest}", classes.len()))
                .into())
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("opendr-mnist-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn write(folder: &Path, labels: &[u8]) {
        let count = (labels.len() as u32).to_be_bytes();
        let pictures = [&[0, 0, 8, 3][..], &count, &[0, 0, 0, 2], &[0, 0, 0, 3], &[7; 6], &[9; 6]].concat();
        fs::write(folder.join("train-images-idx3-ubyte"), pictures).unwrap();
        fs::write(folder.join("train-labels-idx1-ubyte"), [&[0, 0, 8, 1][..], &count, labels].concat())
            .unwrap();
    }

    #[test]
    fn pictures_with_their_classes() {
        let folder = folder("fashion");
        write(&folder, &[9, 0]);
        assert!(matches!(Mnist::recognise(&folder), Recognition::Certain));
        let dataset = Mnist::open(&folder, &OpenOptions::default(), &Problems::strict()).unwrap();
        assert_eq!((dataset.len(), dataset.image_size(0)), (2, Some([3, 2])));
        let Some(Value::Category(category)) = dataset.target(0).unwrap() else { panic!() };
        assert_eq!(category.description.as_deref(), Some("ankle boot"));
        let Value::Image(image) = &dataset.get(1).unwrap().data[0] else { panic!() };
        assert_eq!((image.width(), image.height()), (3, 2));
        assert!(dataset.get(2).is_err());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn broken_files_are_reported() {
        let folder = folder("broken");
        let open = || Mnist::open(&folder, &OpenOptions::default(), &Problems::strict());
        write(&folder, &[1, 2, 3]);
        assert!(open().err().unwrap().to_string().contains("truncated"));
        write(&folder, &[1, 2]);
        fs::write(folder.join("classes.txt"), "no\nyes\n").unwrap();
        assert!(open().err().unwrap().to_string().contains("a label is 2"));
        let huge = [&[0, 0, 8, 3][..], &[255; 12]].concat();
        fs::write(folder.join("train-images-idx3-ubyte"), huge).unwrap();
        assert!(open().err().unwrap().to_string().contains("the limit is"));
        fs::write(folder.join("train-images-idx3-ubyte"), b"GIF89a").unwrap();
        assert!(open().err().unwrap().to_string().contains("not an IDX file"));
        fs::remove_dir_all(folder).unwrap();
    }
}
