//! The file `copyright` of Debian packages, in the format DEP-5: our licence and those of the linked crates.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;

use crate::linked::Linked;
use crate::shell::Result;
use crate::spdx::Expression;

/// Licences whose text every Debian system has.
const COMMON: [&str; 3] = ["Apache-2.0", "CC0-1.0", "MPL-2.0"];

/// Other licences, each with words by which the file with its text is recognised.
const TEXTS: [(&str, &str); 13] = [
    ("0BSD", "Permission to use, copy, modify, and/or distribute"),
    ("Apache-2.0 WITH LLVM-exception", "LLVM Exceptions to the Apache 2.0 License"),
    ("BSD-2-Clause", "Redistribution and use in source"),
    ("BSD-3-Clause", "contributors may be used to endorse"),
    ("BSL-1.0", "Boost Software License"),
    ("CDLA-Permissive-2.0", "Community Data License Agreement"),
    ("IJG", "Independent JPEG Group"),
    ("ISC", "Permission to use, copy, modify, and/or distribute this software"),
    ("MIT", "Permission is hereby granted, free of charge"),
    ("NCSA", "University of Illinois"),
    ("Unicode-3.0", "UNICODE LICENSE V3"),
    ("Zlib", "provided 'as-is'"),
    ("bzip2-1.0.6", "bzip2"),
];

/// Code of others inside of crates, which their manifests do not name: crate, files, copyright, licence and its text.
const WITHIN: [(&str, &str, &str, &str, &str); 1] = [(
    "libsqlite3-sys",
    "sqlite3/*",
    "The authors of SQLite",
    "public-domain",
    "The authors disclaim copyright to this source code (https://www.sqlite.org/copyright.html).",
)];

/// Returns the file for packages that consist of these crates; of alternatives, the licence that is first in `preferred` is named.
pub fn file(crates: &[Linked], preferred: &[String], homepage: &str) -> Result<String> {
    let mut text = head(homepage);
    text += "\nFiles: rust-std/*\nCopyright: The Rust Project contributors\nLicense: Apache-2.0\n\
             Comment: The standard library of Rust, which is linked statically.\n";
    let mut files: BTreeMap<(String, Vec<String>), Vec<String>> = BTreeMap::new();
    let mut licences: BTreeMap<String, Vec<&Linked>> = BTreeMap::new();
    for linked in crates.iter().filter(|linked| !linked.is_ours()) {
        let chosen = chosen(linked, preferred)?;
        for licence in &chosen {
            licences.entry(licence.clone()).or_default().push(linked);
        }
        let key = (chosen.join(" and "), holders(linked));
        files.entry(key).or_default().push(format!("{}-{}/*", linked.name, linked.version));
    }
    for ((licence, holders), files) in &files {
        let _ = write!(
            text,
            "\nFiles:\n {}\nCopyright:\n {}\nLicense: {}\n",
            files.join("\n "),
            holders.join("\n "),
            short(licence)
        );
    }
    let within = WITHIN.iter().filter(|(name, ..)| crates.iter().any(|linked| linked.name == *name));
    for (name, files, holder, licence, note) in within {
        let _ = write!(text, "\nFiles: {name}/{files}\nCopyright: {holder}\nLicense: {licence}\n {note}\n");
    }
    for (licence, users) in &licences {
        let _ = write!(text, "\nLicense: {}\n{}", short(licence), licence_text(licence, users)?);
    }
    if !licences.contains_key("Apache-2.0") {
        let _ = write!(text, "\nLicense: Apache-2.0\n{}", licence_text("Apache-2.0", &[])?);
    }
    Ok(text)
}

/// Returns the file of a package that has no code of others.
pub fn own_file(homepage: &str) -> Result<String> {
    Ok(format!("{}\nLicense: Apache-2.0\n{}", head(homepage), licence_text("Apache-2.0", &[])?))
}

fn head(homepage: &str) -> String {
    format!(
        "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\
         Upstream-Name: OpenDR in Rust\n\
         Source: {homepage}\n\
         Comment: The paths below are those of the sources, where each crate that is linked has a folder of its name and version.\n\
         \nFiles: *\nCopyright: 2026 The OpenDR authors\nLicense: Apache-2.0\n"
    )
}

/// Returns the short name of a licence in DEP-5, which has no spaces but those of `and` and `with`.
fn short(licence: &str) -> String {
    licence.replace(" WITH ", " with ").replace("LLVM-exception", "LLVM exception")
}

/// Returns the licences of a crate to comply with.
fn chosen(linked: &Linked, preferred: &[String]) -> Result<Vec<String>> {
    let named = format!("{} {}", linked.name, linked.version);
    if linked.licence.is_empty() {
        return Err(format!("{named} names no licence; see its sources and add it to deny.toml"));
    }
    let expression = Expression::parse(&linked.licence).map_err(|error| format!("{named}: {error}"))?;
    let chosen = expression.choose(preferred);
    let mut chosen =
        chosen.ok_or_else(|| format!("{named}: deny.toml does not allow {:?}", linked.licence))?;
    chosen.sort();
    chosen.dedup();
    Ok(chosen)
}

/// Returns the copyright lines of a crate's licence files, or its authors.
fn holders(linked: &Linked) -> Vec<String> {
    let mut found = BTreeSet::new();
    for text in licence_files(linked) {
        for line in text.lines() {
            let line = line.trim().trim_start_matches(['/', '*', '#']).trim();
            let line: Vec<_> = line.split_whitespace().collect();
            let line = line.join(" ");
            let rest = line.strip_prefix("Copyright").or_else(|| line.strip_prefix("COPYRIGHT"));
            let is_holder = rest.is_some_and(|rest| {
                let has_year = rest.as_bytes().windows(4).any(|four| four.iter().all(u8::is_ascii_digit));
                (has_year || rest.contains("(c)") || rest.contains('©'))
                    && !["yyyy", "YEAR", "<year>"].iter().any(|placeholder| rest.contains(placeholder))
            });
            if let Some(rest) = rest.filter(|_| is_holder) {
                let rest = rest.trim_start_matches([':', ' ']);
                let rest =
                    ["(c)", "(C)", "©"].iter().fold(rest, |rest, sign| rest.trim_start_matches(sign).trim());
                found.insert(rest.trim_end_matches(". All rights reserved.").to_owned());
            }
        }
    }
    if found.is_empty() {
        found.extend(linked.authors.iter().map(|author| author.trim().to_owned()));
    }
    if found.is_empty() {
        found.insert(format!("The authors of {}", linked.name));
    }
    found.into_iter().collect()
}

/// Returns the texts of the licence files of a crate.
fn licence_files(linked: &Linked) -> Vec<String> {
    let entries = fs::read_dir(&linked.folder).into_iter().flatten().flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    let is_licence = |name: String| {
        ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "UNLICENSE"].iter().any(|word| name.contains(word))
    };
    paths.retain(|path| {
        path.is_file()
            && path.file_name().is_some_and(|name| is_licence(name.to_string_lossy().to_uppercase()))
    });
    paths
        .iter()
        .filter_map(|path| fs::read(path).ok())
        .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        .collect()
}

/// Returns the text of a licence as the lines of a field, from a file of one of the crates that have it.
fn licence_text(licence: &str, users: &[&Linked]) -> Result<String> {
    if COMMON.contains(&licence) {
        return Ok(format!(" On Debian systems, the text is in /usr/share/common-licenses/{licence}.\n"));
    }
    let marker = TEXTS.iter().find(|(name, _)| *name == licence).map(|(_, marker)| *marker);
    let marker = marker.ok_or_else(|| format!("add words of the licence {licence} to TEXTS"))?;
    let named: Vec<_> = users.iter().map(|linked| linked.name.as_str()).collect();
    let mut texts: Vec<_> = users.iter().flat_map(|linked| licence_files(linked)).collect();
    texts.retain(|text| text.split_whitespace().collect::<Vec<_>>().join(" ").contains(marker));
    // A file with several licences is longer.
    let text = texts.into_iter().min_by_key(String::len);
    let text = text.ok_or_else(|| format!("no file with the licence {licence} in {}", named.join(", ")))?;
    let lines = text.lines().filter(|line| !line.trim_start().starts_with("Copyright"));
    let mut field = String::new();
    for line in lines.map(str::trim_end).skip_while(|line| line.is_empty()) {
        let _ = writeln!(field, " {}", if line.is_empty() { "." } else { line });
    }
    Ok(field)
}
