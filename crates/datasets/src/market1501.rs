//! Market-1501: persons observed by several cameras, identified by the names of their images.
//!
//! Source: L. Zheng et al., Scalable Person Re-identification: A Benchmark, ICCV 2015.

use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::Category;
use opendr_engine::{Error, Header, Progress, Result, Value, ValueType};

use crate::folder::{PICTURES, files_in, name_of, part_folder, past_end, path_inside, write_picture};
use crate::picture_files::write_each;
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

/// Names of the parts; the default is the query part.
const PARTS: [&str; 3] = ["query", "bounding_box_test", "bounding_box_train"];
/// Identity of junk: a part of a person, which is ignored.
const JUNK: i64 = -1;
/// Identity of distractors: no person, or one that is in no query.
const DISTRACTOR: i64 = 0;

/// Crops of persons with their identity. The class is the identity in the file name, 0 for distractors; junk (-1)
/// is skipped.
///
/// The header of the image has the camera as frame id, e.g. `c3`. Parts are `query`, `bounding_box_test` (the
/// gallery, also called `test` or `gallery`) and `bounding_box_train` (`train`).
#[derive(Debug)]
pub struct Market1501 {
    root: PathBuf,
    persons: Vec<MarketPerson>,
}

/// The fields of a file name, e.g. `0002_c1s1_000451_03.jpg`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MarketPerson {
    /// File name in the folder of the part.
    pub file: String,
    /// Identity of the person; 0 for distractors.
    pub identity: i64,
    /// Camera number, from 1.
    pub camera: u32,
    /// Sequence number of the camera, from 1, if the name has it.
    pub sequence: Option<u32>,
    /// Frame number in the sequence, if the name has it.
    pub frame: Option<u32>,
}

impl MarketPerson {
    /// Parses a file name.
    ///
    /// # Errors
    /// A message if the name is invalid.
    pub fn from_name(name: &str) -> Result<Self, String> {
        let wrong = || format!("{name:.80?} is not of the form 0002_c1s1_000451_03.jpg; rename it");
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let mut words = stem.split('_');
        let identity: i64 = words.next().and_then(|word| word.parse().ok()).ok_or_else(wrong)?;
        let place = words.next().and_then(|word| word.strip_prefix('c')).ok_or_else(wrong)?;
        let (camera, sequence) =
            place.split_once('s').map_or((place, None), |(camera, rest)| (camera, Some(rest)));
        let number = |text: &str| text.parse::<u32>().map_err(|_| wrong());
        let camera = number(camera)?;
        if identity < JUNK || camera == 0 {
            return Err(format!(
                "{name:.80?} has person {identity} and camera {camera}, which are invalid; rename it"
            ));
        }
        let frame = words.next().and_then(|word| word.parse().ok());
        Ok(Self {
            file: name.to_owned(),
            identity,
            camera,
            sequence: sequence.map(number).transpose()?,
            frame,
        })
    }
}

impl Market1501 {
    /// Returns the fields of each image's file name.
    pub fn persons(&self) -> &[MarketPerson] {
        &self.persons
    }

    fn person(&self, index: usize) -> Result<&MarketPerson> {
        self.persons.get(index).ok_or_else(|| past_end(index, self.persons.len()))
    }
}

impl Dataset for Market1501 {}

impl DatasetIterator for Market1501 {
    fn len(&self) -> usize {
        self.persons.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let person = self.person(index)?;
        let image = opendr_vision::open(self.root.join(&person.file))?;
        let header = Header { frame_id: Some(format!("c{}", person.camera).into()), stamp_ns: None };
        Ok(Sample { data: vec![Value::Image(image.with_header(header))], target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let MarketPerson { identity, camera, .. } = self.person(index)?;
        let text =
            if *identity == DISTRACTOR { "distractor".to_owned() } else { format!("person {identity}") };
        let header = Header { frame_id: Some(format!("c{camera}").into()), stamp_ns: None };
        let description = Some(text.into());
        Ok(Some(Value::Category(Category { header, description, ..Category::new(*identity, Some(1.0)) })))
    }

    fn name(&self, index: usize) -> String {
        self.person(index).map_or_else(|_| index.to_string(), |person| person.file.clone())
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.persons.get(index).map(|person| self.root.join(&person.file))
    }
}

impl Format for Market1501 {
    const NAME: &'static str = "market1501";
    const ALIASES: &'static [&'static str] = &["market", "market-1501", "dukemtmc"];
    const ABOUT: &'static str = "Market-1501: person re-identification with several cameras";
    const LAYOUT: &'static str =
        "query/, bounding_box_test/ and bounding_box_train/ with 0002_c1s1_000451_03.jpg; or one such folder";
    const TARGETS: &'static [ValueType] = &[ValueType::Category];

    fn recognise(path: &Path) -> Recognition {
        if PARTS.iter().any(|part| path.join(part).is_dir()) {
            return Recognition::Certain;
        }
        let names = files_in(path, PICTURES);
        match names.first().is_some_and(|name| MarketPerson::from_name(name).is_ok()) {
            true => Recognition::Certain,
            false => Recognition::No(
                "bounding_box_train/, query/, or images named like 0002_c1s1_000451_03.jpg".into(),
            ),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let wanted = match options.split.as_deref() {
            Some("train") => Some("bounding_box_train"),
            Some("test" | "gallery") => Some("bounding_box_test"),
            Some("val") => Some("query"),
            other => other,
        };
        let root = part_folder(path, wanted, &PARTS)?.unwrap_or_else(|| path.to_owned());
        let mut persons = Vec::new();
        for name in files_in(&root, PICTURES) {
            match MarketPerson::from_name(&name) {
                Ok(person) if person.identity == JUNK => {}
                Ok(person) => persons.push(person),
                Err(message) => problems.report(Problem::new(root.join(&name), message))?,
            }
        }
        if persons.is_empty() {
            let (root, layout) = (root.display(), Self::LAYOUT);
            return Err(Error::not_found(format!("no person in {root}; the layout is {layout}")));
        }
        Ok(Self { root, persons })
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let part = match options.split.as_deref() {
            None | Some("train") => "bounding_box_train",
            Some("test" | "gallery") => "bounding_box_test",
            Some(other) => other,
        };
        let folder = path_inside(path, part).map_err(Error::invalid_param)?;
        write_each(dataset, problems, progress, |index| write_person(dataset, index, &folder, options.link))
    }
}

/// Writes an image, under its own name if that has the identity.
fn write_person(dataset: &dyn DatasetIterator, index: usize, folder: &Path, link: bool) -> Result<()> {
    let sample = dataset.get(index)?;
    let (Some(Value::Image(image)), Some(Value::Category(category))) = (sample.data.first(), &sample.target)
    else {
        return Err(Error::invalid_input("the sample needs an Image and a Category"));
    };
    let from = dataset.path(index);
    let kept = from
        .as_deref()
        .map(name_of)
        .filter(|name| MarketPerson::from_name(name).is_ok_and(|person| person.identity == category.class));
    let camera = image.header.frame_id.as_deref().filter(|id| id.starts_with('c')).unwrap_or("c1");
    let name = kept.unwrap_or_else(|| format!("{:04}_{camera}s1_{index:06}_00.jpg", category.class));
    MarketPerson::from_name(&name).map_err(Error::invalid_input)?;
    let to = path_inside(folder, &name).map_err(Error::invalid_input)?;
    write_picture(from.as_deref(), image, &to, link)
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;

    use super::*;
    use crate::folder::TemporaryFolder;

    fn persons() -> TemporaryFolder {
        TemporaryFolder::new()
            .with_picture("query/0002_c1s1_000451_00.jpg")
            .with_picture("bounding_box_test/0002_c3s2_000451_03.jpg")
            .with_picture("bounding_box_test/0000_c2s1_000001_01.jpg")
            .with_picture("bounding_box_test/-1_c2s1_000001_01.jpg")
    }

    fn open(folder: &TemporaryFolder, split: Option<&str>) -> Result<Market1501> {
        let options = OpenOptions { split: split.map(str::to_owned), target: None };
        Market1501::open(folder.path(), &options, &Problems::strict())
    }

    #[test]
    fn names_have_identities() {
        let folder = persons();
        assert_eq!(Market1501::recognise(folder.path()), Recognition::Certain);
        assert_eq!(open(&folder, None).unwrap().name(0), "0002_c1s1_000451_00.jpg");
        let gallery = open(&folder, Some("gallery")).unwrap();
        let found: Vec<_> = gallery.persons().iter().map(|person| (person.identity, person.camera)).collect();
        assert_eq!(found, [(0, 2), (2, 3)]);
        assert_eq!(gallery.persons()[1].sequence.zip(gallery.persons()[1].frame), Some((2, 451)));
        let sample = gallery.get(1).unwrap();
        let Some(Value::Category(category)) = sample.target else { panic!() };
        assert_eq!((category.class, sample.data[0].header().frame_id.as_deref()), (2, Some("c3")));
        assert!(open(&folder, Some("train")).is_err() && gallery.get(2).is_err());
    }

    #[test]
    fn wrong_names_are_reported() {
        for name in
            ["a.jpg", "0002.jpg", "0002_x1.jpg", "0002_c0s1_1.jpg", "-2_c1s1_1.jpg", "0002_c1sx_1.jpg"]
        {
            let folder = persons().with_picture(&format!("query/{name}"));
            let error = open(&folder, None).unwrap_err().to_string();
            assert!(error.contains(name) && error.contains("rename it"), "{error}");
            let problems = Problems::skipping();
            let query = Market1501::open(folder.path(), &OpenOptions::default(), &problems).unwrap();
            assert_eq!((query.len(), problems.count()), (1, 1));
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let (folder, copy) = (persons(), TemporaryFolder::new());
        let gallery = open(&folder, Some("gallery")).unwrap();
        Market1501::write(&gallery, copy.path(), &WriteOptions::default(), &Problems::strict(), &Silent)
            .unwrap();
        let again = open(&copy, Some("train")).unwrap();
        assert_eq!(again.persons(), gallery.persons());
        assert_eq!(again.get(0).unwrap(), gallery.get(0).unwrap());
    }
}
