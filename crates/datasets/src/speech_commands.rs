//! Speech Commands: spoken words as WAVE files, a folder for each word.
//!
//! Source: P. Warden, Speech Commands: A Dataset for Limited-Vocabulary Speech Recognition, arXiv 1804.03209.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Category, Classes, SpeechCommand};
use opendr_engine::{Error, Progress, Result, Value, ValueType};

use crate::fields::lines;
use crate::folder::{files_in, folders_in, name_of, past_end, path_inside, read_text};
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions, open_wav};

mod split;
mod write;

pub use split::{SpeechSplit, speaker_of_clip, split_of_clip};

/// Folder of background noise, which is not a word.
const NOISE: &str = "_background_noise_";

/// Spoken words: a sample is a clip with its word.
///
/// Parts are those of `validation_list.txt` and `testing_list.txt`; the rest is training. Without these lists, the
/// rule of the paper assigns clips to parts, which keeps a speaker in one part. Without lists and without a
/// selected part, all clips are read.
#[derive(Debug)]
pub struct SpeechCommands {
    classes: Classes,
    /// Class index and path of each clip.
    clips: Vec<(usize, PathBuf)>,
    noises: Vec<PathBuf>,
    target: ValueType,
}

impl SpeechCommands {
    /// Returns the recordings of background noise, which training can mix in; [`open_wav`] reads them.
    pub fn noises(&self) -> &[PathBuf] {
        &self.noises
    }

    fn clip(&self, index: usize) -> Result<(&str, usize, &Path)> {
        let clip = self.clips.get(index).and_then(|(class, path)| {
            self.classes.name(*class as i64).map(|word| (&**word, *class, path.as_path()))
        });
        clip.ok_or_else(|| past_end(index, self.clips.len()))
    }
}

impl Dataset for SpeechCommands {}

impl DatasetIterator for SpeechCommands {
    fn len(&self) -> usize {
        self.clips.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (_, _, path) = self.clip(index)?;
        Ok(Sample { data: vec![Value::Audio(open_wav(path)?)], target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let (word, class, _) = self.clip(index)?;
        Ok(Some(match self.target {
            ValueType::SpeechCommand => Value::SpeechCommand(SpeechCommand::new(word, 1.0)),
            _ => Value::Category(Category {
                description: Some(word.into()),
                ..Category::new(class as i64, Some(1.0))
            }),
        }))
    }

    fn name(&self, index: usize) -> String {
        match self.clip(index) {
            Ok((word, _, path)) => format!("{word}/{}", name_of(path)),
            Err(_) => index.to_string(),
        }
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.clip(index).ok().map(|(_, _, path)| path.to_owned())
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

impl Format for SpeechCommands {
    const NAME: &'static str = "speech_commands";
    const ALIASES: &'static [&'static str] = &["speechcommands", "google_speech_commands"];
    const ABOUT: &'static str = "Speech Commands: spoken words as WAVE files, a folder for each word";
    const LAYOUT: &'static str = "WORD/SPEAKER_nohash_0.wav; validation_list.txt and testing_list.txt for these parts; \
                                  _background_noise_/ for noise";
    const TARGETS: &'static [ValueType] = &[ValueType::Category, ValueType::SpeechCommand];

    fn recognise(path: &Path) -> Recognition {
        let with_clips = |word: &String| !files_in(&path.join(word), &["wav"]).is_empty();
        if path.join("testing_list.txt").is_file() && path.join("validation_list.txt").is_file() {
            return Recognition::Certain;
        }
        let has_speakers =
            |word: &String| files_in(&path.join(word), &["wav"]).iter().any(|name| name.contains("_nohash_"));
        let words = folders_in(path);
        match words.iter().any(with_clips) {
            true if words.iter().any(has_speakers) => Recognition::Certain,
            true => Recognition::Possible,
            false => Recognition::No("a folder for each word, with .wav files".into()),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let target = options.target.unwrap_or(ValueType::Category);
        let words: Vec<_> = folders_in(path).into_iter().filter(|word| word != NOISE).collect();
        let lists = Lists::open(path, problems)?;
        let part = options.split.as_deref().map(SpeechSplit::from_name).transpose()?;
        let part = part.or(lists.as_ref().map(|_| SpeechSplit::Validation));
        let mut clips = Vec::new();
        for (class, word) in words.iter().enumerate() {
            for name in files_in(&path.join(word), &["wav"]) {
                let of = || match &lists {
                    Some(lists) => lists.split_of(&format!("{word}/{name}")),
                    None => split_of_clip(&name),
                };
                if part.is_none_or(|part| part == of()) {
                    clips.push((class, path.join(word).join(name)));
                }
            }
        }
        let noises = files_in(&path.join(NOISE), &["wav"]);
        let noises: Vec<_> = noises.into_iter().map(|name| path.join(NOISE).join(name)).collect();
        if clips.is_empty() {
            let (path, layout) = (path.display(), Self::LAYOUT);
            return Err(Error::not_found(format!("no clip of that part in {path}; the layout is {layout}")));
        }
        Ok(Self { classes: words.into_iter().collect(), clips, noises, target })
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        write::write(dataset, path, options, problems, progress)
    }
}

/// The clips of the lists.
struct Lists {
    validation: HashSet<String>,
    testing: HashSet<String>,
}

impl Lists {
    /// Reads the lists, if one exists, and reports lines that are not clips.
    fn open(root: &Path, problems: &Problems) -> Result<Option<Self>> {
        let read = |name: &str| -> Result<Option<HashSet<String>>> {
            let path = root.join(name);
            if !path.is_file() {
                return Ok(None);
            }
            let mut clips = HashSet::new();
            for (number, line) in lines(&read_text(&path)?) {
                let clip = line.trim();
                match path_inside(root, clip) {
                    Ok(file) if file.is_file() => drop(clips.insert(clip.to_owned())),
                    Ok(_) => {
                        let message =
                            format!("refers to {clip:.80?}, which is missing; add it or remove the line");
                        problems.report(Problem::at_line(&path, number, message))?;
                    }
                    Err(message) => problems.report(Problem::at_line(&path, number, message))?,
                }
            }
            Ok(Some(clips))
        };
        let (validation, testing) = (read("validation_list.txt")?, read("testing_list.txt")?);
        if validation.is_none() && testing.is_none() {
            return Ok(None);
        }
        Ok(Some(Self { validation: validation.unwrap_or_default(), testing: testing.unwrap_or_default() }))
    }

    fn split_of(&self, clip: &str) -> SpeechSplit {
        match (self.validation.contains(clip), self.testing.contains(clip)) {
            (true, _) => SpeechSplit::Validation,
            (_, true) => SpeechSplit::Testing,
            _ => SpeechSplit::Training,
        }
    }
}

#[cfg(test)]
mod tests;
