//! The generated tables of the models in docs/models.md and README.md, and the cards that other tables take accuracies from.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use serde::Deserialize;

use crate::learner_table::{Learner, Training};
use crate::shell::{Result, root};

/// Metrics of which a smaller number is better.
const LOWER_IS_BETTER: [&str; 3] = ["bad_2", "nme", "wer"];

/// What the tables show of `models/*.toml`.
#[derive(Debug, Deserialize)]
pub struct Card {
    #[serde(default)]
    kind: String,
    /// Registry name of the learner.
    pub learner: String,
    #[serde(default)]
    task: String,
    #[serde(default)]
    /// Its variants; none where there are no pretrained weights.
    pub variants: Vec<Variant>,
}

/// One model of a card.
#[derive(Debug, Deserialize)]
pub struct Variant {
    /// Name after the slash.
    pub name: String,
    #[serde(default)]
    default: bool,
    /// Data that the weights know; `None` for an algorithm without weights.
    #[serde(default)]
    pub grade: Option<String>,
    #[serde(default)]
    headline: Option<Headline>,
    #[serde(default)]
    metrics: toml::Table,
    /// What it is, in a sentence.
    #[serde(default)]
    pub description: String,
    /// Its speed, where it was measured.
    #[serde(default)]
    pub speed: Option<Speed>,
    #[serde(default)]
    files: Vec<File>,
    /// Models of the zoo that it contains: name of the part, and `LEARNER/VARIANT`.
    #[serde(default)]
    pub parts: BTreeMap<String, String>,
    #[serde(default)]
    import: Imports,
    /// Its licences.
    pub licence: Licence,
}

/// The conversions of a variant's files: a table, or a list of tables.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Imports {
    One(Import),
    Several(Vec<Import>),
}

impl Default for Imports {
    fn default() -> Self {
        Self::Several(Vec::new())
    }
}

#[derive(Debug, Deserialize)]
struct Import {
    format: String,
}

#[derive(Debug, Deserialize)]
struct Headline {
    data: String,
    metric: String,
    interval: Option<(f64, f64)>,
    #[serde(default)]
    of: Option<String>,
}

/// Speed and memory of a variant.
#[derive(Debug, Deserialize)]
pub struct Speed {
    /// Inputs per second.
    pub fps: Option<f64>,
    /// Time over the duration of the audio.
    pub real_time_factor: Option<f64>,
    /// Median latency in milliseconds.
    pub p50_ms: Option<f64>,
    /// Peak memory of the process in MB.
    pub peak_mb: f64,
    /// The machine.
    #[serde(default)]
    pub on: String,
}

#[derive(Debug, Deserialize)]
struct File {
    size: u64,
}

/// Licences of a variant.
#[derive(Debug, Deserialize)]
pub struct Licence {
    /// That of its code.
    #[serde(default)]
    pub code: String,
    /// That of its weights; empty without weights.
    #[serde(default)]
    pub weights: String,
    /// That of the data that it was trained on.
    #[serde(default)]
    pub data: String,
    /// Whether commercial use is permitted, where that is known.
    #[serde(default)]
    pub commercial: Option<bool>,
}

impl Card {
    /// Parses the text of a card.
    pub fn parse(text: &str) -> Result<Self> {
        toml::from_str(text).map_err(|error| error.to_string())
    }

    /// Returns the variant that the learner's name alone means; `None` for a learner without pretrained weights.
    pub fn default_variant(&self) -> Option<&Variant> {
        self.variants.iter().find(|variant| variant.default)
    }
}

/// Accuracy of a variant as cells of a table; empty where the card states nothing.
#[derive(Default)]
pub struct AccuracyCells {
    /// Value and metric.
    pub value: String,
    /// 95 % confidence interval.
    pub interval: String,
    /// Data set and number of samples.
    pub data: String,
}

impl Variant {
    /// Returns whether it has files of its own; else it is a rule, or consists of its parts.
    pub fn has_files(&self) -> bool {
        !self.files.is_empty()
    }

    /// Returns the formats that its files are converted from.
    pub fn formats(&self) -> impl Iterator<Item = &str> {
        let imports = match &self.import {
            Imports::One(import) => std::slice::from_ref(import),
            Imports::Several(imports) => imports,
        };
        imports.iter().map(|import| import.format.as_str())
    }

    /// Returns its grade as a cell of a table.
    pub fn grade_cell(&self) -> &str {
        self.grade.as_deref().unwrap_or("no weights")
    }

    /// Returns its accuracy as the headline names it.
    pub fn accuracy_cells(&self) -> AccuracyCells {
        let Some((headline, value)) = self.accuracy() else { return AccuracyCells::default() };
        let of = headline.of.as_deref().unwrap_or("samples");
        let count = self.metrics[&headline.data].get(of).and_then(toml::Value::as_integer);
        let count = count.map(|count| format!(", {count} {of}"));
        let interval = headline.interval.map(|(low, high)| format!("{} to {}", rounded(low), rounded(high)));
        AccuracyCells {
            value: format!("{} {}", rounded(value), headline.metric),
            interval: interval.unwrap_or_default(),
            data: format!("{}{}", headline.data, count.unwrap_or_default()),
        }
    }

    /// Returns the value of the headline.
    fn accuracy(&self) -> Option<(&Headline, f64)> {
        let headline = self.headline.as_ref()?;
        let value = self.metrics.get(&headline.data)?.get(&headline.metric)?;
        Some((headline, value.as_float().or_else(|| value.as_integer().map(|value| value as f64))?))
    }
}

/// The cards of models, by task.
pub struct Models(BTreeMap<String, Vec<Card>>);

impl Models {
    pub fn read() -> Result<Self> {
        let folder = root().join("models");
        let files = fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let paths = files.flatten().map(|file| file.path());
        let paths: BTreeSet<_> =
            paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
        let cards = paths.into_iter().map(|path| {
            let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            Card::parse(&text).map_err(|error| format!("{}: {error}", path.display()))
        });
        Ok(Self::of(cards.collect::<Result<Vec<_>>>()?))
    }

    /// Sorts cards by task, without those of samples.
    pub fn of(cards: Vec<Card>) -> Self {
        let mut tasks = BTreeMap::<String, Vec<Card>>::new();
        for card in cards.into_iter().filter(|card| card.kind != "sample") {
            tasks.entry(card.task.clone()).or_default().push(card);
        }
        Self(tasks)
    }

    /// Returns the card of a learner.
    pub fn card(&self, learner: &str) -> Option<&Card> {
        self.0.values().flatten().find(|card| card.learner == learner)
    }

    /// Returns the tables of docs/models.md: one per task, with every variant of the learners in `registry`.
    pub fn tables(&self, registry: &[Learner]) -> String {
        let runs_yours = |name: &str| {
            let learner = registry.iter().find(|learner| learner.name == name);
            learner.is_some_and(|learner| learner.takes_networks && learner.trains == Training::Nothing)
        };
        let mut text = String::new();
        for (task, cards) in &self.0 {
            text += &format!(
                "\n## {task}\n\n| model | grade | accuracy | 95 % interval | measured on | best on the same samples | fps | peak MB | MB | licence of the weights |\n\
                 |---|---|---|---|---|---|---|---|---|---|\n"
            );
            for card in cards {
                if card.variants.is_empty() {
                    let name = &card.learner;
                    let instead = if runs_yours(name) {
                        "your network: `opendr import`"
                    } else {
                        "no weights: `opendr fit`"
                    };
                    text += &format!("| `{name}` | {instead} | | | | | | | | |\n");
                }
                for variant in &card.variants {
                    text += &self.row(card, variant);
                }
            }
        }
        text + "\n"
    }

    fn row(&self, card: &Card, variant: &Variant) -> String {
        let name =
            format!("`{}/{}`{}", card.learner, variant.name, if variant.default { " (default)" } else { "" });
        let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.0}"));
        let bytes: u64 = variant.files.iter().map(|file| file.size).sum();
        let AccuracyCells { value, interval, data } = variant.accuracy_cells();
        let commercial = match variant.licence.commercial {
            Some(true) => "",
            Some(false) => "; not commercial",
            None => "; commercial use unknown",
        };
        format!(
            "| {name} | {} | {value} | {interval} | {data} | {} | {} | {} | {:.1} | {}{commercial} |\n",
            variant.grade_cell(),
            self.best(variant).unwrap_or_default(),
            number(variant.speed.as_ref().and_then(|speed| speed.fps)),
            number(variant.speed.as_ref().map(|speed| speed.peak_mb)),
            bytes as f64 / 1e6,
            variant.licence.weights.replace('|', "\\|"),
        )
    }

    /// Returns the model that is best by the variant's headline, among those with a better value.
    fn best(&self, variant: &Variant) -> Option<String> {
        let (headline, own) = variant.accuracy()?;
        let sign = if LOWER_IS_BETTER.contains(&headline.metric.as_str()) { -1.0 } else { 1.0 };
        let all =
            self.0.values().flatten().flat_map(|card| card.variants.iter().map(move |other| (card, other)));
        let values = all.filter_map(|(card, other)| {
            let value = other.metrics.get(&headline.data)?.get(&headline.metric)?.as_float()?;
            (sign * value > sign * own).then(|| (sign * value, format!("{}/{}", card.learner, other.name)))
        });
        let (value, name) = values.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
        Some(format!("`{name}` {}", rounded(sign * value)))
    }

    /// Returns the table of README.md: a task per row, with the default variants by grade.
    pub fn overview(&self) -> String {
        let mut text = "\n| task | real | transfer | demonstration | algorithms without weights |\n|---|---|---|---|---|\n".to_owned();
        for (task, cards) in &self.0 {
            let defaults = cards.iter().flat_map(|card| {
                card.variants.iter().filter(|variant| variant.default).map(move |variant| (card, variant))
            });
            let defaults: Vec<_> = defaults.collect();
            let of_grade = |grade: Option<&str>| {
                let cells = defaults.iter().filter(|(_, variant)| variant.grade.as_deref() == grade);
                let cells = cells.map(|(card, variant)| match variant.accuracy() {
                    Some((headline, value)) => {
                        format!("`{}` {} {}", card.learner, rounded(value), headline.metric)
                    }
                    None => format!("`{}`", card.learner),
                });
                cells.collect::<Vec<_>>().join(", ")
            };
            if !defaults.is_empty() {
                let grades = [Some("real"), Some("transfer"), Some("demonstration"), None];
                let cells = grades.map(of_grade);
                text += &format!("| {} | {} |\n", task.replace('_', " "), cells.join(" | "));
            }
        }
        text + "\n"
    }

    /// Returns the names of the data sets of the headlines.
    #[cfg(test)]
    fn data(&self) -> BTreeSet<&str> {
        let variants = self.0.values().flatten().flat_map(|card| &card.variants);
        variants.filter_map(|variant| Some(variant.headline.as_ref()?.data.as_str())).collect()
    }
}

/// Returns a number with at most three decimals.
fn rounded(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inputs;

    #[test]
    fn every_data_set_is_described() {
        let page = inputs::text("docs/models.md").unwrap();
        for data in Models::read().unwrap().data() {
            assert!(page.contains(&format!("\n| `{data}` | ")), "docs/models.md does not describe {data:?}");
        }
    }

    #[test]
    fn the_best_model_is_the_best_by_the_same_metric() {
        let card = |learner: &str, metric: &str, value: f64| {
            Card::parse(&format!(
                "learner = \"{learner}\"\ntask = \"t\"\n[[variants]]\nname = \"a\"\ndefault = true\ngrade = \"real\"\nlicence = {{}}\n\
                 headline = {{ data = \"d\", metric = \"{metric}\" }}\nmetrics.d = {{ {metric} = {value:?}, samples = 7 }}\n"
            ))
            .unwrap()
        };
        let cards = vec![
            card("x", "map", 0.5),
            card("y", "map", 0.75),
            card("z", "wer", 0.25),
            card("w", "wer", 0.5),
        ];
        let models = Models::of(cards);
        let rows = models.tables(&[]);
        let row = |name: &str| rows.lines().find(|row| row.starts_with(&format!("| `{name}/a`"))).unwrap();
        assert!(row("x").contains("| 0.5 map |  | d, 7 samples | `y/a` 0.75 |"), "{rows}");
        assert!(row("w").contains("| `z/a` 0.25 |") && row("y").contains("samples |  |"), "{rows}");
        assert!(row("z").contains("samples |  |"), "{rows}");
        assert!(
            models
                .overview()
                .contains("| t | `x` 0.5 map, `y` 0.75 map, `z` 0.25 wer, `w` 0.5 wer |  |  |  |")
        );
    }
}
