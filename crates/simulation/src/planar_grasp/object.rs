//! The objects.

use super::{GRASP_HEIGHT, Grasp};
use crate::planar::vector::{Vector2, plus};
use crate::planar::{Body, Convex, Drive, Part, Pose};
use crate::sine_cosine::sine_cosine;

opendr_engine::choices! {
    /// An object of `PlanarGrasp-v1`.
    pub enum GraspObject {
        /// A handle with a head across its end.
        Hammer = "hammer",
        /// A bar with a wide and a narrow end.
        Wrench = "wrench",
        /// Two arms at a right angle.
        Bracket = "bracket",
        /// A thick handle and a thin shaft.
        Screwdriver = "screwdriver",
        /// A round body with a handle.
        Mug = "mug",
    }
}

/// Density of the objects, kg/m^3: wood.
const DENSITY: f64 = 700.0;
/// Friction of the table.
const TABLE_FRICTION: f64 = 0.4;

type Rectangle = (Vector2, Vector2);

impl GraspObject {
    /// All objects.
    pub const ALL: [Self; 5] = [Self::Hammer, Self::Wrench, Self::Bracket, Self::Screwdriver, Self::Mug];

    fn shapes(self) -> Vec<Convex> {
        let rectangles: &[Rectangle] = match self {
            Self::Hammer => &[([0.0, -0.02], [0.009, 0.058]), ([0.0, 0.05], [0.03, 0.012])],
            Self::Wrench => &[
                ([0.0, 0.0], [0.008, 0.046]),
                ([0.0, 0.06], [0.021, 0.014]),
                ([0.0, -0.055], [0.013, 0.009]),
            ],
            Self::Bracket => &[([-0.03, 0.0], [0.01, 0.05]), ([0.008, -0.04], [0.028, 0.01])],
            Self::Screwdriver => &[([0.0, -0.035], [0.014, 0.03]), ([0.0, 0.032], [0.005, 0.037])],
            Self::Mug => &[([0.042, 0.0], [0.014, 0.007])],
        };
        let mut shapes: Vec<_> =
            rectangles.iter().map(|(centre, half)| Convex::rectangle(*centre, *half)).collect();
        if self == Self::Mug {
            let corners: [Vector2; 8] = std::array::from_fn(|at| {
                let (sine, cosine) = sine_cosine(std::f64::consts::FRAC_PI_4 * (at as f64 + 0.5));
                [0.03 * cosine, 0.03 * sine]
            });
            shapes.push(Convex::polygon(&corners));
        }
        shapes
    }

    /// Returns the body about its centre of mass.
    pub(super) fn body(self, friction: f64) -> Body {
        let (shapes, _) = self.centred();
        let moments = || shapes.iter().map(|shape| shape.moments());
        let area: f64 = moments().map(|(area, ..)| area).sum();
        let parts: Vec<_> = shapes.iter().map(|shape| Part { shape: *shape, slides: 0.0 }).collect();
        let own: f64 = moments().map(|(_, _, second)| second).sum();
        let (mass, radius) = (DENSITY * GRASP_HEIGHT * area, (own / area).sqrt());
        let mut body = Body::fixed(&parts, friction).with_mass(mass, mass * radius * radius);
        body.drive = Drive::table_friction(TABLE_FRICTION, mass, 0.9 * radius);
        body
    }

    /// Returns the shapes about the centre of mass, and where that was.
    fn centred(self) -> (Vec<Convex>, Vector2) {
        let mut shapes = self.shapes();
        let (mut area, mut middle) = (0.0, [0.0; 2]);
        for (own, first, _) in shapes.iter().map(Convex::moments) {
            area += own;
            middle = plus(middle, first, 1.0);
        }
        let middle = middle.map(|part| part / area);
        shapes.iter_mut().for_each(|shape| *shape = shape.placed(middle.map(|part| -part), (0.0, 1.0)));
        (shapes, middle)
    }

    /// Returns the grasp that is demonstrated, with the object at a pose.
    pub(super) fn shown_grasp(self, pose: &Pose) -> Grasp {
        let (place, angle, width) = match self {
            Self::Hammer => ([0.0, 0.005], 0.0, 0.045),
            Self::Wrench => ([0.0, 0.005], 0.0, 0.045),
            Self::Bracket => ([-0.03, 0.0], 0.0, 0.045),
            Self::Screwdriver => ([0.0, -0.025], 0.0, 0.055),
            Self::Mug => ([-0.002, 0.0], std::f64::consts::FRAC_PI_2, 0.08),
        };
        let (_, middle) = self.centred();
        Grasp { place: pose.outside(plus(place, middle, -1.0)), angle: pose.angle + angle, width }
    }

    /// Returns the colour of the object, levels of red, green and blue.
    pub(super) fn colour(self, part: usize) -> [f32; 3] {
        let colours: [[f32; 3]; 3] = match self {
            Self::Hammer => [[165.0, 105.0, 55.0], [75.0, 80.0, 90.0], [0.0; 3]],
            Self::Wrench => [[150.0, 155.0, 165.0], [130.0, 135.0, 150.0], [110.0, 115.0, 130.0]],
            Self::Bracket => [[200.0, 170.0, 60.0], [190.0, 160.0, 55.0], [0.0; 3]],
            Self::Screwdriver => [[200.0, 50.0, 45.0], [145.0, 150.0, 160.0], [0.0; 3]],
            Self::Mug => [[60.0, 95.0, 175.0], [70.0, 110.0, 200.0], [0.0; 3]],
        };
        colours[part % 3]
    }
}
