//! Writer of audio with words as Speech Commands.

use std::path::Path;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Progress, Result, Value};

use crate::folder::{path_inside, write_file};
use crate::picture_files::write_each;
use crate::speech_commands::SpeechSplit;
use crate::{Problems, WavEncoding, WriteOptions, wav_from_audio};

/// Writes 16-bit WAVE files, and the clips of the part into its list; the lists of other parts are kept.
pub(super) fn write(
    dataset: &dyn DatasetIterator,
    path: &Path,
    options: &WriteOptions,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<()> {
    let part = SpeechSplit::from_name(options.split.as_deref().unwrap_or("training"))?;
    let classes = dataset.classes();
    let mut list = String::new();
    write_each(dataset, problems, progress, |index| {
        list += &format!("{}\n", write_clip(dataset, index, path, &classes, part)?);
        Ok(())
    })?;
    for (list_of, name) in
        [(SpeechSplit::Validation, "validation_list.txt"), (SpeechSplit::Testing, "testing_list.txt")]
    {
        let file = path.join(name);
        if list_of == part {
            write_file(&file, list.as_bytes())?;
        } else if !file.exists() {
            write_file(&file, b"")?;
        }
    }
    Ok(())
}

/// Writes a clip, under the name of its file if that contains the speaker.
fn write_clip(
    dataset: &dyn DatasetIterator,
    index: usize,
    path: &Path,
    classes: &Classes,
    part: SpeechSplit,
) -> Result<String> {
    let sample = dataset.get(index)?;
    let Some(Value::Audio(audio)) = sample.data.first() else {
        return Err(Error::invalid_input("the sample has no audio, which Speech Commands needs"));
    };
    let word = match &sample.target {
        Some(Value::Category(category)) => {
            let named = category.description.clone().or_else(|| classes.name(category.class).cloned());
            named.map_or_else(|| category.class.to_string(), |word| word.to_string())
        }
        Some(Value::SpeechCommand(command)) => {
            classes.label(&command.command).map_or_else(|| command.command.to_string(), str::to_owned)
        }
        _ => {
            return Err(Error::invalid_input(
                "the sample has no word; Speech Commands needs a Category or SpeechCommand",
            ));
        }
    };
    let file = dataset.path(index).and_then(|path| Some(path.file_name()?.to_str()?.to_owned()));
    let file = file.filter(|name| name.contains("_nohash_") && name.ends_with(".wav"));
    let file = file.unwrap_or_else(|| format!("{part:?}{index:08}_nohash_0.wav").to_lowercase());
    let name = format!("{word}/{file}");
    let to = path_inside(path, &name).map_err(Error::invalid_input)?;
    write_file(&to, &wav_from_audio(audio, WavEncoding::Pcm16)?)?;
    Ok(name)
}
