//! Figures of a study, for `opendr_runlog::svg_from_figure`.

use opendr_metrics::{Bars, Curves, Figure, Line};

use crate::importance::importance_from_study;
use crate::records::StudyRecord;

/// Returns the values of the complete trials by number, as dots, and the best value so far, as a line.
pub fn history_figure(study: &StudyRecord) -> Figure {
    let points = study.history();
    let lines = vec![
        Line { label: "best so far".to_owned(), points: study.best_so_far() },
        // A point between NaNs is drawn as a dot.
        Line {
            label: "trial".to_owned(),
            points: points.iter().flat_map(|point| [*point, [f64::NAN; 2]]).collect(),
        },
    ];
    Figure::Curves(Curves {
        name: "history".to_owned(),
        title: study.name.clone(),
        x: "trial".to_owned(),
        y: "value".to_owned(),
        lines,
    })
}

/// Returns the importance of each parameter as bars: [`importance_from_study`].
pub fn importance_figure(study: &StudyRecord) -> Figure {
    Figure::Bars(Bars {
        name: "importance".to_owned(),
        title: study.name.clone(),
        x: "importance for the best tenth (PED-ANOVA)".to_owned(),
        bars: importance_from_study(study),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Budget, Direction, Distribution, Outcome, Progress, RandomSearch, SearchSpace, Storage, Study,
    };

    #[test]
    fn the_best_value_never_gets_worse() {
        let space = SearchSpace::new().with("x", Distribution::float(0.0, 1.0).unwrap()).unwrap();
        for (direction, sign) in [(Direction::Minimize, 1.0), (Direction::Maximize, -1.0)] {
            let study =
                Study::open(Storage::memory(), "s", &[direction]).unwrap().with_sampler(RandomSearch::new(1));
            let objective = |trial: &crate::Trial<'_>| trial.float("x").map(Outcome::from);
            study.optimize(&space, &Budget::more(20), objective, |_, _| Progress::Continue).unwrap();
            let Figure::Curves(curves) = study.inspect(history_figure) else { panic!() };
            let best = &curves.lines[0].points;
            assert_eq!((best.len(), curves.lines[1].points.len()), (20, 40));
            assert!(best.windows(2).all(|pair| sign * pair[1][1] <= sign * pair[0][1]));
            assert_eq!(best[19][1], study.best().unwrap().value().unwrap());
        }
    }
}
