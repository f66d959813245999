//! `cargo xtask train NAME`: makes the weights of `models/training/NAME.toml`, measures them and writes them with the card's metrics.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::card::{edited_card, with_line};
use crate::shell::{Result, command, output, root, step, target};

/// How weights are made and measured.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Recipe {
    /// `LEARNER/VARIANT` of the card.
    model: String,
    /// Data sets, with source and licence.
    data: Vec<Source>,
    /// Programs that prepare the data; see [`Places::filled`].
    #[serde(default)]
    prepare: Vec<Vec<String>>,
    /// Steps of `opendr` that make the weights.
    steps: Vec<Vec<String>>,
    /// The container that the steps make.
    container: String,
    /// End of the file in the package of models for each file of the container, after `LEARNER/VARIANT`.
    #[serde(default = "single_network")]
    files: BTreeMap<String, String>,
    evaluation: Evaluation,
}

fn single_network() -> BTreeMap<String, String> {
    BTreeMap::from([("model.onnx".to_owned(), ".onnx".to_owned())])
}

impl Recipe {
    /// Returns the files of the container, by name, and those of the package of models.
    fn weights(&self) -> impl Iterator<Item = (&str, PathBuf)> {
        let weights = root().join("models/weights");
        self.files.iter().map(move |(name, end)| (&name[..], weights.join(format!("{}{end}", self.model))))
    }
}

/// A data set of a recipe.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Source {
    /// Path in the folder of OPENDR_TEST_DATA, or in the repository.
    path: String,
    /// `OWNER/NAME@COMMIT` of a public repository on GitHub, of which the path is put into `{out}/sources/OWNER+NAME`.
    repository: Option<String>,
    source: String,
    licence: String,
    /// Which part is trained on, and which measured.
    part: String,
}

/// How the weights are measured, on samples that were not trained on.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Evaluation {
    /// `opendr eval` without `--json`; see [`Places::filled`].
    command: Vec<String>,
    /// Key of the card's metrics.
    data: String,
    /// Metric of the report.
    metric: String,
    /// Its expected value.
    expected: f64,
    /// Allowed difference from it.
    within: f64,
    /// Further metrics that the card has.
    #[serde(default)]
    others: Vec<String>,
}

/// Folders that stand in a recipe as `{data}` (of OPENDR_TEST_DATA) and `{out}`.
struct Places {
    data: PathBuf,
    out: PathBuf,
}

impl Places {
    fn filled(&self, words: &[String]) -> Vec<String> {
        let places = [("{data}", &self.data), ("{out}", &self.out)];
        let fill = |word: &String| {
            places
                .iter()
                .fold(word.clone(), |word, (name, path)| word.replace(name, &path.display().to_string()))
        };
        words.iter().map(fill).collect()
    }
}

/// Makes the weights, measures them, compares the figure with the expected one and writes weights and card. A training that was
/// interrupted goes on.
///
/// With `is_on_gpu`, the program is built with the feature `wgpu`, and trains through Vulkan.
pub fn run(name: &str, is_on_gpu: bool) -> Result<()> {
    let recipe = read(name)?;
    let data = std::env::var_os("OPENDR_TEST_DATA").ok_or("OPENDR_TEST_DATA is not set")?;
    let places = Places { data: PathBuf::from(data).join("data"), out: root().join("runs").join(name) };
    for data in &recipe.data {
        let Source { path, source, licence, part, repository } = data;
        match repository {
            Some(repository) => check_out(repository, path, &places.out)?,
            None if !places.data.join(path).exists() => {
                return Err(format!("{} is missing: {source}", places.data.join(path).display()));
            }
            None => {}
        }
        println!("{path}: {source}; {licence}; {part}");
    }
    let mut build = command("cargo");
    build.args(["build", "--release", "--locked", "--package=opendr-cli", "--features=opendr-cli/training"]);
    if is_on_gpu {
        build.arg("--features=opendr-training/wgpu");
    }
    step("build", &mut build)?;
    for words in &recipe.prepare {
        let words = places.filled(words);
        let [program, arguments @ ..] = words.as_slice() else { return Err("an empty step".to_owned()) };
        step("prepare", command(program).args(arguments))?;
    }
    for words in &recipe.steps {
        let words = places.filled(words);
        let mut opendr = opendr();
        opendr.args(&words);
        if words.first().is_some_and(|verb| verb == "fit") {
            let output = words.iter().skip_while(|word| *word != "--out").nth(1);
            if output.is_some_and(|output| Path::new(output).join("checkpoints").is_dir()) {
                opendr.arg("--resume");
            }
            opendr.args(["--device", if is_on_gpu { "vulkan" } else { "cpu" }]);
        }
        step(words.first().map_or("opendr", String::as_str), &mut opendr)?;
    }
    let container = places.filled(std::slice::from_ref(&recipe.container)).concat();
    let mut eval = opendr();
    eval.args(places.filled(&recipe.evaluation.command)).args(["--json", "--quiet"]);
    let report: Value =
        serde_json::from_str(&output(&mut eval)?).map_err(|error| format!("report: {error}"))?;
    let (metrics, value) = metrics_of(&report, &recipe.evaluation)?;
    let headline = headline_of(&report, &recipe.evaluation);
    println!("{container}: {metrics}");
    let Evaluation { metric, expected, within, .. } = &recipe.evaluation;
    if (value - expected).abs() > *within {
        return Err(format!("{metric} is {value:.4}; expected {expected} within {within}"));
    }
    let mut files = Vec::new();
    for (name, weights) in recipe.weights() {
        let bytes =
            fs::read(Path::new(&container).join(name)).map_err(|error| format!("{container}: {error}"))?;
        fs::write(&weights, &bytes).map_err(|error| format!("{}: {error}", weights.display()))?;
        files.push((name, bytes));
    }
    edited_card(&recipe.model, |card, variant| {
        let card = with_line(card, variant, &format!("metrics.{} = ", recipe.evaluation.data), &metrics)?;
        let card = with_line(&card, variant, "headline = ", &headline)?;
        with_line(&card, variant, "files = ", &files_of(&files))
    })
}

/// Puts a path of `OWNER/NAME@COMMIT` into `sources/OWNER+NAME` of the output folder, from `OWNER+NAME/repo` of the folder in
/// OPENDR_SOURCES, or from GitHub.
fn check_out(repository: &str, path: &str, out: &Path) -> Result<()> {
    let (name, commit) =
        repository.split_once('@').ok_or_else(|| format!("{repository:?} is not OWNER/NAME@COMMIT"))?;
    let flat = name.replace('/', "+");
    let sources = out.join("sources");
    let tree = sources.join(&flat);
    if tree.join(path).exists() {
        return Ok(());
    }
    fs::create_dir_all(&tree).map_err(|error| format!("{}: {error}", tree.display()))?;
    let stored =
        std::env::var_os("OPENDR_SOURCES").map(|folder| PathBuf::from(folder).join(&flat).join("repo"));
    let git_dir =
        stored.filter(|folder| folder.is_dir()).unwrap_or_else(|| sources.join(format!("{flat}.git")));
    if !git_dir.is_dir() {
        let address = format!("https://github.com/{name}");
        let mut clone = command("git");
        clone.args(["clone", "--quiet", "--bare", "--filter=blob:none", &address]).arg(&git_dir);
        step("clone", &mut clone)?;
    }
    let mut git = command("git");
    git.arg("--git-dir").arg(&git_dir).arg("--work-tree").arg(&tree).args(["checkout", commit, "--", path]);
    step("sources", git.env("GIT_INDEX_FILE", sources.join(format!("{flat}.index"))))
}

/// Returns the card's line of files, given with their names.
fn files_of(files: &[(&str, Vec<u8>)]) -> String {
    let entries = files.iter().map(|(name, bytes)| {
        let sha256: String = Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        format!("{{ name = {name:?}, size = {}, sha256 = {sha256:?} }}", bytes.len())
    });
    format!("files = [{}]", entries.collect::<Vec<_>>().join(", "))
}

fn opendr() -> std::process::Command {
    let mut opendr = command(target().join("release/opendr"));
    opendr.env("OPENDR_MODELS", root().join("models/weights"));
    opendr
}

/// Reads `models/training/NAME.toml`.
fn read(name: &str) -> Result<Recipe> {
    let path = root().join("models/training").join(format!("{name}.toml"));
    let text = fs::read_to_string(&path)
        .map_err(|error| format!("{}: {error}; recipes: {}", path.display(), names().join(", ")))?;
    toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))
}

/// Returns the names of the recipes.
fn names() -> Vec<String> {
    let files = fs::read_dir(root().join("models/training")).into_iter().flatten().flatten();
    let paths =
        files.map(|file| file.path()).filter(|path| path.extension().is_some_and(|end| end == "toml"));
    let mut names: Vec<String> =
        paths.filter_map(|path| Some(Path::file_stem(&path)?.to_str()?.to_owned())).collect();
    names.sort();
    names
}

/// Returns the card's line of metrics for a report, and the value of the main one.
fn metrics_of(report: &Value, evaluation: &Evaluation) -> Result<(String, f64)> {
    let number =
        |name: &str| report["scalars"][name].as_f64().ok_or_else(|| format!("the report has no {name}"));
    if report["complete"] != Value::Bool(true) {
        return Err("the report does not cover all samples".to_owned());
    }
    let value = number(&evaluation.metric)?;
    let others = evaluation.others.iter().map(|name| Ok(format!("{name} = {:.4}, ", number(name)?)));
    let others: String = others.collect::<Result<Vec<_>>>()?.concat();
    let (data, metric) = (&evaluation.data, &evaluation.metric);
    let samples = report["counted"].as_u64().ok_or("the report has no number of samples")?;
    Ok((format!("metrics.{data} = {{ {metric} = {value:.4}, {others}samples = {samples} }}"), value))
}

/// Returns the card's line of the headline: the main metric, with the report's confidence interval if it is that of this metric.
fn headline_of(report: &Value, evaluation: &Evaluation) -> String {
    let Evaluation { data, metric, .. } = evaluation;
    let bound = |name: &str| report["interval"][name].as_f64();
    let interval = match (bound("low"), bound("high")) {
        (Some(low), Some(high)) if report["headline"] == metric.as_str() => {
            format!(", interval = [{low:.4}, {high:.4}]")
        }
        _ => String::new(),
    };
    format!("headline = {{ data = {data:?}, metric = {metric:?}{interval} }}")
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn every_recipe_is_of_a_card_with_its_figure() {
        assert!(!names().is_empty());
        for name in names() {
            let recipe = read(&name).unwrap();
            let Recipe { model, evaluation, steps, .. } = &recipe;
            let (learner, variant) = model.split_once('/').unwrap();
            let card = fs::read_to_string(root().join(format!("models/{learner}.toml"))).unwrap();
            let card: toml::Table = toml::from_str(&card).unwrap();
            let variants = card["variants"].as_array().unwrap();
            let variant = variants.iter().find(|entry| entry["name"].as_str() == Some(variant)).unwrap();
            let value = variant["metrics"][&evaluation.data][&evaluation.metric].as_float().unwrap();
            assert!((value - evaluation.expected).abs() <= evaluation.within, "{name}: {value}");
            let files =
                recipe.weights().map(|(name, path)| (name, fs::read(path).unwrap())).collect::<Vec<_>>();
            let files: toml::Table = toml::from_str(&files_of(&files)).unwrap();
            assert_eq!(variant["files"], files["files"], "{name}");
            assert!(steps.iter().any(|words| words[0] == "fit"), "{name}");
        }
    }

    #[test]
    fn a_report_becomes_a_line_of_the_card() {
        let evaluation = Evaluation {
            command: Vec::new(),
            data: "streets".into(),
            metric: "miou".into(),
            expected: 0.5,
            within: 0.02,
            others: vec!["pixel_accuracy".into()],
        };
        let mut report =
            json!({ "complete": true, "counted": 7, "scalars": { "miou": 0.51234, "pixel_accuracy": 0.9 } });
        let (line, value) = metrics_of(&report, &evaluation).unwrap();
        assert_eq!(line, "metrics.streets = { miou = 0.5123, pixel_accuracy = 0.9000, samples = 7 }");
        assert_eq!(value, 0.51234);
        let headline = "headline = { data = \"streets\", metric = \"miou\" }";
        assert_eq!(headline_of(&report, &evaluation), headline);
        report["headline"] = json!("miou");
        report["interval"] = json!({ "low": 0.25, "high": 0.75 });
        let with_interval = headline.replace(" }", ", interval = [0.2500, 0.7500] }");
        assert_eq!(headline_of(&report, &evaluation), with_interval);
        report["complete"] = json!(false);
        assert!(metrics_of(&report, &evaluation).is_err());
    }
}
