//! Checks of the learner's contract, for learners without published weights.

use std::path::Path;

use opendr_engine::learner::{CheckOptions, Entry, Learner, Probe, check_learner};
use opendr_engine::{Header, Value};

/// Checks a learner with the weights of `model` by the checks of the registry's learners. Each of `calls` has a value for
/// each port, in order.
pub fn check_trained_learner<L: Learner>(model: &Path, scratch: &Path, calls: Vec<Vec<Value>>) {
    let entry = Box::leak(Box::new(Entry::of::<L>(Probe::<L>::abilities(None, None, None, None))));
    let stamped = |(values, stamp): (Vec<Value>, i64)| {
        let stamped = entry.ports.iter().zip(values).map(|(port, mut value)| {
            *value.header_mut() = Header::new(stamp, "sensor");
            (port.name, value)
        });
        stamped.collect()
    };
    let calls: Vec<_> = calls.into_iter().zip(1..).map(stamped).collect();
    check_learner(entry, &CheckOptions { model, scratch, calls: &calls }).unwrap();
}
