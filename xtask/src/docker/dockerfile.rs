//! The instructions of a Dockerfile.

use crate::shell::Result;

/// A stage: what follows a `FROM`.
#[derive(Debug)]
pub struct Stage {
    /// Image that it begins with.
    pub image: String,
    /// Name that other stages copy from.
    pub name: Option<String>,
    /// The other instructions in order.
    pub steps: Vec<Step>,
}

/// An instruction.
#[derive(Debug, PartialEq)]
pub enum Step {
    /// A line for the shell.
    Run(String),
    /// Files copied out of the context, or out of a stage, to the last path.
    Copy { from: Option<String>, paths: Vec<String> },
    /// Variables of the steps after it and of the container.
    Env(Vec<(String, String)>),
    /// Folder of the steps after it and of the container.
    Workdir(String),
    /// User of the steps after it and of the container.
    User(String),
    /// Program of the container with its arguments.
    Entrypoint(Vec<String>),
    /// Arguments of the container where none are given.
    Cmd(Vec<String>),
    /// Instructions that change no file: `LABEL`, `VOLUME`, `EXPOSE`.
    About,
}

/// Parses the instructions that the images of this repository use; others are refused by name.
pub fn parse(text: &str) -> Result<Vec<Stage>> {
    let mut stages: Vec<Stage> = Vec::new();
    for (number, line) in instructions(text) {
        let failed = |what: &str| format!("line {number}: {what}");
        let (word, rest) = line.split_once(' ').unwrap_or((&line, ""));
        let rest = rest.trim();
        if word.eq_ignore_ascii_case("FROM") {
            let words: Vec<_> = rest.split_whitespace().collect();
            let (image, name) = match words[..] {
                [image] => (image, None),
                [image, of, name] if of.eq_ignore_ascii_case("AS") => (image, Some(name.to_owned())),
                _ => return Err(failed("FROM is followed by IMAGE or IMAGE AS NAME")),
            };
            stages.push(Stage { image: image.to_owned(), name, steps: Vec::new() });
            continue;
        }
        let step = match word.to_uppercase().as_str() {
            "RUN" => Step::Run(rest.to_owned()),
            "COPY" => copy(rest).ok_or_else(|| failed("COPY [--from=STAGE] SOURCE... PATH"))?,
            "ENV" => Step::Env(variables(rest).ok_or_else(|| failed("ENV NAME=VALUE ..."))?),
            "WORKDIR" => Step::Workdir(rest.to_owned()),
            "USER" => Step::User(rest.to_owned()),
            "ENTRYPOINT" => {
                Step::Entrypoint(serde_json::from_str(rest).map_err(|error| failed(&error.to_string()))?)
            }
            "CMD" => Step::Cmd(serde_json::from_str(rest).map_err(|error| failed(&error.to_string()))?),
            "LABEL" | "VOLUME" | "EXPOSE" => Step::About,
            other => return Err(failed(&format!("{other} is not supported by this check"))),
        };
        if let Step::Copy { from: Some(from), .. } = &step
            && !stages.iter().any(|stage| stage.name.as_ref() == Some(from))
        {
            return Err(failed(&format!("there is no stage {from} before it")));
        }
        let stage = stages.last_mut().ok_or_else(|| failed("the first instruction is FROM"))?;
        stage.steps.push(step);
    }
    if stages.is_empty() { Err("there is no FROM".to_owned()) } else { Ok(stages) }
}

/// Returns the instructions as lines with the numbers of their first lines; comments are left out, also between continued lines.
fn instructions(text: &str) -> Vec<(usize, String)> {
    let mut found: Vec<(usize, String)> = Vec::new();
    let mut is_continued = false;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let part = line.strip_suffix('\\').map_or(line, str::trim_end);
        match found.last_mut().filter(|_| is_continued) {
            Some((_, whole)) => {
                whole.push(' ');
                whole.push_str(part);
            }
            None => found.push((index + 1, part.to_owned())),
        }
        is_continued = line.ends_with('\\');
    }
    found
}

fn copy(rest: &str) -> Option<Step> {
    let mut words: Vec<_> = rest.split_whitespace().map(str::to_owned).collect();
    let from = words.first()?.strip_prefix("--from=").map(str::to_owned);
    if from.is_some() {
        words.remove(0);
    }
    let is_complete = words.len() >= 2 && words.iter().all(|word| !word.starts_with("--"));
    is_complete.then_some(Step::Copy { from, paths: words })
}

fn variables(rest: &str) -> Option<Vec<(String, String)>> {
    let pairs = rest.split_whitespace().map(|pair| pair.split_once('='));
    pairs.map(|pair| pair.map(|(name, value)| (name.to_owned(), value.to_owned()))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docker::FILES;
    use crate::inputs;
    use crate::shell::root;

    #[test]
    fn images_are_pinned_built_in_stages_and_run_without_privileges() {
        for file in FILES {
            let stages = parse(&inputs::text(file).unwrap()).unwrap();
            assert!(stages.len() > 1, "{file}");
            for stage in &stages {
                let (_, tag) = stage.image.rsplit_once(':').unwrap();
                assert!(
                    tag != "latest" && tag.chars().any(|character| character.is_ascii_alphanumeric()),
                    "{file}: {tag}"
                );
            }
            let last = stages.last().unwrap();
            let user = last.steps.iter().rev().find_map(|step| match step {
                Step::User(user) => Some(user.as_str()),
                _ => None,
            });
            assert!(user.is_some_and(|user| !["root", "0"].contains(&user)), "{file}: {user:?}");
            assert!(matches!(last.steps[last.steps.len() - 2], Step::Entrypoint(_)), "{file}");
            for step in stages.iter().flat_map(|stage| &stage.steps) {
                if let Step::Copy { from: None, paths } = step {
                    assert!(
                        paths[..paths.len() - 1].iter().all(|path| root().join(path).exists()),
                        "{file}: {paths:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn continued_lines_are_one_instruction() {
        let stages = parse(
            "# x\nFROM a:1 AS b\nRUN one \\\n    # comment\n    && two\nFROM c:1\nCOPY --from=b /x /y\n",
        )
        .unwrap();
        assert_eq!(stages[0].steps[0], Step::Run("one && two".to_owned()));
        assert!(matches!(&stages[1].steps[0], Step::Copy { from: Some(from), .. } if from == "b"));
        for wrong in [
            "",
            "RUN x",
            "FROM",
            "FROM a b",
            "FROM a:1\nADD x y",
            "FROM a:1\nCOPY x",
            "FROM a:1\nCMD x",
            "FROM a:1\nCOPY --from=b x y",
        ] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }
}
