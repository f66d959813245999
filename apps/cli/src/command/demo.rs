//! `opendr demo`: detects people in a photograph, with a downloaded model and image.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::inference::describe;
use opendr::learner::Ports;
use opendr::params::ParamMap;
use opendr::vision::draw::{Style, draw};
use opendr::zoo::{ItemKind, Zoo};
use opendr::{Error, Result, vision};

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::timings::Timings;
use crate::{loading, report, stdout};

pub fn grammar() -> Command {
    Command::new("demo")
        .about(
            "Detect people in a photograph: downloads a model and an image, prints and draws the predictions",
        )
        .arg(
            Arg::new("image")
                .value_parser(value_parser!(PathBuf))
                .value_name("IMAGE")
                .help("Image to process [default: a public-domain photograph]"),
        )
        .arg(
            Arg::new("out")
                .long("out")
                .short('o')
                .default_value("opendr-demo.png")
                .value_parser(value_parser!(PathBuf))
                .value_name("FILE")
                .help("Image file to write the annotated image to"),
        )
        .args(loading::flags())
        .after_help("Examples:\n  opendr demo\n  opendr demo street.jpg --out boxes.png")
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    stdout::print(format_args!("runtime: {}", describe(loading::device(matches)?)?))?;
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let zoo = loading::zoo(matches)?;
    let spec = demo_item(&zoo, ItemKind::Model)?;
    let path = match matches.get_one::<PathBuf>("image") {
        Some(path) => path.clone(),
        None => zoo.get(&demo_item(&zoo, ItemKind::Sample)?, &bar)?,
    };
    let mut image = vision::open(&path)?;
    let mut learner = loading::load(&spec, &ParamMap::new(), matches, &bar)?;
    let (outputs, timings) = Timings::of(|| learner.infer(&Ports::one(&image)))?;
    let title = format!("{spec} on {}", path.display());
    stdout::print(report::text(&title, &outputs, Some(timings)))?;
    outputs.iter().for_each(|(_, value)| draw(&mut image, value, &Style::default()));
    let out = matches.get_one::<PathBuf>("out").map_or(Path::new(""), PathBuf::as_path);
    vision::save(&image, out)?;
    stdout::print(format_args!("annotated image: {}", out.display()))?;
    Ok(Outcome::Done)
}

/// Returns the item that its card selects for the demonstration.
fn demo_item(zoo: &Zoo, kind: ItemKind) -> Result<String> {
    let mut items = zoo.items().filter(|item| item.variant.demo && item.card.kind == kind);
    let item = items.next().map(|item| item.to_string());
    item.ok_or_else(|| Error::internal(format!("no {kind:?} card sets `demo`")))
}
