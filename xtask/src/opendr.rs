//! The generated part of docs/opendr.md: the classes of OpenDR 3.0 beside the learners here.
//!
//! `bindings/python/stubs.py` writes the two tables that it is made from, [`LEARNERS`] from the registry and [`NAMES`] from the
//! Python package's table of OpenDR's names, and its check fails if they are not up to date.

use std::collections::BTreeSet;

use crate::inputs;
use crate::learner_table::{self, LEARNERS, Learner, NOTHING, Training, rows};
use crate::models::{AccuracyCells, Models, Variant};
use crate::shell::Result;

/// OpenDR's classes and functions.
const NAMES: &str = "xtask/opendr_names.tsv";

/// Ending of the names of learner classes.
const LEARNER: &str = "Learner";

/// Columns of the facts of a learner.
const COLUMNS: &str = "weights | trains | takes yours | accuracy | 95 % interval | measured on |";

/// A class or function of OpenDR.
struct Name {
    package: String,
    name: String,
    here: Here,
}

/// What this package has for a name of OpenDR.
enum Here {
    /// A learner, by its place in the registry's table.
    Learner(usize),
    /// The same name, which is no learner of the registry.
    Same,
    /// Nothing: what to use, as the end of a sentence.
    Instead(String),
}

/// The tables of [`LEARNERS`] and [`NAMES`].
pub struct Opendr {
    /// The learners in the order of the registry.
    pub learners: Vec<Learner>,
    names: Vec<Name>,
}

impl Opendr {
    /// Reads both tables.
    pub fn read() -> Result<Self> {
        Self::parse(&inputs::text(LEARNERS)?, &inputs::text(NAMES)?)
    }

    /// Parses both tables. Every learner that the names refer to must be in the registry.
    fn parse(learners: &str, names: &str) -> Result<Self> {
        let learners = learner_table::parse(learners)?;
        let names = rows(NAMES, names)?
            .into_iter()
            .map(|(line, row)| {
                Name::parse(row, &learners).map_err(|error| format!("{NAMES}:{line}: {error}"))
            })
            .collect::<Result<_>>()?;
        Ok(Self { learners, names })
    }

    /// Returns the generated part of the page: the learners by package, the learners that replace others, and the other names.
    pub fn tables(&self, models: &Models) -> Result<String> {
        let learners: Vec<&Name> = self.names.iter().filter(|name| name.is_learner()).collect();
        let available = learners.iter().filter(|name| matches!(name.here, Here::Learner(_))).count();
        let mut text = format!(
            "\n{} of OpenDR's {} learner classes are available; the others name a replacement.\n",
            available,
            learners.len()
        );
        for package in packages(&learners) {
            text += &format!("\n### {package}\n\n{}", head("OpenDR 3.0 | here |"));
            for name in learners.iter().filter(|name| name.package == package) {
                text += &match &name.here {
                    Here::Learner(place) => self.row(&name.name, &self.learners[*place], models)?,
                    Here::Instead(instead) => {
                        format!("| `{}` | not available; {} | | | | | | |\n", name.name, cell(instead))
                    }
                    Here::Same => continue,
                };
            }
        }
        text += &format!("\n### Replacements\n\n{}", head("class here | learner |"));
        for learner in self.replacements() {
            text += &self.row(&learner.class, learner, models)?;
        }
        Ok(text + &self.others())
    }

    /// Returns the learners that the replacements of OpenDR's learners name and that are no class of OpenDR, in the order of the
    /// registry.
    fn replacements(&self) -> impl Iterator<Item = &Learner> {
        let replaced = self.names.iter().filter(|name| name.is_learner());
        let named: BTreeSet<_> = replaced
            .filter_map(|name| if let Here::Instead(instead) = &name.here { Some(instead) } else { None })
            .flat_map(|instead| classes(instead))
            .collect();
        let is_of_opendr = |class: &str| self.names.iter().any(|name| name.name == class);
        self.learners
            .iter()
            .filter(move |one| named.contains(one.class.as_str()) && !is_of_opendr(&one.class))
    }

    /// Returns the row of a class: the learner and the cells of [`COLUMNS`].
    fn row(&self, class: &str, learner: &Learner, models: &Models) -> Result<String> {
        let card = models.card(&learner.name).ok_or_else(|| {
            format!("models/{}.toml is missing: every learner of {LEARNERS} has a card", learner.name)
        })?;
        let variant = card.default_variant();
        let weights = match variant {
            None if learner.takes_networks => "yours".to_owned(),
            None => "none".to_owned(),
            Some(variant) => match &variant.grade {
                Some(grade) => format!("`{}`, {grade}", variant.name),
                None => "needs none".to_owned(),
            },
        };
        let AccuracyCells { value, interval, data } =
            variant.map(Variant::accuracy_cells).unwrap_or_default();
        let trains = self.training(learner, variant);
        let yours = self.import(learner, variant);
        let here = link(learner);
        Ok(format!(
            "| `{class}` | {here} | {weights} | {trains} | {yours} | {value} | {interval} | {data} |\n"
        ))
    }

    /// Returns whether a learner trains; if not, why, and which others do.
    fn training(&self, learner: &Learner, variant: Option<&Variant>) -> String {
        let why = match learner.trains {
            Training::Data => return "yes".to_owned(),
            Training::Environments => return "in environments".to_owned(),
            Training::Nothing => match variant {
                None => "it runs your network".to_owned(),
                Some(variant) if variant.has_files() => "inference only".to_owned(),
                Some(variant) if variant.parts.is_empty() => "a rule without weights".to_owned(),
                Some(variant) => format!("made of {}", list(variant.parts.values().map(String::as_str))),
            },
        };
        let parts = variant.into_iter().flat_map(|variant| variant.parts.values());
        let parts: Vec<_> = parts.filter_map(|part| part.split('/').next()).collect();
        let others = self.learners.iter().filter(|other| {
            other.trains != Training::Nothing
                && (other.signature == learner.signature || parts.contains(&other.name.as_str()))
        });
        match list(others.map(|other| other.name.as_str())) {
            others if others.is_empty() => format!("no: {why}"),
            others => format!("no: {why}; trainable: {others}"),
        }
    }

    /// Returns the command that takes a network of the user's for the predictions of a learner.
    fn import(&self, learner: &Learner, variant: Option<&Variant>) -> String {
        // A format such as `ctranslate2_whisper` is one of that learner.
        let own = format!("_{}", learner.name);
        if variant.is_some_and(|variant| variant.formats().any(|format| format.ends_with(&own))) {
            return format!("`opendr import {}`", learner.name);
        }
        let takes = |other: &&Learner| other.takes_networks && other.signature == learner.signature;
        match self.learners.iter().find(takes) {
            Some(other) => format!("ONNX: `opendr import {}`", other.name),
            None => "no".to_owned(),
        }
    }

    /// Returns the section of the names that are no learners.
    fn others(&self) -> String {
        let names: Vec<&Name> = self.names.iter().filter(|name| !name.is_learner()).collect();
        let mut text =
            "\n### Other classes and functions\n\n| package | available | not available |\n|---|---|---|\n"
                .to_owned();
        for package in packages(&names) {
            let of_package = |is_here: bool| {
                let names = names
                    .iter()
                    .filter(|name| name.package == package && matches!(name.here, Here::Same) == is_here);
                list(names.map(|name| name.name.as_str()))
            };
            text += &format!("| {package} | {} | {} |\n", of_package(true), of_package(false));
        }
        text + "\n"
    }
}

/// Returns the name of a learner, with a link to its parameters.
fn link(learner: &Learner) -> String {
    format!("[`{0}`](learners.md#{1}-{0})", learner.name, learner.class.to_lowercase())
}

impl Name {
    fn parse([package, name, learner, instead]: [&str; 4], learners: &[Learner]) -> Result<Self> {
        let here =
            match (learner, instead) {
                (NOTHING, NOTHING) => Here::Same,
                (learner, NOTHING) => {
                    // Networks of a class of OpenDR are run by a learner with another class.
                    let is_of = |one: &Learner| one.class == name || one.takes_networks;
                    let place = learners.iter().position(|one| one.name == learner && is_of(one));
                    Here::Learner(place.ok_or_else(|| {
                        format!("{name} is no class of a learner {learner:?} of {LEARNERS}")
                    })?)
                }
                (NOTHING, instead) => {
                    let is_known = |class: &&str| learners.iter().any(|learner| learner.class == *class);
                    if let Some(unknown) = classes(instead).find(|class| !is_known(class)) {
                        return Err(format!(
                            "the replacement of {name} names {unknown}, which {LEARNERS} does not have"
                        ));
                    }
                    Here::Instead(instead.to_owned())
                }
                _ => return Err(format!("{name} has a learner and a replacement; leave one out")),
            };
        Ok(Self { package: package.to_owned(), name: name.to_owned(), here })
    }

    fn is_learner(&self) -> bool {
        match self.here {
            Here::Learner(_) => true,
            // The base classes of learners are no learners.
            Here::Same => false,
            Here::Instead(_) => self.name.ends_with(LEARNER),
        }
    }
}

/// Returns the packages of names, in the order of the names.
fn packages<'a>(names: &[&'a Name]) -> Vec<&'a str> {
    let mut packages: Vec<_> = names.iter().map(|name| name.package.as_str()).collect();
    packages.dedup();
    packages
}

/// Returns the names of learner classes in a text.
fn classes(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|letter: char| !letter.is_alphanumeric());
    words.filter(|word| word.len() > LEARNER.len() && word.ends_with(LEARNER))
}

/// Returns the head of a table with `first` columns before those of the facts.
fn head(first: &str) -> String {
    let count = first.matches('|').count() + COLUMNS.matches('|').count();
    format!("| {first} {COLUMNS}\n|{}\n", "---|".repeat(count))
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::Card;

    const REGISTRY: &str = "# comment\n\
        shown\tShownLearner\tt\tImage\tBoxes\t-\t-\n\
        taught\tTaughtLearner\tt\tImage\tBoxes\tdata\t-\n\
        yours\tYoursLearner\tt\tImage\tBoxes\t-\tnetworks\n\
        rule\tRuleLearner\tu\tBoxes\tTracks\t-\t-\n\
        whole\tWholeLearner\tu\tImage\tTracks\t-\t-\n\
        heard\tHeardLearner\tv\tAudio\tText\t-\t-\n\
        policy\tPolicyLearner\tw\tVector\tAction\tenvironments\t-\n";

    fn card(learner: &str, variant: &str) -> Card {
        let variant = if variant.is_empty() {
            String::new()
        } else {
            format!("[[variants]]\nname = \"a\"\ndefault = true\nlicence = {{}}\n{variant}\n")
        };
        Card::parse(&format!("learner = \"{learner}\"\ntask = \"t\"\n{variant}")).unwrap()
    }

    fn models(value: f64) -> Models {
        const FILES: &str = "grade = \"real\"\nfiles = [{ size = 1 }]\n";
        let measured = format!(
            "{FILES}headline = {{ data = \"d\", metric = \"map\", interval = [0.25, 0.75] }}\n\
             metrics.d = {{ map = {value:?}, samples = 7 }}"
        );
        Models::of(vec![
            card("shown", &measured),
            card("taught", ""),
            card("yours", ""),
            card("rule", "speed = { peak_mb = 1 }"),
            card("whole", "grade = \"real\"\nparts = { detector = \"taught/b\", other = \"shown/a\" }"),
            card("heard", &format!("{FILES}import = {{ format = \"tool_heard\" }}")),
            card("policy", ""),
        ])
    }

    /// Returns the row of a class.
    fn row<'a>(page: &'a str, class: &str) -> &'a str {
        let mut rows = page.lines().filter(|line| line.starts_with(&format!("| `{class}` |")));
        let row = rows.next().unwrap_or_else(|| panic!("{class} has no row"));
        assert_eq!(rows.next(), None);
        row
    }

    #[test]
    fn every_class_of_opendr_is_on_the_page() {
        let page = inputs::text("docs/opendr.md").unwrap();
        let registry = inputs::text("docs/learners.md").unwrap();
        let opendr = Opendr::read().unwrap();
        // 46 learners of the 3.0.0 packages, the engine's and the tuner's examples, and 6 of the repository alone.
        assert!(opendr.names.iter().filter(|name| name.is_learner()).count() >= 54);
        for name in &opendr.names {
            match &name.here {
                Here::Learner(place) => {
                    let Learner { name: learner, class, .. } = &opendr.learners[*place];
                    let row = row(&page, &name.name);
                    assert!(row.contains(&format!("[`{learner}`](learners.md#")), "{row}");
                    assert!(registry.contains(&format!("\n### {class}: `{learner}`\n")), "{row}");
                }
                Here::Instead(instead) if name.is_learner() => {
                    assert!(row(&page, &name.name).contains(instead), "{}", name.name);
                }
                _ => {
                    let package = format!("| {} | ", name.package);
                    let row = page.lines().find(|line| line.starts_with(&package)).unwrap();
                    assert!(row.contains(&format!("`{}`", name.name)), "{row}");
                }
            }
        }
    }

    #[test]
    fn cells_are_from_registry_and_cards() {
        let names = "p.a\tShownLearner\tshown\t-\n\
            p.a\tTaughtLearner\ttaught\t-\n\
            p.a\tOldLearner\t-\tuse YoursLearner, or TaughtLearner\n\
            p.a\tDataset\t-\t-\n\
            p.b\tRuleLearner\trule\t-\n\
            p.b\tWholeLearner\twhole\t-\n\
            p.b\tHeardLearner\theard\t-\n\
            p.b\tPolicyLearner\tpolicy\t-\n\
            p.b\tread\t-\tuse a | b\n";
        let opendr = Opendr::parse(REGISTRY, names).unwrap();
        let page = opendr.tables(&models(0.5)).unwrap();
        let cells = |class: &str| row(&page, class).split_once(") | ").unwrap().1.to_owned();
        let taken = "ONNX: `opendr import yours`";
        let accuracy = "0.5 map | 0.25 to 0.75 | d, 7 samples |";
        assert_eq!(
            cells("ShownLearner"),
            format!("`a`, real | no: inference only; trainable: `taught` | {taken} | {accuracy}")
        );
        assert_eq!(cells("TaughtLearner"), format!("none | yes | {taken} |  |  |  |"));
        assert_eq!(
            cells("YoursLearner"),
            format!("yours | no: it runs your network; trainable: `taught` | {taken} |  |  |  |")
        );
        assert_eq!(cells("RuleLearner"), "needs none | no: a rule without weights | no |  |  |  |");
        assert_eq!(
            cells("WholeLearner"),
            "`a`, real | no: made of `taught/b`, `shown/a`; trainable: `taught` | no |  |  |  |"
        );
        assert_eq!(
            cells("HeardLearner"),
            "`a`, real | no: inference only | `opendr import heard` |  |  |  |"
        );
        assert_eq!(cells("PolicyLearner"), "none | in environments | no |  |  |  |");
        assert!(page.starts_with("\n6 of OpenDR's 7 learner classes"), "{page}");
        assert!(row(&page, "OldLearner").contains("| not available; use YoursLearner, or TaughtLearner |"));
        assert!(page.contains("\n| p.a | `Dataset` |  |\n| p.b |  | `read` |\n"), "{page}");
        // A card that changes makes the page old.
        assert_ne!(page, opendr.tables(&models(0.625)).unwrap());
    }

    #[test]
    fn references_to_nothing_are_refused() {
        let refused = |names: &str| Opendr::parse(REGISTRY, names).err().unwrap();
        assert!(refused("p\tXLearner\tx\t-\n").contains("XLearner is no class of a learner \"x\""));
        assert!(refused("p\tXLearner\tshown\t-\n").contains("XLearner"), "the class of another learner");
        assert!(refused("p\tXLearner\t-\tuse NoLearner\n").contains("names NoLearner"));
        assert!(refused("p\tShownLearner\tshown\tuse TaughtLearner\n").contains("opendr_names.tsv:1"));
        assert!(refused("p\tShownLearner\tshown\n").contains("3 cells instead of 4"));
        let unknown = REGISTRY.replace("environments", "worlds");
        assert!(
            Opendr::parse(&unknown, "").err().unwrap().contains("learners.tsv:8: unknown word \"worlds\"")
        );
        let opendr = Opendr::parse(REGISTRY, "p\tShownLearner\tshown\t-\n").unwrap();
        let error = opendr.tables(&Models::of(Vec::new())).unwrap_err();
        assert!(error.contains("models/shown.toml is missing"), "{error}");
    }
}
