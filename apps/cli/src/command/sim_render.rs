//! `opendr sim render`: renders a labelled data set of an embedded world.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::data_generation::{GeneratedWorld, GenerationOptions, generate};
use opendr::params::{Param as _, ParamValue};
use opendr::{Progress as _, Result, inference};

use crate::exit::Outcome;
use crate::progress_bar::{ProgressBar, interrupted};
use crate::{dataset_flags, loading, stdout};

const EXAMPLES: &str = "\
Examples:
  opendr sim render persons rendered/                                 1,000 images with boxes and masks, as COCO
  opendr sim render persons rendered/ --to yolo --frames 200 --as val
  opendr sim render person_keypoints rendered/ --geometry             with depth, normals and camera poses
  opendr sim render faces heads/ --size 112x112 --frames 2600         a folder for each person
  opendr sim render street scans/                                     lidar scans with 3D boxes, as KITTI
  opendr fit single_shot_detector rendered/                           train on them";

pub fn grammar() -> Command {
    let number = |name: &'static str| Arg::new(name).long(name).value_name("N");
    Command::new("render")
        .about("Render a labelled data set of an embedded world")
        .args([
            Arg::new("world")
                .required(true)
                .value_parser(PossibleValuesParser::new(GeneratedWorld::CHOICES))
                .value_name("WORLD")
                .help("persons and person_keypoints (boxes, masks, key points), faces, objects (views by class), street (lidar)"),
            Arg::new("output")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .value_name("OUTPUT")
                .help("Folder to write into"),
            number("frames")
                .default_value("1000")
                .value_parser(value_parser!(u64).range(1..=10_000_000))
                .help("Number of samples"),
            Arg::new("size")
                .long("size")
                .default_value("640x480")
                .value_parser(size)
                .value_name("WIDTHxHEIGHT")
                .help("Size of images in pixels; faces and objects are squares of the smaller side"),
            number("seed")
                .default_value("0")
                .value_parser(value_parser!(u64))
                .help("Seed; a sample depends on the seed and its index only"),
            Arg::new("to")
                .long("to")
                .value_name("FORMAT")
                .help("Format to write (see \"opendr data formats\") [default: coco, imagenet or kitti]"),
            Arg::new("as").long("as").value_name("NAME").help("Name of the written split: train, val, ..."),
            Arg::new("geometry")
                .long("geometry")
                .action(ArgAction::SetTrue)
                .help("Also write depth (16-bit PNG, millimetres), normals (PNG) and the camera (JSON) of each image"),
            dataset_flags::skip_broken_flag(),
            loading::threads(),
            loading::quiet(),
        ])
        .after_help(EXAMPLES)
}

fn size(text: &str) -> std::result::Result<[usize; 2], String> {
    let sides =
        text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    sides.ok_or_else(|| "give width and height, such as 640x480".to_owned())
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let name = matches.get_one::<String>("world").cloned().unwrap_or_default();
    let world = GeneratedWorld::from_value(&ParamValue::Text(name)).unwrap_or_default();
    let out = matches.get_one::<PathBuf>("output").cloned().unwrap_or_default();
    let (bar, problems) = (ProgressBar::new(matches.get_flag("quiet")), dataset_flags::problems(matches));
    let options = GenerationOptions {
        frames: matches.get_one::<u64>("frames").map_or(1000, |frames| *frames as usize),
        size: matches.get_one("size").copied().unwrap_or([640, 480]),
        seed: matches.get_one("seed").copied().unwrap_or(0),
        format: matches.get_one("to").cloned(),
        split: matches.get_one("as").cloned(),
        geometry: matches.get_flag("geometry"),
        threads: loading::with_threads(matches, inference::default_threads)?,
    };
    let generated = generate(world, &out, &options, &problems, &bar)?;
    dataset_flags::print_problems(&problems)?;
    let end = if interrupted() { " of which those before the interruption were written" } else { "" };
    bar.note(&format!("{} samples as {} in {}{end}", generated.samples, generated.format, out.display()));
    if let Some(sheet) = generated.contact_sheet {
        stdout::print(sheet.display())?;
    }
    Ok(if problems.count() == 0 { Outcome::Done } else { Outcome::SomeFailed })
}
