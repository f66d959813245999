use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::target::Category;

/// A data set whose sample `n` is of class `n`.
struct Numbers(usize, AtomicUsize);

impl Dataset for Numbers {}

impl DatasetIterator for Numbers {
    fn len(&self) -> usize {
        self.0
    }

    fn get(&self, index: usize) -> Result<Sample> {
        self.1.fetch_add(1, Ordering::Relaxed);
        Ok(Sample { data: Vec::new(), target: Some(Category::new(index as i64, None).into()) })
    }

    fn name(&self, index: usize) -> String {
        format!("number {index}")
    }
}

fn class(dataset: &dyn DatasetIterator, index: usize) -> i64 {
    match dataset.target(index).unwrap() {
        Some(Value::Category(category)) => category.class,
        other => panic!("{other:?}"),
    }
}

#[test]
fn subsets_keep_names_and_order() {
    let numbers = Numbers(5, AtomicUsize::new(0));
    let some = Subset::new(&numbers, vec![4, 0]).unwrap();
    assert_eq!((some.len(), class(&some, 0), some.name(0)), (2, 4, "number 4".to_owned()));
    assert!(some.get(2).is_err());
    assert!(Subset::new(&numbers, vec![5]).is_err());
    assert_eq!(Subset::first(&numbers, 9).indices(), [0, 1, 2, 3, 4]);
}

#[test]
fn splits_are_disjoint_and_follow_from_the_seed() {
    let numbers = Numbers(10, AtomicUsize::new(0));
    let [train, val] = Subset::split(&numbers, 0.7, 5).unwrap();
    assert_eq!((train.len(), val.len()), (7, 3));
    let mut all = [train.indices(), val.indices()].concat();
    all.sort_unstable();
    assert_eq!(all, (0..10).collect::<Vec<_>>());
    let again = |seed| Subset::split(&numbers, 0.7, seed).unwrap()[1].indices().to_vec();
    assert_eq!(again(5), val.indices());
    assert!((6..20).any(|seed| again(seed) != val.indices()));
    assert!(Subset::split(&numbers, 1.5, 0).is_err());
    let shuffled = Subset::shuffled(&numbers, 3);
    assert_eq!(shuffled.indices(), Subset::shuffled(&numbers, 3).indices());
    assert_ne!(shuffled.indices(), (0..10).collect::<Vec<_>>());
}

#[test]
fn sequences_are_not_split() {
    struct Videos;
    impl Dataset for Videos {}
    impl DatasetIterator for Videos {
        fn len(&self) -> usize {
            12
        }

        fn get(&self, _index: usize) -> Result<Sample> {
            Ok(Sample { data: Vec::new(), target: None })
        }

        fn sequence(&self, index: usize) -> Option<usize> {
            Some(index / 4)
        }
    }
    let [train, val] = Subset::split(&Videos, 0.5, 1).unwrap();
    assert_eq!((train.len(), val.len()), (8, 4));
    let video = val.indices()[0] / 4;
    assert!(val.indices().iter().all(|index| index / 4 == video));
}

#[test]
fn cached_samples_are_read_once() {
    let numbers = Numbers(3, AtomicUsize::new(0));
    let cached = CachedDatasetIterator::new(&numbers);
    assert_eq!([class(&cached, 1), class(&cached, 1), class(&cached, 2)], [1, 1, 2]);
    assert_eq!(numbers.1.load(Ordering::Relaxed), 2);
    assert!(cached.get(3).is_err());
}

#[test]
fn samples_that_are_read_ahead_keep_their_order_and_errors() {
    let numbers = Numbers(11, AtomicUsize::new(0));
    let ahead = ReadAheadDatasetIterator::new(&numbers, 3);
    assert_eq!(ahead.len(), 11);
    for index in [0, 1, 5, 10, 2, 9] {
        assert_eq!(ahead.get(index).unwrap(), numbers.get(index).unwrap());
        assert_eq!(ahead.target(index).unwrap(), numbers.target(index).unwrap());
    }
    let none = ReadAheadDatasetIterator::new(Numbers(0, AtomicUsize::new(0)), 0);
    assert!(none.is_empty());
}
