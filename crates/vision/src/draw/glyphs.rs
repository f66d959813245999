//! The built-in stroke font: letters as strokes of a round pen, one table for every size.
//!
//! A glyph is a list of strokes, separated by spaces. A stroke is a sequence of points of two characters each, `x`
//! and `y` as digits of base 36, in half grid units: capitals reach from `y` 0 down to the base line at 14 (`e`),
//! small letters begin at 4, descenders end at 18 (`i`). `~` before a point marks a control point of a quadratic
//! curve; between two of them lies an implied point, as in TrueType. A full stop closes the stroke.

use crate::draw::canvas::Point;

/// Height of capitals, from line centre to line centre, in grid units.
pub(super) const CAP_HEIGHT: f32 = 7.0;

/// Depth of descenders below the base line, in grid units.
pub(super) const DESCENT: f32 = 2.0;

/// Glyph of characters that the font lacks: an empty frame.
const UNKNOWN: &str = "00808e0e.";

/// Characters from `!` to `~`, in order of their code points.
#[rustfmt::skip]
const GLYPHS: [(char, &str); 94] = [
    ('!', "0009 0e"), ('"', "0004 3034"), ('#', "302e 705e 1494 0a8a"), ('$', "83~80~00~07~87~8e~0e0b 404e"),
    ('%', "800e ~00~30~34~04. ~5a~8a~8e~5e."), ('&', "8e14~00~60~6405~0e~8e88"), ('\'', "0004"),
    ('(', "30~03~0b3e"), (')', "00~33~3b0e"), ('*', "414b 0379 7309"), ('+', "0888 444c"), (',', "1e0h"),
    ('-', "0868"), ('.', "0e"), ('/', "700e"),
    ('0', "~00~80~8e~0e."), ('1', "13404e 1e7e"), ('2', "04~00~80~840e8e"), ('3', "03~00~80~8636 36~86~8e~0e0b"),
    ('4', "6e600a8a"), ('5', "80000646~86~8e~0e0c"), ('6', "70~000a ~06~86~8e~0e."), ('7', "00803e"),
    ('8', "~10~70~76~16. ~06~86~8e~0e."), ('9', "~00~80~88~08. 84~8e1e"),
    (':', "06 0e"), (';', "16 1e0h"), ('<', "64086c"), ('=', "0686 0a8a"), ('>', "04680c"),
    ('?', "03~00~80~87~474a 4e"), ('@', "8e~0e~00~a0~ab~7b74 ~34~74~7b~3b."),
    ('A', "0e408e 1a7a"), ('B', "0e0040~80~864606 46~86~8e4e0e"), ('C', "83~80~00~0e~8e8b"),
    ('D', "0e0030~80~8e3e0e"), ('E', "80000e8e 0666"), ('F', "80000e 0666"), ('G', "83~80~00~0e~8e8848"),
    ('H', "000e 808e 0686"), ('I', "0040 202e 0e4e"), ('J', "606a~6e~0e0a"), ('K', "000e 8008 358e"),
    ('L', "000e7e"), ('M', "0e0058a0ae"), ('N', "0e008e80"), ('O', "~00~80~8e~0e."), ('P', "0e0040~80~884808"),
    ('Q', "~00~80~8e~0e. 5a8e"), ('R', "0e0040~80~884808 488e"), ('S', "83~80~00~07~87~8e~0e0b"),
    ('T', "0080 404e"), ('U', "0009~0e~8e8980"), ('V', "004e80"), ('W', "003e629ec0"), ('X', "008e 800e"),
    ('Y', "004780 474e"), ('Z', "00800e8e"),
    ('[', "30000g3g"), ('\\', "007e"), (']', "00303g0g"), ('^', "034063"), ('_', "0g8g"), ('`', "0023"),
    ('a', "16~14~84888e 8838~08~0e3e~8e8a"), ('b', "000e ~04~84~8e~0e."), ('c', "86~84~04~0e~8e8c"),
    ('d', "808e ~04~84~8e~0e."), ('e', "0888~84~04~0e~8e8c"), ('f', "60~20242e 0464"),
    ('g', "848e~8i~0i0g ~04~84~8e~0e."), ('h', "000e 09~04~84898e"), ('i', "040e 00"), ('j', "343e~3i0i 30"),
    ('k', "000e 740b 388e"), ('l', "000b~0e3e"), ('m', "040e 08~04~64686e 68~64~c4c8ce"),
    ('n', "040e 09~04~84898e"), ('o', "~04~84~8e~0e."), ('p', "040i ~04~84~8e~0e."), ('q', "848i ~04~84~8e~0e."),
    ('r', "040e 09~0454"), ('s', "86~84~04~09~89~8e~0e0c"), ('t', "212b~2e6e 0464"), ('u', "0409~0e~8e89 848e"),
    ('v', "044e84"), ('w', "043e659ec4"), ('x', "048e 840e"), ('y', "044e 842i"), ('z', "04840e8e"),
    ('{', "40~20~2707 07~27~2e4e"), ('|', "000g"), ('}', "00~20~2747 47~27~2e0e"), ('~', "0a~2649~6c88"),
];

/// Returns the strokes of a character, as polylines in grid units, and its width.
pub(super) fn glyph(letter: char) -> (Vec<Vec<Point>>, f32) {
    if letter.is_whitespace() {
        return (Vec::new(), 2.0);
    }
    let found = (letter as usize).checked_sub('!' as usize).and_then(|index| GLYPHS.get(index));
    let strokes: Vec<Vec<Point>> =
        found.map_or(UNKNOWN, |(_, text)| text).split(' ').map(polyline_from_text).collect();
    let width = strokes.iter().flatten().map(|point| point[0]).fold(0.0, f32::max);
    (strokes, width)
}

/// Parses one stroke and flattens its curves to short lines.
fn polyline_from_text(text: &str) -> Vec<Point> {
    let (text, closed) = text.strip_suffix('.').map_or((text, false), |text| (text, true));
    let mut points: Vec<(Point, bool)> = Vec::new();
    let mut letters = text.chars().peekable();
    while letters.peek().is_some() {
        let control = letters.next_if_eq(&'~').is_some();
        let mut part = || letters.next().and_then(|letter| letter.to_digit(36)).unwrap_or(0) as f32 / 2.0;
        points.push(([part(), part()], control));
    }
    let Some(&first) = points.first() else { return Vec::new() };
    if closed {
        points.push(first);
        // A loop of control points only begins at an implied point.
        if first.1 {
            let second = points.get(1).unwrap_or(&first).0;
            points.push((middle(first.0, second), false));
            points[0] = (middle(first.0, second), false);
        }
    }
    flatten(&points)
}

/// Flattens points and control points to lines, as in TrueType.
fn flatten(points: &[(Point, bool)]) -> Vec<Point> {
    const PIECES: usize = 8;
    let mut line: Vec<Point> = Vec::with_capacity(points.len() * PIECES);
    let mut control: Option<Point> = None;
    for &(point, is_control) in points {
        let (start, bend) = match (line.last().copied(), control) {
            (Some(start), Some(bend)) => (start, bend),
            _ if is_control => {
                control = Some(point);
                continue;
            }
            _ => {
                line.push(point);
                continue;
            }
        };
        let end = if is_control { middle(bend, point) } else { point };
        control = is_control.then_some(point);
        for piece in 1..=PIECES {
            let t = piece as f32 / PIECES as f32;
            line.push([0, 1].map(|axis| {
                (1.0 - t).powi(2) * start[axis] + 2.0 * t * (1.0 - t) * bend[axis] + t * t * end[axis]
            }));
        }
    }
    line
}

fn middle(a: Point, b: Point) -> Point {
    [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_in_order_and_well_formed() {
        for ((letter, text), wanted) in GLYPHS.iter().zip('!'..='~') {
            assert_eq!(*letter, wanted);
            for stroke in text.split(' ') {
                let letters = stroke.chars().filter(|letter| !"~.".contains(*letter)).count();
                assert!(letters > 0 && letters % 2 == 0, "{letter} {stroke}");
            }
            let (strokes, width) = glyph(*letter);
            assert!(strokes.iter().all(|stroke| !stroke.is_empty()) && width <= 6.0, "{letter}");
            assert!(strokes.iter().flatten().all(|point| point[1] <= CAP_HEIGHT + DESCENT), "{letter}");
        }
    }

    #[test]
    fn no_two_letters_look_the_same() {
        let drawn: Vec<_> =
            ('!'..='~').filter(|letter| !"0O".contains(*letter)).map(|c| glyph(c).0).collect();
        for (index, one) in drawn.iter().enumerate() {
            assert!(drawn[..index].iter().all(|other| one != other), "{index}");
        }
    }

    #[test]
    fn unknown_letters_are_frames() {
        assert_eq!(glyph('字'), glyph('\u{1}'));
        assert_eq!(glyph('字').0[0].len(), 5);
    }

    #[test]
    fn closed_curves_close() {
        let (strokes, _) = glyph('o');
        assert_eq!(strokes[0].first(), strokes[0].last());
    }
}
