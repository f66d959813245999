//! `opendr models`: lists the models of the zoo.

use clap::{Arg, ArgAction, ArgMatches, Command};
use opendr::model::Licence;
use opendr::zoo::{Item, ItemKind, Zoo, ZooOptions};
use opendr::{Error, Result, Task};
use serde::Serialize;

use crate::exit::Outcome;
use crate::stdout;

/// Maximum width of a cell in characters; longer text is cut, except with `--json`.
const WIDEST: usize = 24;
const COLUMNS: usize = 10;

pub fn grammar() -> Command {
    let switch = |name: &'static str, help: &'static str| {
        Arg::new(name).long(name).action(ArgAction::SetTrue).help(help)
    };
    Command::new("models")
        .about("List the models with task, size, licence and source")
        .arg(Arg::new("task").long("task").value_name("TASK").help("List only models for this task"))
        .arg(switch("commercial", "List only models whose licences allow commercial use"))
        .arg(switch("cached", "List only models in the cache"))
        .arg(switch("json", "Print a JSON array"))
        .after_help("Examples:\n  opendr models --task face_detection\n  opendr models --commercial --json")
}

#[derive(Serialize)]
struct Row<'a> {
    model: String,
    default: bool,
    task: Option<Task>,
    description: &'a str,
    /// Size of the model's files in bytes.
    bytes: u64,
    /// Size of the download in bytes: that of the package which contains the files, if there is one.
    download_bytes: u64,
    licence: &'a Licence,
    source: String,
    cached: bool,
    fps: Option<f64>,
    real_time_factor: Option<f64>,
    p50_ms: Option<f64>,
    peak_mb: Option<f64>,
    measured_on: Option<&'a str>,
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let task = matches.get_one::<String>("task").map(|name| name.parse::<Task>()).transpose()?;
    let zoo = Zoo::new(ZooOptions::from_env()?)?;
    // Cards of learners that this build does not contain are omitted.
    let learners: Vec<_> = opendr::registry().entries().iter().map(|entry| entry.spec.name).collect();
    let models = zoo.items().filter(|item| item.card.kind == ItemKind::Model);
    let models = models.filter(|item| learners.contains(&item.card.learner.as_str()));
    let rows: Vec<Row<'_>> = models
        .map(|item| row(&zoo, item))
        .filter(|row| task.is_none() || row.task == task)
        .filter(|row| !matches.get_flag("commercial") || row.licence.commercial == Some(true))
        .filter(|row| !matches.get_flag("cached") || row.cached)
        .collect();
    if matches.get_flag("json") {
        let json = serde_json::to_string_pretty(&rows)
            .map_err(|error| Error::internal("the list cannot be written as JSON").with_source(error))?;
        stdout::print(json)?;
    } else {
        stdout::print(table(&rows))?;
    }
    Ok(Outcome::Done)
}

fn row<'a>(zoo: &Zoo, item: Item<'a>) -> Row<'a> {
    let (card, variant) = (item.card, item.variant);
    let speed = variant.speed.as_ref();
    Row {
        model: item.to_string(),
        default: variant.default,
        task: card.task,
        description: if variant.description.is_empty() { &card.description } else { &variant.description },
        bytes: variant.size(),
        download_bytes: item.download_size(),
        licence: &variant.licence,
        source: item.public_source().map(ToString::to_string).unwrap_or_default(),
        cached: zoo.cached(&item.to_string()).is_some(),
        fps: speed.and_then(|speed| speed.fps),
        real_time_factor: speed.and_then(|speed| speed.real_time_factor),
        p50_ms: speed.and_then(|speed| speed.p50_ms),
        peak_mb: speed.map(|speed| speed.peak_mb),
        measured_on: speed.map(|speed| speed.measured_on.as_str()),
    }
}

fn table(rows: &[Row<'_>]) -> String {
    let head = ["model", "task", "MB", "fps", "peak MB", "code", "weights", "commercial", "cached", "source"]
        .map(str::to_owned);
    let lines: Vec<[String; COLUMNS]> = std::iter::once(head).chain(rows.iter().map(cells)).collect();
    let width = |column: usize| lines.iter().map(|cells| cells[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; COLUMNS] = std::array::from_fn(width);
    let mut text = String::new();
    for cells in &lines {
        let padded: Vec<_> =
            cells.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        text += padded.join("  ").trim_end();
        text += "\n";
    }
    text + "* default variant"
}

fn cells(row: &Row<'_>) -> [String; COLUMNS] {
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.0}"));
    [
        format!("{}{}", row.model, if row.default { "*" } else { "" }),
        row.task.map_or("", Task::name).to_owned(),
        format!("{:.1}", row.bytes as f64 / 1e6),
        number(row.fps),
        number(row.peak_mb),
        cut(&row.licence.code),
        cut(&row.licence.weights),
        row.licence.commercial.map_or("unknown", |allowed| if allowed { "yes" } else { "no" }).to_owned(),
        if row.cached { "yes" } else { "no" }.to_owned(),
        row.source.split_whitespace().take(2).collect::<Vec<_>>().join(" "),
    ]
}

fn cut(text: &str) -> String {
    if text.chars().count() <= WIDEST {
        return text.to_owned();
    }
    text.chars().take(WIDEST - 1).collect::<String>() + "…"
}
