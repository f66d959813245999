//! Output folder of a training.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use opendr_engine::{Error, Result, ResultExt};

use super::FitOptions;

/// Default folder of runs.
const RUNS: &str = "runs";

impl FitOptions {
    /// Returns the output folder of a training of the learner `name`: `out`, else a new folder `runs/NAME-DATE` or, for a resumed
    /// training, the last one.
    ///
    /// # Errors
    /// `NotFound` when there is no run to resume.
    pub fn output_folder(&self, name: &str) -> Result<PathBuf> {
        match &self.out {
            Some(output) => Ok(output.clone()),
            None if self.resume => last_run(Path::new(RUNS), name),
            None => Ok(new_run(Path::new(RUNS), name, &stamp(SystemTime::now()))),
        }
    }
}

/// Checks that the training would overwrite nothing.
///
/// # Errors
/// `InvalidInput` when the folder is not empty, unless a training is resumed.
pub(super) fn check(folder: &Path, resume: bool) -> Result<()> {
    let is_empty = fs::read_dir(folder).map_or(true, |mut entries| entries.next().is_none());
    if resume || is_empty {
        return Ok(());
    }
    Err(Error::invalid_input(format!(
        "{} is not empty: resume the training in it, or name another folder",
        folder.display()
    )))
}

/// Creates the folder.
///
/// # Errors
/// `Io` when the folder cannot be created.
pub(super) fn make(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).context(|| format!("creating {}", folder.display()))
}

fn last_run(runs: &Path, name: &str) -> Result<PathBuf> {
    let entries = fs::read_dir(runs).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let is_of_learner = |run: &String| {
        let date = run.strip_prefix(name).and_then(|rest| rest.strip_prefix('-'));
        date.is_some_and(|date| date.starts_with(|digit: char| digit.is_ascii_digit()))
    };
    let last = names.filter(is_of_learner).max().map(|run| runs.join(run));
    last.ok_or_else(|| {
        let runs = runs.display();
        Error::not_found(format!("there is no run of {name} in {runs} to resume; name its folder"))
    })
}

fn new_run(runs: &Path, name: &str, stamp: &str) -> PathBuf {
    let names = (1..).map(|count| match count {
        1 => format!("{name}-{stamp}"),
        _ => format!("{name}-{stamp}-{count}"),
    });
    let mut free = names.map(|run| runs.join(run)).filter(|folder| !folder.exists());
    free.next().unwrap_or_else(|| runs.join(name))
}

/// Returns date and time in UTC as `20261121-174530`, whose text order is the order in time.
fn stamp(now: SystemTime) -> String {
    let seconds = now.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (day, time) = (seconds / 86_400, seconds % 86_400);
    let (year, month, day) = date_from_day(day);
    format!("{year:04}{month:02}{day:02}-{:02}{:02}{:02}", time / 3600, time / 60 % 60, time % 60)
}

/// Returns year, month and day of a day since 1970-01-01, by 400-year eras that begin in March (Howard Hinnant,
/// `civil_from_days`).
fn date_from_day(day: u64) -> (u64, u64, u64) {
    let day = day + 719_468;
    let (era, of_era) = (day / 146_097, day % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    (era * 400 + year + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn stamps_are_dates() {
        let at = |seconds| stamp(UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!(at(0), "19700101-000000");
        assert_eq!(at(951_782_400 + 86_399), "20000229-235959");
        assert_eq!(at(1_795_286_730), "20261121-184530");
    }

    #[test]
    fn the_last_run_is_resumed_and_a_new_one_has_a_name_of_its_own() {
        let runs = std::env::temp_dir().join(format!("opendr-runs-{}", std::process::id()));
        assert!(last_run(&runs, "ssd").unwrap_err().to_string().contains("no run of ssd"));
        for run in ["ssd-20260102-000000", "ssd-20251231-235959", "ssd-lite-20270101-000000", "ssd"] {
            fs::create_dir_all(runs.join(run)).unwrap();
        }
        assert_eq!(last_run(&runs, "ssd").unwrap(), runs.join("ssd-20260102-000000"));
        assert_eq!(new_run(&runs, "ssd", "20260102-000000"), runs.join("ssd-20260102-000000-2"));
        assert!(check(&runs, false).unwrap_err().to_string().contains("is not empty"));
        check(&runs, true).unwrap();
        check(&runs.join("ssd"), false).unwrap();
        check(&runs.join("none"), false).unwrap();
        fs::remove_dir_all(runs).unwrap();
    }
}
