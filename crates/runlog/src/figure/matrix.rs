//! Confusion matrices: rows are the ground truth, columns the predictions, shades the fraction of a row.

use std::fmt::Write as _;

use opendr_metrics::Matrix;

use super::markup::{escaped, opening};

/// Maximum number of classes for which cells show numbers.
const MAX_NUMBERED_CLASSES: usize = 24;
const LABELS: f64 = 130.0;
const TOP: f64 = 40.0;

pub fn svg(matrix: &Matrix) -> String {
    let count = matrix.labels.len();
    let cell = (640.0 / count.max(1) as f64).clamp(6.0, 56.0);
    let side = cell * count as f64;
    let (width, height) = (LABELS + side + 30.0, TOP + side + LABELS);
    let mut svg = opening(width.max(300.0), height, &matrix.title);
    // Writing to a String cannot fail.
    let mut add = |text: std::fmt::Arguments<'_>| svg.write_fmt(text).is_ok();
    for (row, counts) in matrix.counts.chunks_exact(count.max(1)).enumerate() {
        let total = counts.iter().sum::<u64>().max(1);
        for (column, number) in counts.iter().enumerate() {
            let share = *number as f64 / total as f64;
            let (x, y) = (LABELS + cell * column as f64, TOP + cell * row as f64);
            let shade = |full: f64| (255.0 - share * (255.0 - full)).round();
            add(format_args!(
                "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{cell:.1}\" height=\"{cell:.1}\" \
                 fill=\"rgb({},{},{})\" stroke=\"#eee\"/>",
                shade(0.0),
                shade(90.0),
                shade(160.0)
            ));
            if count <= MAX_NUMBERED_CLASSES && *number > 0 {
                let ink = if share > 0.5 { "#fff" } else { "#333" };
                add(format_args!(
                    "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" font-size=\"{:.1}\" fill=\"{ink}\">{number}</text>",
                    x + cell / 2.0,
                    y + cell / 2.0 + 4.0,
                    (cell / 3.4).min(12.0)
                ));
            }
        }
        add(format_args!("\n"));
    }
    let size = (cell * 0.8).min(12.0);
    for (at, label) in matrix.labels.iter().enumerate() {
        let middle = cell * (at as f64 + 0.5);
        let label = escaped(label);
        add(format_args!(
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" font-size=\"{size:.1}\">{label}</text>\
             <text transform=\"translate({:.1} {:.1}) rotate(-60)\" text-anchor=\"end\" font-size=\"{size:.1}\">{label}</text>\n",
            LABELS - 6.0,
            TOP + middle + 4.0,
            LABELS + middle + 4.0,
            TOP + side + 12.0
        ));
    }
    svg + "</svg>\n"
}
