use opendr_engine::ErrorKind;
use opendr_engine::target::{Keypoint, Skeleton};

use super::*;

const GRID: Grid = Grid { rows: 32, columns: 48, stride: 8.0 };

/// A standing body, in heights of the body.
const BODY: [[f32; 2]; JOINTS] = [
    [0.0, 0.06],
    [0.0, 0.2],
    [-0.1, 0.2],
    [-0.14, 0.35],
    [-0.15, 0.5],
    [0.1, 0.2],
    [0.14, 0.35],
    [0.15, 0.5],
    [-0.07, 0.52],
    [-0.08, 0.75],
    [-0.08, 0.97],
    [0.07, 0.52],
    [0.08, 0.75],
    [0.08, 0.97],
    [-0.03, 0.03],
    [0.03, 0.03],
    [-0.07, 0.04],
    [0.07, 0.04],
];

fn body([left, top]: [f32; 2], height: f32) -> [Keypoint; JOINTS] {
    BODY.map(|[x, y]| Keypoint { x: left + height * x, y: top + height * y, confidence: 1.0 })
}

/// Returns the person with raised arms.
fn waving(mut person: [Keypoint; JOINTS], height: f32) -> [Keypoint; JOINTS] {
    for (joint, up) in [(3, 0.05), (4, 0.2), (6, 0.05), (7, 0.2)] {
        person[joint].y = person[1].y - up * height;
    }
    person
}

fn painted(persons: &[[Keypoint; JOINTS]]) -> [Vec<f32>; 2] {
    let mut maps = [HEAT_MAPS, FIELDS].map(|count| vec![f32::NAN; count * GRID.cells()]);
    let [heat, fields] = &mut maps;
    MapEncoder::default().encode(GRID, persons, heat, fields);
    maps
}

fn decoded(how: &PartAffinity, [heat, fields]: &[Vec<f32>; 2]) -> Vec<Person> {
    let mut persons = Vec::new();
    let maps = PartMaps::new(GRID, heat, fields).unwrap();
    how.decode(&maps, &mut DecodeScratch::default(), &mut persons);
    persons
}

/// Checks that each person is detected once, every joint within `tolerance` pixels, without others.
fn check(persons: &[[Keypoint; JOINTS]], tolerance: f32) {
    let mut found = decoded(&PartAffinity::default(), &painted(persons));
    assert_eq!(found.len(), persons.len());
    for person in persons {
        let distance = |other: &Person| {
            let pairs = person.iter().zip(&other.joints);
            pairs.map(|(a, b)| (a.x - b.x).hypot(a.y - b.y)).fold(0.0, f32::max)
        };
        let nearest = (0..found.len()).min_by(|a, b| distance(&found[*a]).total_cmp(&distance(&found[*b])));
        let nearest = found.remove(nearest.unwrap());
        assert!(distance(&nearest) < tolerance, "{} pixels off: {person:?} {nearest:?}", distance(&nearest));
    }
}

#[test]
fn limbs_are_the_bones_and_two() {
    assert_eq!(LIMBS[..17], *Skeleton::Opendr18.bones());
    let names = LIMBS[17..].iter().map(|limb| limb.map(|joint| Skeleton::Opendr18.joints()[joint]));
    assert_eq!(names.collect::<Vec<_>>(), [["r_sho", "r_ear"], ["l_sho", "l_ear"]]);
}

#[test]
fn a_painted_person_is_decoded_at_its_position() {
    for shift in 0..8 {
        let place = [150.0 + shift as f32, 10.0 + 1.7 * shift as f32];
        check(&[body(place, 220.0)], 0.7);
    }
}

#[test]
fn persons_side_by_side() {
    let height = 180.0;
    check(&[body([60.3, 20.0], height), body([150.0, 30.5], height), body([310.0, 15.0], 230.0)], 0.7);
}

#[test]
fn persons_that_overlap() {
    let small = waving(body([210.0, 60.0], 160.0), 160.0);
    // Limbs cross, joints are beside those of the other.
    check(&[body([180.0, 15.0], 230.0), small], 2.0);
    check(&[body([160.0, 20.0], 220.0), body([188.0, 24.0], 220.0)], 2.0);
}

#[test]
fn hidden_parts_leave_the_rest_together() {
    let mut person = body([200.0, 10.0], 220.0);
    for hidden in [1, 4, 9, 10, 12, 13, 8, 11] {
        person[hidden] = Keypoint::MISSING;
    }
    // Without a neck, ears connect the shoulders.
    check(&[person], 0.7);
    let mut cut = body([60.0, 20.0], 220.0);
    (8..14).for_each(|joint| cut[joint] = Keypoint::MISSING);
    check(&[person, cut], 0.7);
    let found = decoded(&PartAffinity::default(), &painted(&[cut]));
    assert!(found[0].score > 0.6 && found[0].score < 12.0 / 18.0 + 1e-6, "{}", found[0].score);
}

#[test]
fn positions_between_cells_are_decoded_at_every_ratio() {
    let maps = painted(&[body([151.3, 12.7], 220.0)]);
    for upsample_ratio in [1, 2, 4, 8, 1000] {
        let found = decoded(&PartAffinity { upsample_ratio, ..PartAffinity::default() }, &maps);
        let pairs = found[0].joints.iter().zip(body([151.3, 12.7], 220.0));
        let off = pairs.map(|(a, b)| (a.x - b.x).hypot(a.y - b.y)).sum::<f32>() / JOINTS as f32;
        assert!(off < 0.3, "{off} pixels off in steps of 1/{upsample_ratio}");
        assert!(found[0].score > 0.95, "{}", found[0].score);
    }
}

#[test]
fn few_joints_are_no_person() {
    let mut person = [Keypoint::MISSING; JOINTS];
    let whole = body([150.0, 20.0], 200.0);
    person[1] = whole[1];
    person[2] = whole[2];
    let maps = painted(&[person]);
    assert!(decoded(&PartAffinity::default(), &maps).is_empty());
    let two = PartAffinity { min_joints: 2, ..PartAffinity::default() };
    assert_eq!(decoded(&two, &maps).len(), 1);
    let mut alone = painted(&[whole]);
    alone[1].fill(0.0);
    assert!(decoded(&two, &alone).is_empty(), "peaks without limbs are no person");
}

#[test]
fn background_is_the_rest() {
    let [heat, fields] = painted(&[body([100.0, 10.0], 200.0)]);
    let cells = GRID.cells();
    for cell in 0..cells {
        let most = (0..JOINTS).map(|joint| heat[joint * cells + cell]).fold(0.0, f32::max);
        assert_eq!(heat[JOINTS * cells + cell], 1.0 - most);
        for limb in 0..LIMBS.len() {
            let length = fields[2 * limb * cells + cell].hypot(fields[(2 * limb + 1) * cells + cell]);
            assert!(length == 0.0 || (length - 1.0).abs() < 1e-5);
        }
    }
}

#[test]
fn invalid_maps_do_not_panic() {
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, 1.0] {
        let maps = [HEAT_MAPS, FIELDS].map(|count| vec![value; count * GRID.cells()]);
        assert!(decoded(&PartAffinity::default(), &maps).len() <= 64);
        let [heat, _] = painted(&[body([100.0, 10.0], 200.0)]);
        let [_, fields] = maps;
        for person in decoded(&PartAffinity::default(), &[heat, fields]) {
            assert!((0.0..=1.0).contains(&person.score));
        }
    }
    let noise = |seed: u64, count: usize| {
        let mut random = opendr_engine::Random::new(seed);
        (0..count * GRID.cells()).map(|_| random.uniform(-1.0, 2.0)).collect::<Vec<_>>()
    };
    for person in decoded(&PartAffinity::default(), &[noise(1, JOINTS), noise(2, FIELDS)]) {
        assert!((0.0..=1.0).contains(&person.score));
    }
    let error = PartMaps::new(GRID, &[0.0; 7], &[0.0; 9]).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Format);
    let empty = Grid { rows: 0, ..GRID };
    assert!(PartMaps::new(empty, &[], &[]).is_err());
}

#[test]
fn persons_far_outside_are_painted_nowhere() {
    let far = |at: f32| [Keypoint { x: at, y: at, confidence: 1.0 }; JOINTS];
    let [heat, fields] = painted(&[far(1e30), far(f32::INFINITY), far(0.0)]);
    assert!(heat.iter().chain(&fields).all(|value| value.is_finite()));
}

#[test]
fn memory_is_reused() {
    let maps = painted(&[body([60.0, 20.0], 200.0), body([250.0, 20.0], 200.0)]);
    let maps = PartMaps::new(GRID, &maps[0], &maps[1]).unwrap();
    let (mut memory, mut persons) = (DecodeScratch::default(), Vec::new());
    let how = PartAffinity::default();
    how.decode(&maps, &mut memory, &mut persons);
    let before = (persons.as_ptr(), persons.clone());
    (0..3).for_each(|_| how.decode(&maps, &mut memory, &mut persons));
    assert_eq!((persons.as_ptr(), persons), before);
}
