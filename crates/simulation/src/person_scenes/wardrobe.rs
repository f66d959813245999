//! Bodies with clothes: from bones to meshes with surfaces.

use opendr_engine::{Random, Result};

use super::body_shape::BodyShape;
use super::frame::{AHEAD, Frame};
use super::skeleton::Bones;
use super::skin::{Limb, Ring, Skin, blended};
use super::surface::{Surface, colour};
use crate::raycast::{Body, Vector};

/// Surfaces and cuts of the clothes of a person.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wardrobe {
    skin: Surface,
    hair: Surface,
    shirt: Surface,
    trousers: Surface,
    shoes: Surface,
    eyes: Surface,
    /// Share of the arm that the sleeve covers.
    sleeve: f32,
    /// Share of the leg that the trousers cover.
    leg: f32,
    /// Whether a skirt hangs from the hips.
    has_skirt: bool,
    /// Whether hair falls to the shoulders, and whether there is any.
    has_long_hair: bool,
    is_bald: bool,
    /// Looseness of the clothes, as a factor of the widths.
    loose: f32,
}

/// Tones of skin from light to dark.
const TONES: [Vector; 5] =
    [[0.94, 0.78, 0.69], [0.86, 0.66, 0.53], [0.74, 0.53, 0.39], [0.52, 0.34, 0.24], [0.33, 0.21, 0.15]];
const HAIR: [Vector; 6] = [
    [0.07, 0.05, 0.04],
    [0.16, 0.1, 0.06],
    [0.35, 0.22, 0.12],
    [0.68, 0.52, 0.3],
    [0.55, 0.55, 0.55],
    [0.45, 0.16, 0.08],
];

impl Wardrobe {
    pub fn draw(random: &mut Random) -> Self {
        let tone = random.uniform(0.88, 1.08);
        let skin = TONES[random.below(TONES.len())].map(|part| (tone * part).min(1.0));
        Self {
            skin: Surface::plain(skin),
            hair: Surface::plain(HAIR[random.below(HAIR.len())]),
            shirt: Surface::fabric(random),
            trousers: Surface::fabric(random),
            shoes: Surface::plain(colour(random)),
            eyes: Surface::plain([0.05, 0.04, 0.04]),
            sleeve: [0.28, 0.45, 0.97][random.below(3)],
            leg: [0.45, 0.97, 0.97][random.below(3)],
            has_skirt: random.chance(0.15),
            has_long_hair: random.chance(0.4),
            is_bald: random.chance(0.08),
            loose: random.uniform(1.0, 1.25),
        }
    }

    /// Returns the bodies of a posed person with their surfaces; all have this label.
    pub fn dress(&self, shape: &BodyShape, bones: &Bones, label: u16) -> Result<Vec<(Body, Surface)>> {
        let [mut skin, mut shirt, mut trousers, mut shoes] = [(); 4].map(|()| Skin::default());
        self.trunk(shape, bones, &mut shirt, &mut trousers);
        skin.tube(neck(shape, bones).into_iter());
        for side in 0..2 {
            self.arm(shape, bones, side, &mut skin, &mut shirt);
            self.leg(shape, bones, side, &mut skin, &mut trousers);
            let foot = bones.foot[side].moved([0.045 * shape.height, 0.0, -0.55 * shape.ankle()]);
            shoes.ellipsoid(&foot, [0.075, 0.028, 0.022].map(|share| share * shape.height), [-1.0, 1.0]);
        }
        let [mut hair, mut eyes] = [(); 2].map(|()| Skin::default());
        self.head(shape, &bones.head, &mut skin, &mut hair, &mut eyes);
        let parts = [
            (skin, self.skin),
            (shirt, self.shirt),
            (trousers, self.trousers),
            (shoes, self.shoes),
            (hair, self.hair),
            (eyes, self.eyes),
        ];
        let worn = parts.into_iter().filter(|(skin, _)| !skin.is_empty());
        worn.map(|(skin, surface)| Ok((skin.body(label)?, surface))).collect()
    }

    fn trunk(&self, shape: &BodyShape, bones: &Bones, shirt: &mut Skin, trousers: &mut Skin) {
        let trunk = shape.trunk();
        let at = |share: f32| {
            let lower = bones.pelvis.moved([0.0, 0.0, share * trunk]);
            let upper = bones.chest.moved([0.0, 0.0, (share - 0.35) * trunk]);
            let blend = ((share - 0.1) / 0.5).clamp(0.0, 1.0);
            blended(&lower, &upper, blend)
        };
        let wide = |aside: f32, ahead: f32| [aside, ahead].map(|share| self.loose * shape.width(share));
        let (hips, shoulders) = (shape.hips, shape.shoulders);
        let rings = [
            (-0.08, wide(0.088 * hips, 0.066)),
            (0.12, wide(0.09 * hips, 0.066)),
            (0.35, wide(0.08, 0.06)),
            (0.6, wide(0.088 * shoulders, 0.066)),
            (0.82, wide(0.092 * shoulders, 0.064)),
            (0.94, wide(0.075 * shoulders, 0.05)),
            (1.0, wide(0.035, 0.035)),
        ];
        shirt.tube(rings.into_iter().map(|(share, radii)| (at(share), radii)));
        let below =
            [(-0.24, wide(0.06, 0.05)), (-0.1, wide(0.087 * hips, 0.065)), (0.02, wide(0.086 * hips, 0.064))];
        trousers.tube(below.into_iter().map(|(share, radii)| (at(share), radii)));
        if self.has_skirt {
            let middle = blended(&bones.thigh[0], &bones.thigh[1], 0.5);
            let hem = middle.moved([0.0, 0.0, -0.85 * shape.thigh()]);
            trousers.tube([(hem, wide(0.15, 0.12)), (at(0.0), wide(0.089 * hips, 0.067))].into_iter());
        }
    }

    fn arm(&self, shape: &BodyShape, bones: &Bones, side: usize, skin: &mut Skin, shirt: &mut Skin) {
        let (upper, lower) = (shape.upper_arm(), shape.forearm());
        let limb = Limb {
            upper: bones.upper_arm[side],
            lower: bones.forearm[side],
            length: upper,
            blend: 0.03 * shape.height,
        };
        let profile = [
            (-0.15, 0.02),
            (0.0, 0.034),
            (0.25, 0.031),
            (0.5, 0.026),
            (0.57, 0.026),
            (0.7, 0.026),
            (0.85, 0.02),
            (1.0, 0.016),
        ];
        let ring = |(share, radius): (f32, f32), loose: f32| {
            let radius = loose * shape.width(radius);
            Ring { at: share * (upper + lower), radii: [radius, radius] }
        };
        skin.limb(&limb, &profile.map(|point| ring(point, 0.93)));
        let sleeve: Vec<_> = covered(&profile, self.sleeve).map(|point| ring(point, self.loose)).collect();
        shirt.limb(&limb, &sleeve);
        let palm = bones.hand[side].moved([0.0, 0.0, -0.045 * shape.height]);
        skin.ellipsoid(&palm, [0.024, 0.012, 0.054].map(|share| share * shape.height), [-1.0, 1.0]);
    }

    fn leg(&self, shape: &BodyShape, bones: &Bones, side: usize, skin: &mut Skin, trousers: &mut Skin) {
        let (upper, lower) = (shape.thigh(), shape.shank());
        let limb = Limb {
            upper: bones.thigh[side],
            lower: bones.shank[side],
            length: upper,
            blend: 0.04 * shape.height,
        };
        let profile = [
            (-0.04, 0.03),
            (0.05, 0.052),
            (0.25, 0.049),
            (0.45, 0.037),
            (0.52, 0.034),
            (0.65, 0.036),
            (0.82, 0.025),
            (1.0, 0.021),
        ];
        let ring = |(share, radius): (f32, f32), loose: f32| {
            let radius = loose * shape.width(radius);
            Ring { at: share * (upper + lower), radii: [radius, radius] }
        };
        skin.limb(&limb, &profile.map(|point| ring(point, 0.95)));
        let covered: Vec<_> = covered(&profile, self.leg).map(|point| ring(point, self.loose)).collect();
        trousers.limb(&limb, &covered);
    }

    fn head(&self, shape: &BodyShape, head: &Frame, skin: &mut Skin, hair: &mut Skin, eyes: &mut Skin) {
        let size = |share: f32| share * shape.height;
        // A child's head is larger in proportion.
        let large = (1.75 / shape.height).sqrt().clamp(1.0, 1.25);
        let half = [0.056, 0.044, 0.066].map(|share| large * size(share));
        skin.ellipsoid(head, half, [-1.0, 1.0]);
        let nose = head.moved([half[AHEAD], 0.0, -0.1 * half[2]]);
        skin.ellipsoid(&nose, [0.009, 0.007, 0.013].map(size), [-1.0, 1.0]);
        for side in [1.0, -1.0] {
            let eye = head.moved([0.86 * half[AHEAD], side * 0.4 * half[1], 0.12 * half[2]]);
            eyes.ellipsoid(&eye, [0.008, 0.008, 0.005].map(size), [-1.0, 1.0]);
            let ear = head.moved([0.0, side * half[1], 0.0]);
            skin.ellipsoid(&ear, [0.009, 0.005, 0.018].map(size), [-1.0, 1.0]);
        }
        if self.is_bald {
            return;
        }
        hair.shell(head, half.map(|part| 1.08 * part), 0.5);
        if self.has_long_hair {
            let behind = head.moved([-0.45 * half[0], 0.0, -0.9 * half[2]]);
            hair.ellipsoid(&behind, [0.5 * half[0], 0.95 * half[1], 1.2 * half[2]], [-1.0, 1.0]);
        }
    }
}

/// Returns the frames and radii of the neck.
fn neck(shape: &BodyShape, bones: &Bones) -> [(Frame, [f32; 2]); 2] {
    let low = bones.chest.moved([0.0, 0.0, 0.62 * shape.trunk()]);
    let radius = shape.width(0.027);
    [
        (low, [radius * 1.1; 2]),
        (bones.head.moved([-0.012 * shape.height, 0.0, -0.03 * shape.height]), [radius; 2]),
    ]
}

/// Returns the points of a profile up to a share of its length, the last one interpolated.
fn covered(profile: &[(f32, f32)], share: f32) -> impl Iterator<Item = (f32, f32)> {
    let inside = profile.iter().copied().filter(move |(at, _)| *at < share);
    let after = profile.windows(2).find(|pair| pair[1].0 >= share);
    let end = after.map(|pair| {
        let [(from, thin), (to, thick)] = [pair[0], pair[1]];
        (share, thin + (share - from) / (to - from) * (thick - thin))
    });
    inside.chain(end)
}
