//! Line charts.

use std::fmt::Write as _;

use opendr_metrics::Curves;

use super::axis::Axis;
use super::markup::{escaped, opening};

/// Colours that are distinguishable with colour vision deficiency (Okabe and Ito 2008).
const COLOURS: [&str; 8] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#b0a000"];
pub const WIDTH: f64 = 720.0;
pub const HEIGHT: f64 = 480.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 200.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 55.0;
/// Maximum lines of the legend.
const MAX_LABELS: usize = 22;

pub fn svg(curves: &Curves) -> String {
    let points = || curves.lines.iter().flat_map(|line| &line.points);
    let across = Axis::around(points().map(|point| point[0]));
    let up = Axis::around(points().map(|point| point[1]));
    let x = |value: f64| LEFT + across.share(value) * (WIDTH - LEFT - RIGHT);
    let y = |value: f64| HEIGHT - BOTTOM - up.share(value) * (HEIGHT - TOP - BOTTOM);
    let mut svg = opening(WIDTH, HEIGHT, &curves.title);
    // Writing to a String cannot fail.
    let mut add = |text: std::fmt::Arguments<'_>| svg.write_fmt(text).is_ok();
    for (value, text) in across.ticks() {
        let (x, bottom) = (x(value), HEIGHT - BOTTOM);
        add(format_args!(
            "<path d=\"M{x:.1} {TOP}V{bottom}\" stroke=\"#ddd\"/><text x=\"{x:.1}\" y=\"{}\" \
             text-anchor=\"middle\">{text}</text>\n",
            bottom + 18.0
        ));
    }
    for (value, text) in up.ticks() {
        let (y, right) = (y(value), WIDTH - RIGHT);
        add(format_args!(
            "<path d=\"M{LEFT} {y:.1}H{right}\" stroke=\"#ddd\"/><text x=\"{}\" y=\"{:.1}\" \
             text-anchor=\"end\">{text}</text>\n",
            LEFT - 8.0,
            y + 4.0
        ));
    }
    add(format_args!(
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
        (LEFT + WIDTH - RIGHT) / 2.0,
        HEIGHT - 14.0,
        escaped(&curves.x)
    ));
    let middle = (TOP + HEIGHT - BOTTOM) / 2.0;
    add(format_args!(
        "<text transform=\"translate(18 {middle}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
        escaped(&curves.y)
    ));
    for (at, line) in curves.lines.iter().enumerate() {
        let colour = COLOURS[at % COLOURS.len()];
        let mut path = String::new();
        for run in line.points.split(|[px, py]| !(px.is_finite() && py.is_finite())) {
            for (at, [px, py]) in run.iter().enumerate() {
                write!(path, "{}{:.1} {:.1}", if at == 0 { 'M' } else { 'L' }, x(*px), y(*py)).ok();
            }
            // A single point is drawn as a dot.
            path.push_str(if run.len() == 1 { "h0" } else { "" });
        }
        let width = if path.contains("h0") && !path.contains('L') { 4 } else { 2 };
        add(format_args!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"round\"/>\n"
        ));
        if at < MAX_LABELS {
            let (x, y) = (WIDTH - RIGHT + 14.0, TOP + 10.0 + 18.0 * at as f64);
            add(format_args!(
                "<path d=\"M{x} {y}h18\" stroke=\"{colour}\" stroke-width=\"3\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
                x + 24.0,
                y + 4.0,
                escaped(&line.label)
            ));
        }
    }
    svg + "</svg>\n"
}
