//! Joints, limbs and the numbers of maps.

use opendr_engine::target::Skeleton;

/// Number of joints of a person.
pub const JOINTS: usize = 18;
/// Number of heatmaps: one per joint, and the background.
pub const HEAT_MAPS: usize = JOINTS + 1;
/// Number of maps of fields: x and y of each limb.
pub const FIELDS: usize = 2 * LIMBS.len();

/// The limbs: the skeleton's bones, and two from shoulder to ear, which connect a person with a hidden neck. Fields are in
/// this order and point from the first joint to the second.
pub const LIMBS: [[usize; 2]; 19] = {
    let bones = Skeleton::Opendr18.bones();
    let mut limbs = [[0; 2]; 19];
    let mut limb = 0;
    while limb < bones.len() {
        limbs[limb] = bones[limb];
        limb += 1;
    }
    limbs[limb] = [2, 16];
    limbs[limb + 1] = [5, 17];
    limbs
};
