use opendr_engine::Silent;
use opendr_engine::data::Audio;

use super::*;
use crate::folder::{TemporaryFolder, real_data};
use crate::{WavEncoding, wav_from_audio};

fn clip(level: f32) -> Vec<u8> {
    wav_from_audio(&Audio::new(vec![level, -level], 1, 16_000).unwrap(), WavEncoding::Pcm16).unwrap()
}

fn words() -> TemporaryFolder {
    TemporaryFolder::new()
        .with("yes/a1_nohash_0.wav", clip(0.5))
        .with("yes/b2_nohash_0.wav", clip(0.25))
        .with("no/a1_nohash_0.wav", clip(-0.5))
        .with("_background_noise_/hum.wav", clip(0.125))
}

fn open(folder: &TemporaryFolder, split: Option<&str>) -> Result<SpeechCommands> {
    let options = OpenOptions { split: split.map(str::to_owned), target: None };
    SpeechCommands::open(folder.path(), &options, &Problems::strict())
}

#[test]
fn folders_are_words() {
    let folder = words();
    assert_eq!(SpeechCommands::recognise(folder.path()), Recognition::Certain);
    let words = open(&folder, None).unwrap();
    assert_eq!((words.len(), words.noises().len()), (3, 1));
    assert_eq!(words.classes().iter().collect::<Vec<_>>(), ["no", "yes"]);
    let sample = words.get(2).unwrap();
    assert!(matches!(&sample.data[..], [Value::Audio(audio)] if audio.array().as_slice() == [0.25, -0.25]));
    let Some(Value::Category(category)) = sample.target else { panic!() };
    assert_eq!((category.class, category.description.as_deref()), (1, Some("yes")));
    assert_eq!(words.name(0), "no/a1_nohash_0.wav");
    assert!(words.get(3).is_err());
}

#[test]
fn lists_define_the_parts() {
    let folder = words()
        .with("validation_list.txt", "yes/b2_nohash_0.wav\n")
        .with("testing_list.txt", "no/a1_nohash_0.wav\n");
    for (part, name) in [
        (None, "yes/b2_nohash_0.wav"),
        (Some("validation"), "yes/b2_nohash_0.wav"),
        (Some("test"), "no/a1_nohash_0.wav"),
        (Some("training"), "yes/a1_nohash_0.wav"),
    ] {
        let words = open(&folder, part).unwrap();
        assert_eq!((words.len(), words.name(0).as_str()), (1, name), "{part:?}");
    }
    for (line, wanted) in [
        ("yes/../../x.wav", "testing_list.txt:2: the file name"),
        ("yes/zz_nohash_0.wav", "testing_list.txt:2: refers to \"yes/zz_nohash_0.wav\", which is missing"),
    ] {
        let folder = words()
            .with("validation_list.txt", "yes/b2_nohash_0.wav\n")
            .with("testing_list.txt", format!("no/a1_nohash_0.wav\n{line}\n"));
        assert!(open(&folder, None).unwrap_err().to_string().contains(wanted));
        let problems = Problems::skipping();
        SpeechCommands::open(folder.path(), &OpenOptions::default(), &problems).unwrap();
        assert_eq!(problems.count(), 1);
    }
}

#[test]
fn a_broken_clip_affects_no_others() {
    let folder = words().with("yes/b2_nohash_0.wav", &clip(0.25)[..45]);
    let words = open(&folder, None).unwrap();
    assert!(words.get(1).is_ok());
    assert!(words.get(2).unwrap_err().to_string().contains("b2_nohash_0.wav: byte 36: chunk \"data\""));
    assert!(open(&TemporaryFolder::new(), None).unwrap_err().to_string().contains("the layout is WORD/"));
}

#[test]
fn what_is_written_is_read() {
    let (folder, copy) = (words(), TemporaryFolder::new());
    let words = open(&folder, None).unwrap();
    let options = WriteOptions { split: Some("testing".into()), link: false };
    SpeechCommands::write(&words, copy.path(), &options, &Problems::strict(), &Silent).unwrap();
    let again = open(&copy, Some("testing")).unwrap();
    assert_eq!(again.len(), 3);
    for index in 0..3 {
        assert_eq!(
            (again.get(index).unwrap(), again.name(index)),
            (words.get(index).unwrap(), words.name(index))
        );
    }
}

#[test]
fn real_clips_are_read() {
    let Some(root) = real_data("speech_commands_v0.02_test") else { return };
    let words = SpeechCommands::open(&root, &OpenOptions::default(), &Problems::strict()).unwrap();
    assert_eq!((words.classes().len(), words.len()), (12, 611));
    for index in (0..words.len()).step_by(60) {
        let Value::Audio(audio) = &words.get(index).unwrap().data[0] else { panic!() };
        assert_eq!((audio.sample_rate(), audio.array().shape()[1]), (16_000, 1));
    }
    // The test part of the data set, by the rule of the paper.
    let spoken: Vec<_> =
        (0..words.len()).map(|index| words.name(index)).filter(|name| !name.starts_with('_')).collect();
    let tested =
        spoken.iter().filter(|name| split_of_clip(name.rsplit('/').next().unwrap()) == SpeechSplit::Testing);
    assert_eq!(tested.count(), spoken.len());
}
