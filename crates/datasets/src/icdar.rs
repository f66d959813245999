//! ICDAR: text in images, as quadrilaterals with transcriptions.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{TextRegion, TextRegionList};
use opendr_engine::{Error, Progress, Result, Value, ValueType};

use crate::fields::lines;
use crate::folder::{files_in, has_extension, read_text, write_file};
use crate::image_pairs::ImagePairs;
use crate::picture_files::{PictureWriter, open_picture, split_name, write_each};
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

/// Folders of images and annotations of a part, as ICDAR 2015 (Challenge 4) distributes them.
const PARTS: [(&str, [&str; 2]); 2] = [
    ("train", ["ch4_training_images", "ch4_training_localization_transcription_gt"]),
    ("test", ["ch4_test_images", "Challenge4_Test_Task1_GT"]),
];

/// Names of parts as folders, the preferred one first.
const SPLITS: [&str; 3] = ["val", "test", "train"];

/// A data set of text in images.
#[derive(Debug)]
pub struct Icdar {
    /// Images and their annotations.
    pairs: ImagePairs,
}

/// Returns the folders of images and annotations of a part.
fn folders(path: &Path, split: Option<&str>) -> Option<[PathBuf; 2]> {
    let parts = split.map_or_else(|| SPLITS.to_vec(), |split| vec![split]);
    let own = parts.iter().flat_map(|part| {
        let folder = path.join(part);
        [[folder.join("images"), folder.join("gt")], [folder.clone(), folder]]
    });
    let known = PARTS.iter().filter(|(part, _)| split.is_none_or(|split| split == *part));
    let known = known.map(|(_, pair)| pair.map(|name| path.join(name)));
    let whole = [[path.join("images"), path.join("gt")], [path.to_owned(), path.to_owned()]];
    let whole = whole.into_iter().filter(|_| split.is_none());
    own.chain(known).chain(whole).find(|[images, texts]| {
        let is_annotation = |name: &String| name.starts_with("gt_") && has_extension(name, &["txt"]);
        images.is_dir() && files_in(texts, &["txt"]).iter().any(is_annotation)
    })
}

/// Parses a line `x1,y1,...,x4,y4,text` (ICDAR 2015) or `left,top,right,bottom,"text"` (ICDAR 2013).
pub(crate) fn region_from_line(line: &str) -> Result<TextRegion, String> {
    let line = line.trim_start_matches('\u{feff}');
    let fields: Vec<&str> = line.splitn(9, ',').map(str::trim).collect();
    let number = |at: usize| {
        let field = fields.get(at).ok_or("the line has too few fields; give four corners and the text")?;
        let number: f32 = field.parse().map_err(|_| format!("{field:?} is not a coordinate"))?;
        if number.is_finite() { Ok(number) } else { Err(format!("{field:?} is not finite")) }
    };
    let is_quadrilateral = fields.len() == 9 && (4..8).all(|at| fields[at].parse::<f32>().is_ok());
    if is_quadrilateral {
        let corner = |at: usize| Ok::<_, String>([number(2 * at)?, number(2 * at + 1)?]);
        let corners = [corner(0)?, corner(1)?, corner(2)?, corner(3)?];
        return Ok(TextRegion::new(fields[8], corners, 1.0));
    }
    let [left, top, right, bottom] = [number(0)?, number(1)?, number(2)?, number(3)?];
    let text = line.splitn(5, ',').nth(4).ok_or("the line has no text after its four coordinates")?.trim();
    let quoted = text.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
    let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
    Ok(TextRegion::new(quoted.unwrap_or(text), corners, 1.0))
}

/// Returns the line of a region; coordinates are whole pixels where they are whole.
fn line_of_region(region: &TextRegion) -> Result<String> {
    if region.text.contains(['\n', '\r']) {
        return Err(Error::invalid_input(format!(
            "{:?} has a line break; write each line as a region of its own",
            region.text
        )));
    }
    let mut line = String::new();
    for number in region.corners.iter().flatten() {
        if !number.is_finite() {
            return Err(Error::invalid_input(format!("a corner of {:?} is not finite", region.text)));
        }
        write!(line, "{number},").map_err(|error| Error::internal(error.to_string()))?;
    }
    Ok(line + &region.text + "\n")
}

impl Icdar {
    fn regions(&self, index: usize) -> Result<TextRegionList> {
        let [_, file] = self.pairs.get(index)?;
        let text = read_text(file)?;
        let regions = lines(&text).map(|(number, line)| {
            region_from_line(line)
                .map_err(|message| Error::format(Problem::at_line(file, number, message).to_string()))
        });
        Ok(regions.collect::<Result<Vec<_>>>()?.into())
    }
}

impl Dataset for Icdar {}

impl DatasetIterator for Icdar {
    fn len(&self) -> usize {
        self.pairs.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let regions = self.regions(index)?;
        let image = open_picture(&self.pairs.get(index)?[0], [0, 0])?;
        Ok(Sample { data: vec![image.into()], target: Some(regions.into()) })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(Some(self.regions(index)?.into()))
    }

    fn name(&self, index: usize) -> String {
        self.pairs.name(index)
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.pairs.image(index)
    }
}

impl Format for Icdar {
    const NAME: &'static str = "icdar";
    const ALIASES: &'static [&'static str] = &["icdar2015", "icdar2013"];
    const ABOUT: &'static str = "ICDAR: text in images, as quadrilaterals or boxes with transcriptions";
    const LAYOUT: &'static str = "images/*.jpg and gt/gt_NAME.txt, with x1,y1,x2,y2,x3,y3,x4,y4,TEXT in each line (### for a text that cannot \
                                  be read); or ch4_training_images and ch4_training_localization_transcription_gt";
    const TARGETS: &'static [ValueType] = &[ValueType::TextRegionList];

    fn recognise(path: &Path) -> Recognition {
        match folders(path, None) {
            Some(_) => Recognition::Certain,
            None => Recognition::No("gt_NAME.txt for each image, in gt/ or beside it".into()),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let [images, texts] = folders(path, options.split.as_deref()).ok_or_else(|| {
            let split = options.split.as_deref().map_or(String::new(), |split| format!("{split}/"));
            Error::not_found(format!("no {split}images with {split}gt/gt_NAME.txt in {}", path.display()))
        })?;
        let text_of = |name: &str| {
            let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
            texts.join(format!("gt_{stem}.txt"))
        };
        Ok(Self { pairs: ImagePairs::find(&images, "annotation", text_of, problems)? })
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let folder = path.join(split_name(options)?);
        let pictures = PictureWriter::new(dataset, folder.join("images"), options)?;
        write_each(dataset, problems, progress, |index| {
            let Some(Value::TextRegionList(list)) = dataset.target(index)? else {
                return Err(Error::invalid_input(
                    "the sample has no regions of text; ICDAR needs a TextRegionList",
                ));
            };
            let text = list.regions.iter().map(line_of_region).collect::<Result<String>>()?;
            let placed = pictures.place(index)?;
            let stem = placed.name.rsplit_once('.').map_or(placed.name.as_str(), |(stem, _)| stem);
            write_file(&folder.join("gt").join(format!("gt_{stem}.txt")), text.as_bytes())
        })
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;
    use proptest::prelude::*;

    use super::*;
    use crate::folder::TemporaryFolder;

    fn open(path: &Path) -> Result<Icdar> {
        Icdar::open(path, &OpenOptions::default(), &Problems::strict())
    }

    fn regions(dataset: &Icdar) -> Vec<TextRegion> {
        match dataset.get(0).unwrap().target {
            Some(Value::TextRegionList(list)) => list.regions,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn annotations_are_read_and_written() {
        let (folder, other) = (TemporaryFolder::new(), TemporaryFolder::new());
        folder.picture("images/img_1.png", 40, 20);
        folder.write("gt/gt_img_1.txt", "\u{feff}1,2,11,3.5,11,8,1,7,Exit, left\r\n0,0,4,0,4,4,0,4,###\r\n");
        assert_eq!(Icdar::recognise(folder.path()), Recognition::Certain);
        let dataset = open(folder.path()).unwrap();
        let expected = [
            TextRegion::new("Exit, left", [[1.0, 2.0], [11.0, 3.5], [11.0, 8.0], [1.0, 7.0]], 1.0),
            TextRegion::new(TextRegion::ILLEGIBLE, [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]], 1.0),
        ];
        assert_eq!(regions(&dataset), expected);
        Icdar::write(&dataset, other.path(), &WriteOptions::default(), &Problems::strict(), &Silent).unwrap();
        assert_eq!(regions(&open(other.path()).unwrap()), expected);
    }

    #[test]
    fn boxes_of_2013_are_read() {
        let folder = TemporaryFolder::new();
        folder.picture("ch4_test_images/a.png", 40, 20);
        folder.write("Challenge4_Test_Task1_GT/gt_a.txt", "38, 4, 92, 30, \"Say, \"hi\"\"\n");
        let [region] = regions(&open(folder.path()).unwrap()).try_into().unwrap();
        assert_eq!(region.text, "Say, \"hi\"");
        assert_eq!(region.corners, [[38.0, 4.0], [92.0, 4.0], [92.0, 30.0], [38.0, 30.0]]);
    }

    #[test]
    fn broken_files_are_reported() {
        let folder = TemporaryFolder::new();
        folder.picture("a.png", 4, 4);
        folder.write("gt_a.txt", "1,2,3,4,5,6,7,8,ok\n1,2,x,4,5,6,7,8,no\n");
        let error = open(folder.path()).unwrap().target(0).unwrap_err().to_string();
        assert!(error.contains("gt_a.txt:2") && error.contains("\"x\" is not a coordinate"), "{error}");
        folder.picture("b.png", 4, 4);
        let error = open(folder.path()).unwrap_err().to_string();
        assert!(error.contains("b.png") && error.contains("is missing"), "{error}");
        for line in ["", "1,2,3", "1,2,3,inf,text", "1,2,3,4"] {
            assert!(region_from_line(line).is_err(), "{line:?}");
        }
    }

    proptest! {
        #[test]
        fn no_line_panics(line in ".{0,60}") {
            if let Ok(region) = region_from_line(&line) {
                prop_assert!(region.corners.iter().flatten().all(|number| number.is_finite()));
            }
        }
    }
}
