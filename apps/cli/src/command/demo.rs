//! `opendr demo`: people in a photograph, from nothing.

use std::path::PathBuf;

use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::learner::Ports;
use opendr::vision::draw::{Style, draw};
use opendr::zoo::ItemKind;
use opendr::{Error, Result, vision};

use crate::exit::Outcome;
use crate::loading;
use crate::progress_bar::Bar;
use crate::record;
use crate::timings::Timings;

/// Where the annotated picture goes when nothing else is said.
const OUT: &str = "opendr-demo.png";

pub fn grammar() -> Command {
    Command::new("demo")
        .about("Find people in a photograph: gets a model and a picture, prints and draws what it sees")
        .arg(
            Arg::new("picture")
                .value_parser(value_parser!(PathBuf))
                .value_name("PICTURE")
                .help("A picture of yours; a public-domain photograph otherwise"),
        )
        .arg(
            Arg::new("out")
                .long("out")
                .short('o')
                .default_value(OUT)
                .value_parser(value_parser!(PathBuf))
                .value_name("FILE")
                .help("Where to write the annotated picture"),
        )
        .args(loading::flags())
        .after_help("Examples:\n  opendr demo\n  opendr demo street.jpg --out seen.png")
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    loading::set_threads(matches);
    println!("runtime: {}", loading::runtime(matches)?);
    let bar = Bar::new(matches.get_flag("quiet"));
    let zoo = loading::zoo(matches)?;
    let marked = |kind: ItemKind| {
        let mut items = zoo.items().filter(|item| item.variant.demo && item.card.kind == kind);
        items.next().ok_or_else(|| Error::internal(format!("no {kind:?} card is marked for the demo")))
    };
    let picture = match matches.get_one::<PathBuf>("picture") {
        Some(path) => path.clone(),
        None => zoo.get(&marked(ItemKind::Sample)?.to_string(), &bar)?,
    };
    let spec = marked(ItemKind::Model)?.to_string();
    let mut learner = loading::load(&spec, loading::entry(&spec)?, matches, &bar)?;
    let mut image = vision::open(&picture)?;
    let (outputs, timings) = Timings::of(|| learner.infer(&Ports::one(&image)))?;
    println!("{}", record::text(&picture.display().to_string(), &outputs, Some(timings)));
    outputs.iter().for_each(|(_, value)| draw(&mut image, value, &Style::default()));
    let out = matches.get_one::<PathBuf>("out").cloned().unwrap_or_else(|| OUT.into());
    vision::save(&image, &out)?;
    println!("annotated picture: {}", out.display());
    Ok(Outcome::Done)
}
