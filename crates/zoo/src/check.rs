//! Parsing and validation of cards.

use std::collections::HashSet;

use opendr_engine::model::member_path;
use opendr_engine::{Error, Result, ResultExt};

use crate::card::{Card, Grade, Headline, Import, ItemKind, Variant};
use crate::embedded::classes;
use crate::source::{FilePlaces, Package, Source};

/// Maximum size of a file or package, in bytes.
const MAX_BYTES: u64 = 2 << 30;

const MAX_CARD_BYTES: usize = 1 << 20;

impl Card {
    /// Parses a card and validates its names, paths, addresses, sizes and default variant.
    ///
    /// # Errors
    /// `Format` for an invalid card, `Integrity` when a name in it could leave its folder.
    pub fn from_toml(text: &str) -> Result<Self> {
        if text.len() > MAX_CARD_BYTES {
            return Err(Error::format(format!(
                "the card has {} bytes; at most {MAX_CARD_BYTES} are allowed",
                text.len()
            )));
        }
        let card: Self = toml::from_str(text)
            .map_err(|error| Error::format("the card cannot be parsed").with_source(error))?;
        check_card(&card).map_err(|error| error.context(format!("the card {:?}", card.learner)))?;
        Ok(card)
    }
}

fn check_card(card: &Card) -> Result<()> {
    check_name("learner", &card.learner)?;
    ensure(card.kind == ItemKind::Sample || card.task.is_some(), || {
        "the card of a model must name its task".into()
    })?;
    let mut names = HashSet::new();
    for variant in &card.variants {
        ensure(names.insert(&variant.name), || format!("two variants are called {:?}", variant.name))?;
        check_variant(card.kind, variant).context(|| format!("variant {:?}", variant.name))?;
    }
    let defaults = card.variants.iter().filter(|variant| variant.default).count();
    let untrained = card.kind == ItemKind::Model && card.variants.is_empty();
    ensure(untrained || defaults == 1, || format!("{defaults} variants are marked as default: mark one"))
}

fn check_variant(kind: ItemKind, variant: &Variant) -> Result<()> {
    check_name("variant", &variant.name)?;
    variant.folder.iter().try_for_each(|folder| check_name("folder", folder))?;
    let mut names = HashSet::new();
    for file in &variant.files {
        member_path(&file.name)?;
        ensure(names.insert(file.name.to_lowercase()), || format!("two files are called {:?}", file.name))?;
        check_size(file.size).context(|| file.name.clone())?;
    }
    for (part, item) in &variant.parts {
        check_name("part", part)?;
        item.split('/').try_for_each(|word| check_name("item", word)).context(|| format!("part {part:?}"))?;
        let taken = |name: &String| name == part || name.starts_with(&format!("{part}/"));
        ensure(!names.iter().any(taken), || format!("a file lies where the part {part:?} goes"))?;
        ensure(kind == ItemKind::Model, || "a sample has no parts".into())?;
    }
    if let Some(list) = &variant.classes {
        ensure(classes(list).is_some(), || format!("models/classes/{list}.txt does not exist"))?;
    }
    check_imports(variant)?;
    check_accuracy(variant)?;
    match kind {
        ItemKind::Sample => {
            ensure(variant.files.len() == 1, || "a sample must have exactly one file".into())?
        }
        // An algorithm may have no weights, and an item may consist of its parts alone.
        ItemKind::Model if variant.files.is_empty() => {
            return ensure(variant.sources.is_empty(), || "the variant has sources, but no files".into());
        }
        ItemKind::Model => {}
    }
    ensure(!variant.sources.is_empty(), || "the variant has no sources".into())?;
    variant.sources.iter().try_for_each(|source| {
        let complete = source.files().len() == variant.files.len()
            && variant.files.iter().all(|file| source.files().contains_key(&file.name));
        ensure(complete, || "the source must name a place for each file and for no other".into())
            .and_then(|()| check_source(source))
            .context(|| source.to_string())
    })
}

fn check_accuracy(variant: &Variant) -> Result<()> {
    if let Some(grade) = variant.grade {
        ensure(variant.has_weights(), || "a grade is for weights: remove it".into())?;
        ensure(grade == Grade::Demonstration || variant.headline.is_some(), || {
            format!("the grade {} needs a headline: the metric and the data it was measured on", grade.name())
        })?;
    }
    let Some(Headline { data, metric, of, .. }) = &variant.headline else { return Ok(()) };
    let accuracy = variant.accuracy().ok_or_else(|| {
        Error::format(format!("the headline names {metric:?} of {data:?}, which metrics does not have"))
    })?;
    ensure(of == "samples" || accuracy.count.is_some(), || format!("metrics.{data} has no number {of:?}"))?;
    let Some((low, high)) = accuracy.interval else { return Ok(()) };
    ensure((low..=high).contains(&accuracy.value), || {
        format!("the interval {low} to {high} does not contain {}", accuracy.value)
    })
}

fn check_imports(variant: &Variant) -> Result<()> {
    let mut made = HashSet::new();
    for import in &variant.import {
        for output in import.outputs() {
            member_path(output)?;
            ensure(made.insert(output.to_lowercase()), || format!("{output:?} is written twice"))?;
        }
        let there = |name: &&String| variant.files.iter().any(|file| file.name == **name);
        let absent = import.named_files().iter().find(|name| !there(name));
        ensure(absent.is_none(), || format!("an import names {absent:?}, which is not one of the files"))?;
        let count = import.files_of(&variant.files).len();
        match import {
            Import::Tfjs(_) => {
                ensure(count >= 2, || "a TensorFlow.js model needs a JSON file and weights".into())?
            }
            Import::Tflite(_) => {
                ensure(count == 1, || "a TensorFlow Lite model needs exactly one file".into())?
            }
            Import::Ncnn(_) => {
                ensure(count == 2, || "an ncnn model needs exactly two files: .param and weights".into())?
            }
            Import::Ctranslate2Whisper | Import::SafetensorsWhisper => {
                ensure(count >= 1, || "no files".into())?
            }
            Import::OnnxWhisper => {
                ensure(count >= 2, || "a Whisper model needs two files: encoder and decoder".into())?
            }
        }
    }
    Ok(())
}

fn check_source(source: &Source) -> Result<()> {
    match source {
        Source::Repository { files } | Source::ModelsPackage { files } => check_paths(files),
        Source::Url { files } => files.values().try_for_each(|address| {
            let sound = ["http://", "https://"].iter().any(|scheme| address.starts_with(scheme))
                && address.len() <= 2048
                && address.chars().all(|c| c.is_ascii_graphic());
            ensure(sound, || format!("{address:?} is not an http or https address"))
        }),
        Source::Github { repository, commit, files } => {
            let parts: Vec<_> = repository.split('/').collect();
            ensure(parts.len() == 2 && parts.iter().all(|part| is_word(part)), || {
                format!("{repository:?} is not owner/name")
            })?;
            let digits = commit.bytes().all(|byte| byte.is_ascii_hexdigit());
            ensure(digits && (12..=40).contains(&commit.len()), || {
                format!("{commit:?} is not a commit hash")
            })?;
            check_paths(files)
        }
        Source::Npm(package) => {
            let name = package.package.strip_prefix('@').unwrap_or(&package.package);
            let parts: Vec<_> = name.split('/').collect();
            let scoped = package.package.starts_with('@');
            ensure(parts.len() == 1 + usize::from(scoped) && parts.iter().all(|part| is_word(part)), || {
                format!("{:?} is not an npm package name", package.package)
            })?;
            ensure(package.python.is_none() && package.platform.is_none(), || {
                "python and platform are for PyPI only".into()
            })?;
            check_package(package)
        }
        Source::Pypi(package) => {
            let options = [&package.python, &package.platform].into_iter().flatten();
            for word in options.chain([&package.package]) {
                ensure(is_word(word), || format!("{word:?} is not a name, version or platform"))?;
            }
            check_package(package)
        }
    }
}

fn check_package(package: &Package) -> Result<()> {
    let version = &package.version;
    ensure(is_word(version), || format!("{version:?} is not a version"))?;
    check_size(package.size)?;
    check_paths(&package.files)
}

fn check_paths(places: &FilePlaces) -> Result<()> {
    places.values().try_for_each(|place| member_path(place).map(drop))
}

// Words become arguments of package clients, so none may look like an option.
fn is_word(text: &str) -> bool {
    (1..=100).contains(&text.len())
        && text.starts_with(|c: char| c.is_ascii_alphanumeric())
        && text.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"._-+".contains(&byte))
}

// Names become folders of the cache.
fn check_name(what: &str, name: &str) -> Result<()> {
    let sound = (1..=64).contains(&name.len())
        && name.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_');
    ensure(sound, || format!("{what} {name:?}: a name consists of up to 64 characters a-z, 0-9 and _"))
}

fn check_size(size: u64) -> Result<()> {
    ensure((1..=MAX_BYTES).contains(&size), || format!("{size} bytes: a size must be from 1 to {MAX_BYTES}"))
}

fn ensure(holds: bool, message: impl FnOnce() -> String) -> Result<()> {
    if holds { Ok(()) } else { Err(Error::format(message())) }
}
