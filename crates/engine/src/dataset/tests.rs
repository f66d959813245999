use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::target::Category;

/// Sample `n` is of class `n`.
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
fn cached_samples_are_read_once() {
    let numbers = Numbers(3, AtomicUsize::new(0));
    let cached = CachedDatasetIterator::new(&numbers);
    assert_eq!([class(&cached, 1), class(&cached, 1), class(&cached, 2)], [1, 1, 2]);
    assert_eq!(numbers.1.load(Ordering::Relaxed), 2);
    assert!(cached.get(3).is_err());
}
