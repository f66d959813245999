use std::collections::BTreeMap;

use super::*;
use crate::Random;

fn everything() -> Space {
    let parts = BTreeMap::from([
        ("camera".to_owned(), Space::uniform(0.0, 1.0, &[2, 3]).unwrap()),
        ("gear".to_owned(), Space::Discrete { n: 3, start: -1 }),
        ("switches".to_owned(), Space::MultiBinary(vec![2])),
    ]);
    let half = Space::bounded(vec![0.0, f32::NEG_INFINITY], vec![f32::INFINITY, 2.0], vec![2]).unwrap();
    Space::Tuple(vec![
        Space::Dict(parts),
        Space::MultiDiscrete(vec![2, 4]),
        half,
        Space::symmetric(&[f32::INFINITY]),
    ])
}

#[test]
fn samples_are_elements_and_flattening_is_reversible() {
    let (space, mut random) = (everything(), Random::new(3));
    assert_eq!((space.len(), space.flat_len()), (6 + 1 + 2 + 2 + 2 + 1, 6 + 3 + 2 + 6 + 2 + 1));
    let (mut flat, mut back) = (vec![0.0; space.flat_len()], vec![0.0; space.len()]);
    let mut gears = [false; 3];
    for _ in 0..200 {
        let element = space.sample(&mut random);
        space.check(&element).unwrap();
        gears[(element[6] + 1.0) as usize] = true;
        space.flatten_into(&element, &mut flat).unwrap();
        assert_eq!(flat[6..9].iter().sum::<f32>(), 1.0);
        space.unflatten_into(&flat, &mut back).unwrap();
        assert_eq!(element, back);
    }
    assert_eq!(gears, [true; 3]);
}

#[test]
fn invalid_elements_are_rejected() {
    let box_ = Space::symmetric(&[2.0, 1.0]);
    assert!(box_.contains(&[2.0, -1.0]));
    for wrong in [&[2.1, 0.0][..], &[0.0, f32::NAN], &[f32::INFINITY, 0.0], &[0.0], &[0.0; 3]] {
        assert!(!box_.contains(wrong), "{wrong:?}");
    }
    let discrete = Space::Discrete { n: 2, start: 5 };
    assert!(discrete.contains(&[5.0]) && discrete.contains(&[6.0]));
    for wrong in [4.0, 7.0, 5.5, f32::NAN, f32::INFINITY] {
        assert!(!discrete.contains(&[wrong]), "{wrong}");
    }
    assert!(!Space::MultiBinary(vec![2]).contains(&[1.0, 2.0]));
    let mut element = everything().sample(&mut Random::new(1));
    element[10] = 4.0;
    let error = everything().check(&element).unwrap_err().to_string();
    assert!(error.starts_with("number 10 is 4, which is outside MultiDiscrete([2, 4])"), "{error}");
}

#[test]
fn bounds_are_checked() {
    assert!(Space::bounded(vec![1.0], vec![0.0], vec![1]).is_err());
    assert!(Space::bounded(vec![f32::NAN], vec![0.0], vec![1]).is_err());
    assert!(Space::bounded(vec![0.0], vec![1.0], vec![2]).is_err());
    assert!(Space::uniform(0.0, 1.0, &[usize::MAX, 2]).is_err());
    assert!(Space::uniform(0.0, 1.0, &[1 << 30]).is_err());
}

#[test]
fn printed_as_gymnasium_does() {
    let names = [Space::symmetric(&[2.0]), Space::discrete(3), Space::Discrete { n: 3, start: 1 }];
    let names = names.map(|space| space.to_string());
    assert_eq!(names, ["Box(-2.0, 2.0, [1])", "Discrete(3)", "Discrete(3, start=1)"]);
}

#[test]
fn boxes_have_element_types() {
    let bytes = Space::uniform(0.0, 255.0, &[4]).unwrap().with_dtype(Dtype::Uint8).unwrap();
    assert_eq!(bytes.to_string(), "Box(0.0, 255.0, [4], uint8)");
    assert!(bytes.contains(&[0.0, 255.0, 7.0, 1.0]) && !bytes.contains(&[0.5, 0.0, 0.0, 0.0]));
    let mut random = Random::new(3);
    let samples: Vec<_> = (0..2000).flat_map(|_| bytes.sample(&mut random)).collect();
    assert!(samples.iter().all(|sample| sample.fract() == 0.0));
    assert!(samples.contains(&0.0) && samples.contains(&255.0));
    assert!(Space::symmetric(&[1.0]).with_dtype(Dtype::Uint8).is_err());
    assert!(Space::discrete(3).with_dtype(Dtype::Float64).is_err());
    assert!(Space::uniform(f32::NEG_INFINITY, 3.0, &[1]).unwrap().with_dtype(Dtype::Int64).is_err());
}
