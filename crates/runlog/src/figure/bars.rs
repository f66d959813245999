//! Horizontal bar charts.

use std::fmt::Write as _;

use opendr_metrics::Bars;

use super::markup::{escaped, opening};

const WIDTH: f64 = 640.0;
const LABELS: f64 = 170.0;
const RIGHT: f64 = 70.0;
const TOP: f64 = 40.0;
const ROW: f64 = 26.0;
const BOTTOM: f64 = 34.0;

pub fn svg(bars: &Bars) -> String {
    let longest =
        bars.bars.iter().map(|(_, number)| *number).filter(|number| number.is_finite()).fold(0.0, f64::max);
    let height = TOP + ROW * bars.bars.len() as f64 + BOTTOM;
    let mut svg = opening(WIDTH, height, &bars.title);
    // Writing to a String cannot fail.
    let mut add = |text: std::fmt::Arguments<'_>| svg.write_fmt(text).is_ok();
    for (at, (label, number)) in bars.bars.iter().enumerate() {
        let y = TOP + ROW * at as f64;
        let share = if longest > 0.0 && number.is_finite() { (number / longest).max(0.0) } else { 0.0 };
        let length = share * (WIDTH - LABELS - RIGHT);
        let number = if number.is_finite() { format!("{number:.3}") } else { String::new() };
        add(format_args!(
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>\
             <rect x=\"{LABELS}\" y=\"{:.1}\" width=\"{length:.1}\" height=\"{}\" fill=\"#0072b2\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\">{number}</text>\n",
            LABELS - 8.0,
            y + ROW / 2.0 + 4.0,
            escaped(label),
            y + 3.0,
            ROW - 6.0,
            LABELS + length + 6.0,
            y + ROW / 2.0 + 4.0
        ));
    }
    add(format_args!(
        "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\n",
        (LABELS + WIDTH - RIGHT) / 2.0,
        height - 10.0,
        escaped(&bars.x)
    ));
    svg + "</svg>\n"
}
