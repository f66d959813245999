//! The table of the registry's learners, which `bindings/python/stubs.py` writes.

use crate::inputs;
use crate::shell::Result;

/// What the registry states of each learner.
pub const LEARNERS: &str = "xtask/learners.tsv";

/// An empty cell.
pub const NOTHING: &str = "-";

/// A learner of the registry.
#[derive(Clone)]
pub struct Learner {
    /// Name in the registry.
    pub name: String,
    /// Name of its class in Python.
    pub class: String,
    /// Task, types of the inputs, types of the outputs.
    pub signature: [String; 3],
    /// What `fit` trains it on.
    pub trains: Training,
    /// Whether it loads networks of other tools.
    pub takes_networks: bool,
}

/// What `fit` of a learner trains on.
#[derive(Clone, Copy, PartialEq)]
pub enum Training {
    /// A data set.
    Data,
    /// Environments.
    Environments,
    /// It does not train.
    Nothing,
}

/// Reads the learners in the order of the registry.
pub fn read() -> Result<Vec<Learner>> {
    parse(&inputs::text(LEARNERS)?)
}

/// Parses the text of [`LEARNERS`].
pub fn parse(text: &str) -> Result<Vec<Learner>> {
    let rows = rows(LEARNERS, text)?.into_iter();
    rows.map(|(line, row)| Learner::parse(row).map_err(|error| format!("{LEARNERS}:{line}: {error}")))
        .collect()
}

impl Learner {
    fn parse([name, class, task, inputs, outputs, trains, networks]: [&str; 7]) -> Result<Self> {
        Ok(Self {
            name: name.to_owned(),
            class: class.to_owned(),
            signature: [task, inputs, outputs].map(str::to_owned),
            trains: match trains {
                "data" => Training::Data,
                "environments" => Training::Environments,
                NOTHING => Training::Nothing,
                word => return Err(format!("unknown word {word:?}")),
            },
            takes_networks: match networks {
                "networks" => true,
                NOTHING => false,
                word => return Err(format!("unknown word {word:?}")),
            },
        })
    }
}

/// Returns the lines of a table that are no comments, each with its number and its cells.
pub fn rows<'a, const N: usize>(file: &str, text: &'a str) -> Result<Vec<(usize, [&'a str; N])>> {
    let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.starts_with('#'));
    let rows = lines.map(|(number, line)| {
        let cells = line.split('\t').collect::<Vec<_>>();
        cells.try_into().map(|cells| (number, cells)).map_err(|cells: Vec<_>| {
            format!("{file}:{number}: {} cells instead of {N}; run `cargo xtask generate`", cells.len())
        })
    });
    rows.collect()
}
