//! The image of a run's curves: loss and validation metrics over steps.

use opendr_metrics::{Curves, Line};

use crate::figure::svg_from_panels;
use crate::scalar_table::ScalarTable;

/// Maximum points of a line; more are averaged.
const MAX_POINTS: usize = 500;

/// Draws panels of losses, of validation metrics in [0, 1], and of each other metric; `None` when there is nothing
/// to draw.
pub fn svg_from_table(table: &ScalarTable) -> Option<String> {
    let mut panels: Vec<Curves> = Vec::new();
    for tag in table.tags().filter(|tag| tag.starts_with("loss") || tag.starts_with("val_")) {
        let points = table.points(tag);
        let panel = if tag.contains("loss") {
            "loss"
        } else if points.iter().all(|[_, value]| (0.0..=1.0).contains(value)) {
            "validation"
        } else {
            tag
        };
        let line = Line { label: tag.to_owned(), points: thinned(&points) };
        match panels.iter_mut().find(|known| known.name == panel) {
            Some(known) => known.lines.push(line),
            None => panels.push(Curves {
                name: panel.to_owned(),
                title: panel.to_owned(),
                x: "step".to_owned(),
                y: String::new(),
                lines: vec![line],
            }),
        }
    }
    (!panels.is_empty()).then(|| svg_from_panels(&panels))
}

/// Averages neighbouring points to reduce their number; values that are not finite are skipped if a neighbour is finite.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let neighbours = points.len().div_ceil(MAX_POINTS).max(1);
    let mean = |chunk: &[[f64; 2]]| {
        let finite = || chunk.iter().filter(|[_, value]| value.is_finite());
        let count = finite().count() as f64;
        let sum = finite().fold([0.0, 0.0], |sum, point| [sum[0] + point[0], sum[1] + point[1]]);
        sum.map(|sum| sum / count)
    };
    points.chunks(neighbours).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn losses_and_metrics_of_each_scale_have_their_panels() {
        let mut table = ScalarTable::new(std::env::temp_dir().join("opendr-never-written.csv"));
        assert_eq!(svg_from_table(&table), None);
        for step in 0..2000 {
            table.set("loss", step, 1.0 / (step + 1) as f64);
            table.set("lr", step, 0.1);
        }
        table.set("val_loss", 10, f64::NAN);
        table.set("val_map50", 10, 0.4);
        table.set("val_map", 10, 0.2);
        table.set("val_error_px", 10, 11.0);
        let svg = svg_from_table(&table).unwrap();
        assert_eq!(svg.matches("<svg ").count(), 4);
        assert_eq!(svg.matches("</svg>").count(), 4);
        assert!(!svg.contains("NaN") && !svg.contains(">lr<"), "{svg}");
        assert!(
            ["loss", "val_loss", "val_map50", "val_map", "val_error_px"]
                .iter()
                .all(|tag| svg.contains(&format!(">{tag}</text>")))
        );
    }

    #[test]
    fn thinning_keeps_the_mean() {
        let points: Vec<_> = (0..5000).map(|step| [f64::from(step), f64::from(step % 2)]).collect();
        let thin = thinned(&points);
        assert_eq!(thin.len(), MAX_POINTS);
        assert!(thin.iter().all(|point| point[1] == 0.5));
        assert!(thinned(&[[3.0, f64::NAN]])[0][1].is_nan());
    }
}
