//! `opendr models`: what there is.

use std::io::Write;

use clap::{Arg, ArgAction, ArgMatches, Command};
use opendr::zoo::{Item, ItemKind, Zoo, ZooOptions};
use opendr::{Error, Result, Task};
use serde::Serialize;

use crate::exit::Outcome;

pub fn grammar() -> Command {
    let flag = |name: &'static str, help: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).help(help);
    Command::new("models")
        .about("List the models with task, size, licence and source")
        .arg(Arg::new("task").long("task").value_name("TASK").help("Only models for this task"))
        .arg(flag("commercial", "Only models whose licences allow commercial use"))
        .arg(flag("cached", "Only models that are on this machine"))
        .arg(flag("json", "Print a JSON array"))
        .after_help("Examples:\n  opendr models --task face_detection\n  opendr models --commercial --json")
}

#[derive(Serialize)]
struct Row {
    model: String,
    default: bool,
    task: Option<Task>,
    description: String,
    megabytes: f64,
    licence_code: String,
    licence_weights: String,
    licence_data: String,
    commercial: Option<bool>,
    source: String,
    cached: bool,
    fps: Option<f64>,
    peak_mb: Option<f64>,
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let task = matches.get_one::<String>("task").map(|name| name.parse::<Task>()).transpose()?;
    let zoo = Zoo::new(ZooOptions::from_env()?)?;
    let models = zoo.items().filter(|item| item.card.kind == ItemKind::Model);
    let rows: Vec<Row> = models
        .map(|item| row(&zoo, &item))
        .filter(|row| task.is_none() || row.task == task)
        .filter(|row| !matches.get_flag("commercial") || row.commercial == Some(true))
        .filter(|row| !matches.get_flag("cached") || row.cached)
        .collect();
    let text = if matches.get_flag("json") {
        serde_json::to_string_pretty(&rows).map_err(|error| Error::internal("no JSON").with_source(error))? + "\n"
    } else {
        table(&rows)
    };
    let written = std::io::stdout().write_all(text.as_bytes());
    written.map_err(|error| Error::io("writing to standard output").with_source(error))?;
    Ok(Outcome::Done)
}

fn row(zoo: &Zoo, item: &Item<'_>) -> Row {
    let (card, variant) = (item.card, item.variant);
    Row {
        model: item.to_string(),
        default: variant.default,
        task: card.task,
        description: if variant.description.is_empty() { &card.description } else { &variant.description }.clone(),
        megabytes: variant.size() as f64 / 1e6,
        licence_code: variant.licence.code.clone(),
        licence_weights: variant.licence.weights.clone(),
        licence_data: variant.licence.data.clone(),
        commercial: variant.licence.commercial,
        source: item.public_source().map(ToString::to_string).unwrap_or_default(),
        cached: zoo.cached(&item.to_string()).is_some(),
        fps: variant.speed.as_ref().map(|speed| speed.fps),
        peak_mb: variant.speed.as_ref().map(|speed| speed.peak_mb),
    }
}

fn table(rows: &[Row]) -> String {
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.0}"));
    let head = ["model", "task", "MB", "fps", "peak MB", "code", "weights", "commercial", "cached", "source"];
    let mut cells = vec![head.map(str::to_owned)];
    cells.extend(rows.iter().map(|row| {
        let commercial = row.commercial.map_or("unknown", |yes| if yes { "yes" } else { "no" });
        [
            format!("{}{}", row.model, if row.default { "*" } else { "" }),
            row.task.map_or("", Task::name).to_owned(),
            format!("{:.1}", row.megabytes),
            number(row.fps),
            number(row.peak_mb),
            row.licence_code.clone(),
            row.licence_weights.clone(),
            commercial.to_owned(),
            if row.cached { "yes" } else { "no" }.to_owned(),
            row.source.clone(),
        ]
    }));
    let widths: [usize; 10] =
        std::array::from_fn(|column| cells.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    let line = |row: &[String; 10]| {
        let padded = row.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}"));
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    let mut text: String = cells.iter().map(line).collect();
    text += "* is taken when no variant is named\n";
    text
}
