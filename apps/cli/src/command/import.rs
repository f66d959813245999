//! `opendr import`: converts model files of other formats into a container.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::learner::Entry;
use opendr::model::Manifest;
use opendr::params::ParamMap;
use opendr::zoo::{ImportOptions, import_files};
use opendr::{Result, ResultExt};

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::{learner_flags, loading, stdout};

const EXAMPLES: &str = "\
Examples:
  opendr import whisper model.safetensors tokenizer.json --out small     saved by transformers
  opendr import whisper encoder_model.onnx decoder_model.onnx tokenizer.json --out small   by Optimum
  opendr import whisper model.bin tokenizer.json --out small             by CTranslate2
  opendr import detector yolo.onnx --out mine                             a detector of another tool, recognised
  opendr import face_recognition arcface.onnx --colour rgb --levels -1_1 --out mine   with the detector of the zoo's model
  opendr import zero_shot_classifier vision.onnx --part text=text.onnx --part tokenizer=tokenizer.json --out clip
  opendr import LEARNER detector.tflite --classes names.txt --out mine
  opendr import LEARNER net.param net.bin --out mine                     from ncnn
  opendr infer whisper talk.wav --model small                          run the result";

pub fn grammar() -> Command {
    Command::new("import")
        .about("Convert an ONNX, TensorFlow Lite, TensorFlow.js or ncnn model, or Whisper weights, into a container")
        .arg(loading::learner().value_name("LEARNER").help("Learner that runs the model (see \"opendr models\")"))
        .arg(
            Arg::new("files")
                .required(true)
                .num_args(1..)
                .value_parser(value_parser!(PathBuf))
                .value_name("FILE")
                .help("Model file first, then its further files: weights, a tokeniser"),
        )
        .arg(
            Arg::new("part")
                .long("part")
                .action(ArgAction::Append)
                .value_parser(named_file)
                .value_name("NAME=FILE")
                .help("Further file that the learner knows by a name, such as text=text.onnx; may be repeated"),
        )
        .arg(
            Arg::new("out")
                .long("out").alias("output")
                .short('o')
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .value_name("DIR")
                .help("Container to write: a folder, or NAME.zip"),
        )
        .arg(
            Arg::new("classes")
                .long("classes")
                .value_parser(value_parser!(PathBuf))
                .value_name("FILE")
                .help("File of class names, one per line, in the order of the network's output"),
        )
        .arg(
            Arg::new("image-size")
                .long("image-size")
                .value_parser(image_size)
                .value_name("HEIGHTxWIDTH")
                .help("Input size of images, where the model has a dynamic shape"),
        )
        .arg(
            Arg::new("outputs")
                .long("outputs")
                .value_delimiter(',')
                .value_name("NAME,...")
                .help("Outputs to keep [default: all]"),
        )
        .args([loading::device_flag(), loading::offline(), loading::quiet()])
        .after_help(EXAMPLES)
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let name = matches.get_one::<String>(loading::LEARNER).map_or("", String::as_str);
    let entry = loading::entry(name)?;
    let params = learner_flags::params(entry, matches)?;
    let files: Vec<&PathBuf> = matches.get_many("files").into_iter().flatten().collect();
    let output = matches.get_one::<PathBuf>("out").cloned().unwrap_or_default();
    let options = ImportOptions {
        image_size: matches.get_one::<(usize, usize)>("image-size").copied(),
        outputs: matches.get_many("outputs").into_iter().flatten().cloned().collect(),
    };
    let mut manifest = Manifest::new(entry.spec.name, "");
    manifest.task = Some(entry.spec.task);
    manifest.params = params.clone();
    if let Some(path) = matches.get_one::<PathBuf>("classes") {
        let text = std::fs::read_to_string(path).context(|| path.display().to_string())?;
        manifest.classes = text.lines().map(str::trim).filter(|name| !name.is_empty()).collect();
    }
    let device = loading::device(matches)?;
    let mut models = Vec::new();
    let progress = ProgressBar::new(matches.get_flag("quiet"));
    for (name, source, model) in loading::zoo(matches)?.default_parts(entry.spec.name, &progress)? {
        if !matches.get_flag("quiet") {
            eprintln!("{name}: {source}, as in the default model of {}", entry.spec.name);
        }
        models.push((name, model));
    }
    let mut recognised = Vec::new();
    let parts: Vec<(String, PathBuf)> = matches.get_many("part").into_iter().flatten().cloned().collect();
    import_files(manifest, &files, &parts, &models, &options, &output, |model| {
        let loaded = entry.make(&params, device).and_then(|mut learner| {
            learner.load(model.path())?;
            recognised = settled_on_load(&learner.params(), &params, entry);
            Ok(())
        });
        loaded.context(|| format!("{} cannot load this model", entry.spec.name))
    })?;
    if !matches.get_flag("quiet") && !recognised.is_empty() {
        eprintln!("recognised: {}", recognised.join(", "));
    }
    stdout::print(output.display())?;
    Ok(Outcome::Done)
}

/// Returns the parameters that have another value than the default since the model was loaded and that the user did not set.
fn settled_on_load(loaded: &ParamMap, given: &ParamMap, entry: &Entry) -> Vec<String> {
    let fields = entry.params.iter().filter(|field| field.value_in(given).is_none());
    let settled = fields.filter_map(|field| Some((field, field.value_in(loaded)?)));
    settled
        .filter(|(field, value)| field.default.value() != **value)
        .map(|(field, value)| format!("{} {value}", field.name.replace('_', "-")))
        .collect()
}

fn named_file(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((name, file)) if !name.is_empty() && !file.is_empty() => Ok((name.to_owned(), file.into())),
        _ => Err(format!("{text:?} is no part; write NAME=FILE, such as text=text.onnx")),
    }
}

fn image_size(text: &str) -> Result<(usize, usize), String> {
    let size =
        text.split_once('x').and_then(|(height, width)| Some((height.parse().ok()?, width.parse().ok()?)));
    size.filter(|(height, width)| *height > 0 && *width > 0)
        .ok_or_else(|| format!("{text:?} is not a size; write HEIGHTxWIDTH, such as 256x320"))
}
