//! Curves that the page of `--view` displays: those of a training, and those of a study.

use std::path::PathBuf;

use opendr::runlog::read_scalars;
use opendr::tuning::{Storage, StudyRecord};
use opendr::viewer::{Curve, CurveSource};

/// Returns the curves of a training that logs into `log`.
pub fn of_training(log: PathBuf) -> CurveSource {
    let read = move || {
        let curves = read_scalars(&log)?.into_iter();
        Ok(curves.map(|(name, points)| Curve { name, points, is_scatter: false }).collect())
    };
    CurveSource { unit: "step", read: Box::new(read) }
}

/// Returns the curves of the study whose journal is `journal`.
pub fn of_study(journal: PathBuf) -> CurveSource {
    let read = move || {
        if !journal.is_file() {
            return Ok(Vec::new());
        }
        Ok(Storage::journal(&journal)?.studies().next().map(curves_of_study).unwrap_or_default())
    };
    CurveSource { unit: "trial", read: Box::new(read) }
}

/// Returns the best value and the values of complete trials over their numbers, and the values over each parameter that is a number.
fn curves_of_study(study: &StudyRecord) -> Vec<Curve> {
    let best = Curve { name: "best value".to_owned(), points: study.best_so_far(), is_scatter: false };
    let scatter = |name: String, points: Vec<_>| Curve { name, points, is_scatter: true };
    let values: Vec<_> = study.complete().filter_map(|trial| Some((trial, trial.value()?))).collect();
    let mut names: Vec<&String> = values.iter().flat_map(|(trial, _)| trial.params.keys()).collect();
    names.sort();
    names.dedup();
    let of_params = names.into_iter().map(|name| {
        let points = values.iter().filter_map(|(trial, value)| {
            let number = trial.params.get(name)?.value().as_f64()?;
            Some([number, *value])
        });
        scatter(format!("value over {name}"), points.collect())
    });
    let curves = [best, scatter("value of each trial".to_owned(), study.history())].into_iter();
    curves.chain(of_params).filter(|curve| !curve.points.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use opendr::tuning::{Direction, Distribution, Outcome, SearchSpace, Study};

    use super::*;

    #[test]
    fn a_study_has_its_best_value_and_points_of_each_parameter() {
        let folder = std::env::temp_dir().join(format!("opendr-curves-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let journal = folder.join("study.log");
        let curves = of_study(journal.clone());
        assert_eq!((curves.read)().unwrap(), []);
        let storage = Storage::journal(&journal).unwrap();
        let study = Study::open(storage, "lines", &[Direction::Maximize]).unwrap();
        let space = SearchSpace::new().with("x", Distribution::float(0.0, 1.0).unwrap()).unwrap();
        for value in [0.3, 0.1, 0.7] {
            study.ask(&space).unwrap().tell(Outcome::from(value)).unwrap();
        }
        let curves = (curves.read)().unwrap();
        assert_eq!(curves.len(), 3);
        assert_eq!(curves[0].points, [[0.0, 0.3], [1.0, 0.3], [2.0, 0.7]]);
        assert_eq!(curves[1].points, [[0.0, 0.3], [1.0, 0.1], [2.0, 0.7]]);
        assert_eq!((curves[2].name.as_str(), curves[2].is_scatter), ("value over x", true));
        assert_eq!(curves[2].points[1][1], 0.1);
        fs::remove_dir_all(folder).unwrap();
    }
}
