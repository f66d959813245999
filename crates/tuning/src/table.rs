//! Text output of a study.

use crate::records::{StudyRecord, TrialRecord, TrialState};

/// Returns a table for the terminal: the number of trials in each state, the best trial, and the newest `rows`, one per line.
pub fn table_from_study(study: &StudyRecord, rows: usize) -> String {
    let count = |state: fn(&TrialRecord) -> bool| study.trials.iter().filter(|trial| state(trial)).count();
    let states = [
        (count(|trial| trial.state == TrialState::Complete), "complete"),
        (count(|trial| trial.state == TrialState::Pruned), "pruned"),
        (count(TrialRecord::is_paused), "paused"),
        (count(|trial| trial.state == TrialState::Running), "running"),
        (count(|trial| trial.state == TrialState::Waiting && !trial.is_paused()), "waiting"),
        (count(|trial| trial.state == TrialState::Failed), "failed"),
    ];
    let states: Vec<String> = states
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, state)| format!("{count} {state}"))
        .collect();
    let mut text = format!("{}: {} trials", study.name, study.trials.len());
    if !states.is_empty() {
        text += &format!(" ({})", states.join(", "));
    }
    text.push('\n');
    let names = names(study);
    let first = study.trials.len().saturating_sub(rows);
    let newest = study.trials.iter().skip(first).map(|trial| ("", trial));
    let best = study.best().map(|trial| ("best", trial));
    let head = ["", "trial", "state", "step", "value"].map(str::to_owned);
    let mut lines = vec![head.into_iter().chain(names.iter().map(|name| (*name).to_owned())).collect()];
    lines.extend(best.into_iter().chain(newest).map(|(mark, trial)| line(mark, trial, &names)));
    text + &aligned(&lines)
}

/// Returns one line about a trial: its state, last step and value, its parameters; and the best value so far.
pub fn line_from_study(study: &StudyRecord, number: usize) -> String {
    let Some(trial) = study.trials.get(number) else { return String::new() };
    let names: Vec<_> = trial.params.keys().map(String::as_str).collect();
    let words = line("", trial, &names);
    let [_, number, state, step, value] = [0, 1, 2, 3, 4].map(|at| words[at].as_str());
    let params: Vec<_> =
        names.iter().zip(&words[5..]).map(|(name, value)| format!("{name} {value}")).collect();
    let measured = if step.is_empty() { String::new() } else { format!(" {value} at {step}") };
    let best = study.best().and_then(TrialRecord::value).map(|best| format!("; best {}", short(best)));
    format!("trial {number} {state}{measured}: {}{}", params.join(", "), best.unwrap_or_default())
}

/// Returns the names of all parameters, in the order of their first trials.
fn names(study: &StudyRecord) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for name in study.trials.iter().flat_map(|trial| trial.params.keys()) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names
}

fn line(mark: &str, trial: &TrialRecord, names: &[&str]) -> Vec<String> {
    let state = match trial.state {
        _ if trial.is_paused() => "paused",
        TrialState::Running => "running",
        TrialState::Complete => "complete",
        TrialState::Pruned => "pruned",
        TrialState::Failed => "failed",
        TrialState::Waiting => "waiting",
    };
    let last = trial.last_report();
    let values: Vec<String> = trial.values.iter().map(|value| short(*value)).collect();
    let value = if values.is_empty() {
        last.map_or(String::new(), |(_, value)| short(value))
    } else {
        values.join(" ")
    };
    let step = last.map_or(String::new(), |(step, _)| step.to_string());
    let params =
        names.iter().map(|name| match trial.params.get(*name).map(|suggestion| suggestion.value()) {
            Some(serde_json::Value::Number(number)) if number.is_f64() => {
                short(number.as_f64().unwrap_or(f64::NAN))
            }
            Some(serde_json::Value::String(text)) => text,
            Some(value) => value.to_string(),
            None => String::new(),
        });
    [mark.to_owned(), trial.number.to_string(), state.to_owned(), step, value]
        .into_iter()
        .chain(params)
        .collect()
}

/// Formats a number with four significant digits.
fn short(number: f64) -> String {
    let size = number.abs();
    if number == 0.0 || (1e-3..1e5).contains(&size) {
        let digits = if size > 0.0 { (3.0 - size.log10().floor()).clamp(0.0, 6.0) as usize } else { 0 };
        format!("{number:.digits$}")
    } else {
        format!("{number:.3e}")
    }
}

/// Aligns columns to the right.
fn aligned(lines: &[Vec<String>]) -> String {
    let columns = lines.iter().map(Vec::len).max().unwrap_or(0);
    let width =
        |at: usize| lines.iter().filter_map(|line| line.get(at)).map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|at| width(at).unwrap_or(0)).collect();
    let mut text = String::new();
    for line in lines {
        let cells: Vec<String> =
            line.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
        text += cells.join("  ").trim_end();
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Direction, Distribution, Outcome, SearchSpace, Storage, Study};

    #[test]
    fn a_study_fits_its_table() {
        let study = Study::open(Storage::memory(), "cart", &[Direction::Maximize]).unwrap();
        assert_eq!(study.inspect(|study| table_from_study(study, 5)).lines().count(), 2);
        let space = SearchSpace::new()
            .with("lr", Distribution::log_float(1e-5, 1e-5).unwrap())
            .and_then(|space| space.with("opt", Distribution::categorical(["adam"])?))
            .unwrap();
        for value in [1.0, 475.25, 3.0] {
            study.ask(&space).unwrap().tell(Outcome::from(value)).unwrap();
        }
        study.ask(&space).unwrap().report(7, 0.5).unwrap();
        let text = study.inspect(|study| table_from_study(study, 2));
        let wanted = "cart: 4 trials (3 complete, 1 running)\n\
                      \x20     trial     state  step   value        lr   opt\n\
                      best      1  complete         475.2  1.000e-5  adam\n\
                      \x20         2  complete         3.000  1.000e-5  adam\n\
                      \x20         3   running     7  0.5000  1.000e-5  adam\n";
        assert_eq!(text, wanted, "{text}");
    }

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, 1e-7, 0.012345, -12.3456, 54321.0, 1e9, f64::INFINITY].map(short);
        assert_eq!(texts, ["0", "1.000e-7", "0.01235", "-12.35", "54321", "1.000e9", "inf"]);
    }
}
