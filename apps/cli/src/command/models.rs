//! `opendr models`: lists the models of the zoo.

use clap::{Arg, ArgAction, ArgMatches, Command};
use opendr::zoo::{Grade, ModelFilter, ModelSummary, Zoo, ZooOptions};
use opendr::{Error, Result, Task};

use crate::exit::Outcome;
use crate::stdout;

/// Maximum width of a cell in characters; longer text is cut, except with `--json`.
const WIDEST: usize = 24;
const COLUMNS: usize = 11;

pub fn grammar() -> Command {
    let switch = |name: &'static str, help: &'static str| {
        Arg::new(name).long(name).action(ArgAction::SetTrue).help(help)
    };
    Command::new("models")
        .about("List the models with task, grade, accuracy, speed, licence and source")
        .arg(Arg::new("task").long("task").value_name("TASK").help("List only models for this task"))
        .arg(Arg::new("grade").long("grade").value_name("GRADE").value_parser(Grade::ALL.map(Grade::name)).help(
            "List only models of this grade or a better one: real (trained and measured on real data), transfer \
             (measured on real data, trained on others), demonstration",
        ))
        .arg(switch("commercial", "List only models whose licences allow commercial use"))
        .arg(switch("cached", "List only models in the cache"))
        .arg(switch("json", "Print a JSON array"))
        .after_help(
            "Examples:\n  opendr models --task face_detection\n  opendr models --grade real --commercial\n  opendr models --json",
        )
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let zoo = Zoo::new(ZooOptions::from_env()?)?;
    let filter = ModelFilter {
        task: matches.get_one::<String>("task").map(|name| name.parse()).transpose()?,
        grade: matches.get_one::<String>("grade").map(|name| name.parse()).transpose()?,
        commercial: matches.get_flag("commercial"),
        cached: matches.get_flag("cached"),
    };
    let models = opendr::models(&zoo, &filter);
    if matches.get_flag("json") {
        let json = serde_json::to_string_pretty(&models)
            .map_err(|error| Error::internal("the list cannot be written as JSON").with_source(error))?;
        stdout::print(json)?;
    } else {
        stdout::print(table(&models))?;
    }
    Ok(Outcome::Done)
}

fn table(models: &[ModelSummary<'_>]) -> String {
    let head = [
        "model",
        "task",
        "grade",
        "accuracy",
        "MB",
        "fps",
        "peak MB",
        "licence",
        "commercial",
        "cached",
        "source",
    ]
    .map(str::to_owned);
    let lines: Vec<[String; COLUMNS]> = std::iter::once(head).chain(models.iter().map(cells)).collect();
    let width = |column: usize| lines.iter().map(|cells| cells[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; COLUMNS] = std::array::from_fn(width);
    let mut text = String::new();
    for cells in &lines {
        let padded: Vec<_> =
            cells.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        text += padded.join("  ").trim_end();
        text += "\n";
    }
    text + "* default variant; licence: that of the weights; docs/models.md has data and confidence intervals"
}

fn cells(row: &ModelSummary<'_>) -> [String; COLUMNS] {
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.0}"));
    [
        format!("{}{}", row.model, if row.default { "*" } else { "" }),
        row.task.map_or("", Task::name).to_owned(),
        row.grade.map_or("-", Grade::name).to_owned(),
        row.accuracy.as_ref().map_or_else(
            || "-".to_owned(),
            |accuracy| cut(&format!("{:.3} {}", accuracy.value, accuracy.metric)),
        ),
        format!("{:.1}", row.bytes as f64 / 1e6),
        number(row.fps),
        number(row.peak_mb),
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
