//! Figures as SVG, without embedded fonts or scripts.

mod axis;
mod bars;
mod curves;
mod markup;
mod matrix;

use opendr_metrics::{Curves, Figure};

use markup::opening;

/// Returns a figure's name and its SVG text.
pub fn svg_from_figure(figure: &Figure) -> (&str, String) {
    match figure {
        Figure::Curves(curves) => (&curves.name, curves::svg(curves)),
        Figure::Matrix(matrix) => (&matrix.name, matrix::svg(matrix)),
        Figure::Bars(bars) => (&bars.name, bars::svg(bars)),
        _ => ("figure", String::new()),
    }
}

/// Returns curves stacked vertically in one image, as SVG text.
pub fn svg_from_panels(panels: &[Curves]) -> String {
    let mut svg = opening(curves::WIDTH, curves::HEIGHT * panels.len() as f64, "");
    for (at, panel) in panels.iter().enumerate() {
        let inner =
            curves::svg(panel).replacen("<svg ", &format!("<svg y=\"{}\" ", curves::HEIGHT * at as f64), 1);
        svg.push_str(&inner);
    }
    svg + "</svg>\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_metrics::{Bars, Line, Matrix};

    #[test]
    fn figures_are_well_formed_for_any_content() {
        let line =
            |label: &str, points: &[[f64; 2]]| Line { label: label.to_owned(), points: points.to_vec() };
        let curves = Curves {
            name: "loss".to_owned(),
            title: "a < b & \"c\"".to_owned(),
            x: "step".to_owned(),
            y: "loss".to_owned(),
            lines: vec![
                line("train", &[[0.0, 3.0], [5.0, f64::NAN], [10.0, 1.0]]),
                line("flat", &[[3.0, 2.0]]),
                line("none", &[]),
                line("dots", &[[4.0, 2.0], [f64::NAN; 2], [6.0, 2.5], [f64::NAN; 2]]),
            ],
        };
        let matrix = Matrix {
            name: "confusion".to_owned(),
            title: String::new(),
            labels: vec!["<cat>".to_owned(), "dog".to_owned()],
            counts: vec![3, 0, 1, 12_345],
        };
        let bars = Bars {
            name: "importance".to_owned(),
            title: "t".to_owned(),
            x: "share".to_owned(),
            bars: vec![
                ("<cat>".to_owned(), 0.7),
                ("none".to_owned(), f64::NAN),
                ("dog".to_owned(), f64::INFINITY),
            ],
        };
        let empty = [Figure::Curves(Curves::default()), Figure::Bars(Bars::default())];
        for figure in
            [Figure::Curves(curves), Figure::Matrix(matrix), Figure::Bars(bars)].into_iter().chain(empty)
        {
            let (_, svg) = svg_from_figure(&figure);
            assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"), "{svg}");
            assert!(!svg.contains("NaN") && !svg.contains("inf") && !svg.contains("<cat>"), "{svg}");
            let dots = if svg.contains(">dots</text>") { 5 } else { 0 };
            assert_eq!(svg.matches("h0").count(), dots, "single points are dots");
            assert_eq!(svg.matches("<text").count(), svg.matches("</text>").count());
        }
    }
}
