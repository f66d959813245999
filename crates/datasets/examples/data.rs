//! Checks, prints and converts data sets; used by the Python tests.
//!
//! ```console
//! $ cargo run -p opendr-datasets --example data -- print coco set --target PoseList
//! $ cargo run -p opendr-datasets --example data -- convert coco set yolo out --split val
//! ```

use std::path::Path;

use opendr_datasets::{OpenOptions, Problems, WriteOptions, find_format, open};
use opendr_engine::dataset::{DatasetIterator, ExternalDataset};
use opendr_engine::{Error, Result, Silent, ValueType};

const USAGE: &str = "print FORMAT PATH, or convert FORMAT PATH TO OUT; --split NAME, --to-split NAME, --target TYPE, \
                     --skip-broken";

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let after = |flag: &str| {
        let at = arguments.iter().position(|argument| argument == flag)?;
        arguments.get(at + 1).cloned()
    };
    let target = match after("--target") {
        Some(name) => Some(type_called(&name)?),
        None => None,
    };
    let problems = Problems::new(arguments.iter().any(|argument| argument == "--skip-broken"));
    let options = OpenOptions { split: after("--split"), target };
    let dataset = |format: &str, path: &str| open(&ExternalDataset::new(path, format), &options, &problems);
    let words: Vec<&str> =
        arguments.iter().map(String::as_str).take_while(|word| !word.starts_with("--")).collect();
    match words[..] {
        ["print", format, path] => print(&*dataset(format, path)?)?,
        ["convert", format, path, to, out] => {
            let written =
                WriteOptions { split: after("--to-split").or_else(|| options.split.clone()), link: false };
            (find_format(to)?.write)(&*dataset(format, path)?, Path::new(out), &written, &problems, &Silent)?;
        }
        _ => return Err(Error::invalid_param(USAGE)),
    }
    problems.list().iter().for_each(|problem| eprintln!("{problem}"));
    Ok(())
}

fn type_called(name: &str) -> Result<ValueType> {
    let found = ValueType::ALL.iter().find(|each| each.name() == name);
    found.copied().ok_or_else(|| Error::invalid_param(format!("unknown type {name}")))
}

/// Prints a line for each sample: its name, id and target.
fn print(dataset: &dyn DatasetIterator) -> Result<()> {
    let classes: Vec<_> = dataset.classes().iter().map(str::to_owned).collect();
    println!("{}", serde_json::json!({"classes": classes, "class_ids": dataset.class_ids()}));
    for index in 0..dataset.len() {
        let target = dataset.target(index)?;
        println!(
            "{}",
            serde_json::json!({"name": dataset.name(index), "id": dataset.id(index), "target": target})
        );
    }
    Ok(())
}
