//! LFW: pairs of faces of the same person or of different persons.

use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Error, Progress, Result, Value, ValueType};

use crate::fields::{Fields, lines};
use crate::folder::{
    PICTURES, files_in, has_extension, name_of, past_end, path_inside, read_text, write_file, write_picture,
};
use crate::picture_files::write_each;
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

/// Names by class index.
const CLASSES: [&str; 2] = ["different", "same"];

/// Pairs of face images, of class 1 for the same person and 0 for different ones.
///
/// Parts are the folds of `pairs.txt`, from `1`, or `dev_train` and `dev_test` if their lists exist.
#[derive(Debug)]
pub struct Lfw {
    pairs: Vec<Pair>,
}

#[derive(Debug, Clone)]
struct Pair {
    files: [PathBuf; 2],
    same: bool,
    fold: u32,
}

impl Lfw {
    /// Returns the files of pair `index`.
    pub fn files(&self, index: usize) -> Option<&[PathBuf; 2]> {
        self.pairs.get(index).map(|pair| &pair.files)
    }

    /// Returns the fold of pair `index`, from 0; LFW's protocol trains on nine of ten.
    pub fn fold(&self, index: usize) -> Option<u32> {
        self.pairs.get(index).map(|pair| pair.fold)
    }

    fn pair(&self, index: usize) -> Result<&Pair> {
        self.pairs.get(index).ok_or_else(|| past_end(index, self.pairs.len()))
    }
}

impl Dataset for Lfw {}

impl DatasetIterator for Lfw {
    fn len(&self) -> usize {
        self.pairs.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let pair = self.pair(index)?;
        let open = |path: &PathBuf| opendr_vision::open(path).map(Value::Image);
        Ok(Sample { data: pair.files.iter().map(open).collect::<Result<_>>()?, target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let class = usize::from(self.pair(index)?.same);
        let description = CLASSES.get(class).map(|name| (*name).into());
        Ok(Some(Value::Category(Category { description, ..Category::new(class as i64, Some(1.0)) })))
    }

    fn name(&self, index: usize) -> String {
        match self.pair(index) {
            Ok(Pair { files: [first, second], .. }) => format!("{} {}", name_of(first), name_of(second)),
            Err(_) => index.to_string(),
        }
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.files(index).map(|[first, _]| first.clone())
    }

    fn classes(&self) -> Classes {
        CLASSES.into_iter().collect()
    }
}

impl Format for Lfw {
    const NAME: &'static str = "lfw";
    const ALIASES: &'static [&'static str] = &["face_pairs"];
    const ABOUT: &'static str = "LFW: pairs of faces, of the same person or not";
    const LAYOUT: &'static str = "pairs.txt with NAME/NAME_0001.jpg (also in lfw/); or a .csv of two files and Yes or No, beside the images";
    const TARGETS: &'static [ValueType] = &[ValueType::Category];

    fn recognise(path: &Path) -> Recognition {
        match lists(path).first() {
            Some(list) if name_of(list).starts_with("pairs") => Recognition::Certain,
            Some(list) => match read_text(list).is_ok_and(|text| {
                lines(&text).take(2).all(|(_, line)| Fields::between_commas(line).expect(3..=3).is_ok())
            }) {
                true => Recognition::Possible,
                false => Recognition::No("a .csv of two files and Yes or No".into()),
            },
            None => Recognition::No("pairs.txt, or a .csv of two files and Yes or No beside images".into()),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let lists = lists(path);
        let split = options.split.as_deref();
        let fold = split.and_then(|split| split.parse::<u32>().ok());
        let named = |split: &str| {
            let split = split.to_lowercase().replace(['_', ' '], "");
            lists.iter().find(|list| name_of(list).to_lowercase().contains(&split))
        };
        let list = match split {
            Some(split) if fold.is_none() => named(split),
            _ => lists.first(),
        };
        let list = list.ok_or_else(|| {
            let (path, layout) = (path.display(), Self::LAYOUT);
            Error::not_found(format!("no list of pairs in {path}; the layout is {layout}"))
        })?;
        let mut pairs = read_list(list, problems)?;
        pairs.retain(|pair| fold.is_none_or(|fold| pair.fold + 1 == fold));
        if pairs.is_empty() {
            return Err(Problem::new(list, "has no pair of that part; choose another part").into());
        }
        Ok(Self { pairs })
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let mut text = String::from("file_x,file_y,Decision\n");
        write_each(dataset, problems, progress, |index| {
            text += &write_pair(dataset, index, path, options.link)?;
            Ok(())
        })?;
        write_file(&path.join("pairs.csv"), text.as_bytes())
    }
}

/// Returns the lists of pairs at `path`, those of LFW's names first.
fn lists(path: &Path) -> Vec<PathBuf> {
    if !path.is_dir() {
        let fits = path.is_file() && path.to_str().is_some_and(|name| has_extension(name, &["txt", "csv"]));
        return fits.then(|| path.to_owned()).into_iter().collect();
    }
    let mut names = files_in(path, &["txt", "csv"]);
    names.retain(|name| name.starts_with("pairs") || has_extension(name, &["csv"]));
    names.sort_by_key(|name| !name.starts_with("pairs"));
    names.into_iter().map(|name| path.join(name)).collect()
}

fn read_list(list: &Path, problems: &Problems) -> Result<Vec<Pair>> {
    let text = read_text(list)?;
    let folder = list.parent().unwrap_or(Path::new(""));
    let is_csv = list.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    let (mut pairs, mut size) = (Vec::new(), 0usize);
    for (at, (number, line)) in lines(&text).enumerate() {
        let pair = match is_csv {
            true if at == 0 => continue,
            true => csv_pair(folder, line),
            false if at == 0 && line.split_whitespace().count() <= 2 => {
                // Number of folds and of pairs of each kind in a fold; without folds, the number of pairs alone.
                let numbers: Option<Vec<usize>> =
                    line.split_whitespace().map(|word| word.parse().ok()).collect();
                let numbers = numbers.ok_or_else(|| {
                    Problem::at_line(list, number, "is neither a pair nor a number of pairs")
                })?;
                size = if numbers.len() == 2 { numbers[1].saturating_mul(2) } else { 0 };
                continue;
            }
            false => lfw_pair(folder, line),
        };
        let pair = pair.and_then(|pair| {
            let missing = pair.files.iter().find(|file| !file.is_file());
            missing.map_or(Ok(()), |file| Err(format!("refers to {}, which is missing", file.display())))?;
            Ok(pair)
        });
        match pair {
            Ok(pair) => {
                // The fold follows from the line, so that a skipped pair does not shift the others.
                let fold = (at - 1).checked_div(size).unwrap_or(0) as u32;
                pairs.push(Pair { fold, ..pair });
            }
            Err(message) => problems.report(Problem::at_line(list, number, message))?,
        }
    }
    Ok(pairs)
}

/// Parses `file,file,Yes`.
fn csv_pair(folder: &Path, line: &str) -> Result<Pair, String> {
    let fields = Fields::between_commas(line);
    fields.expect(3..=3)?;
    let decision = fields.text(2)?;
    let same = match decision.to_lowercase().as_str() {
        "yes" | "true" | "1" | "same" => true,
        "no" | "false" | "0" | "different" => false,
        _ => return Err(format!("has {decision:.40?} instead of Yes or No")),
    };
    let files = [path_inside(folder, fields.text(0)?)?, path_inside(folder, fields.text(1)?)?];
    Ok(Pair { files, same, fold: 0 })
}

/// Parses `NAME 1 2` or `NAME 1 OTHER 2`.
fn lfw_pair(folder: &Path, line: &str) -> Result<Pair, String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let (first, second) = match words[..] {
        [name, first, second] => ((name, first), (name, second)),
        [name, first, other, second] => ((name, first), (other, second)),
        _ => return Err(format!("has {} fields instead of 3 or 4", words.len())),
    };
    let file = |(name, number): (&str, &str)| {
        let parsed: u32 =
            number.parse().map_err(|_| format!("has {number:.40?} instead of an image number"))?;
        let stem = format!("{name}/{name}_{parsed:04}");
        let plain = path_inside(folder, &format!("{stem}.jpg"))?;
        let candidates = ["", "lfw", "lfw_funneled", "lfw-deepfunneled"]
            .iter()
            .flat_map(|inner| PICTURES.iter().map(move |extension| (inner, extension)));
        let mut candidates =
            candidates.map(|(inner, extension)| folder.join(inner).join(format!("{stem}.{extension}")));
        Ok::<_, String>(candidates.find(|file| file.is_file()).unwrap_or(plain))
    };
    Ok(Pair { files: [file(first)?, file(second)?], same: words.len() == 3, fold: 0 })
}

/// Writes the images of a pair, named by its index, and returns its line.
fn write_pair(dataset: &dyn DatasetIterator, index: usize, path: &Path, link: bool) -> Result<String> {
    let sample = dataset.get(index)?;
    let (Some(Value::Image(first)), Some(Value::Image(second)), Some(Value::Category(category))) =
        (sample.data.first(), sample.data.get(1), &sample.target)
    else {
        return Err(Error::invalid_input("the sample needs two images and a Category"));
    };
    let from = dataset.path(index);
    // The first image keeps the format of its file; the path of the second is unknown.
    let kept = from.as_deref().and_then(|path| path.extension()?.to_str()).map(str::to_lowercase);
    let kept =
        kept.filter(|extension| PICTURES.contains(&extension.as_str())).unwrap_or_else(|| "png".to_owned());
    let names = [format!("{index:06}_a.{kept}"), format!("{index:06}_b.png")];
    write_picture(from.as_deref(), first, &path.join(&names[0]), link)?;
    write_picture(None, second, &path.join(&names[1]), link)?;
    let same = if category.class == 1 { "Yes" } else { "No" };
    Ok(format!("{},{},{same}\n", names[0], names[1]))
}

#[cfg(test)]
mod tests;
