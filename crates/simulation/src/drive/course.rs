//! The road as straights and arcs.

use std::f64::consts::FRAC_PI_2;

use opendr_engine::Random;

use super::{Course, DriveOptions};
use crate::sine_cosine::sine_cosine;

/// A place on the road: position in metres and direction in radians from the x axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub position: [f64; 2],
    pub yaw: f64,
}

/// A road of constant curvatures.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Road {
    /// Start of each piece: distance along the road, place, curvature to the left in 1/m.
    pieces: Vec<(f64, Place, f64)>,
    /// Length of the drive.
    pub length: f64,
}

/// Radius of the loop's corners, in metres.
const CORNER: f64 = 10.0;

impl Road {
    pub fn new(options: &DriveOptions, random: &mut Random) -> Self {
        let mut road = Self { pieces: Vec::new(), length: options.length };
        let mut end = (0.0, Place { position: [0.0; 2], yaw: 0.0 });
        let mut piece = |length: f64, curvature: f64| {
            road.pieces.push((end.0, end.1, curvature));
            end = (end.0 + length, ahead(end.1, curvature, length));
        };
        match options.course {
            // The last piece goes on for ever.
            Course::Straight => piece(options.length, 0.0),
            Course::Curves => {
                let mut side = if random.chance(0.5) { 1.0 } else { -1.0 };
                let mut left = options.length;
                while left > 0.0 {
                    let straight = f64::from(random.uniform(10.0, 35.0));
                    let (radius, angle) =
                        (f64::from(random.uniform(14.0, 40.0)), f64::from(random.uniform(0.3, 1.1)));
                    piece(straight, 0.0);
                    piece(radius * angle, side / radius);
                    left -= straight + radius * angle;
                    side = -side;
                }
                piece(1.0, 0.0);
            }
            Course::Loop => {
                let longer = f64::from(random.uniform(1.0, 1.25));
                let sides = [options.block * longer, options.block / longer].map(|side| side - 2.0 * CORNER);
                let quarter = FRAC_PI_2 * CORNER;
                // From the middle of a side.
                let straights = [0.5 * sides[0], sides[1], sides[0], sides[1]];
                for straight in straights {
                    piece(straight, 0.0);
                    piece(quarter, 1.0 / CORNER);
                }
                piece(0.5 * sides[0], 0.0);
                let around = 2.0 * (sides[0] + sides[1]) + 4.0 * quarter;
                road.length = 1.1 * around;
                for straight in straights {
                    piece(straight, 0.0);
                    piece(quarter, 1.0 / CORNER);
                }
            }
        }
        road
    }

    /// Returns the place at a distance along the road; before the start and after the last piece it goes on.
    pub fn at(&self, distance: f64) -> Place {
        let number = self.pieces.partition_point(|(start, ..)| *start <= distance).saturating_sub(1);
        let (start, place, curvature) = self.pieces[number];
        let curvature = if distance < 0.0 { 0.0 } else { curvature };
        ahead(place, curvature, distance - start)
    }
}

/// Returns the place after an arc.
fn ahead(Place { position: [x, y], yaw }: Place, curvature: f64, length: f64) -> Place {
    let (sine, cosine) = sine_cosine(yaw);
    let turned = yaw + curvature * length;
    let [dx, dy] = if curvature == 0.0 {
        [cosine * length, sine * length]
    } else {
        let (sine_after, cosine_after) = sine_cosine(turned);
        [(sine_after - sine) / curvature, (cosine - cosine_after) / curvature]
    };
    Place { position: [x + dx, y + dy], yaw: turned }
}
