//! Places of buffers in the arena.

use std::collections::BTreeMap;

use opendr_kernels::ALIGNMENT;

use crate::planner::{Id, Planner};
use crate::value::Source;

/// Bytes behind the last tensor.
const SLACK: usize = 256;

/// Returns the first and last step of every buffer; `None` where nothing needs it.
pub(crate) fn lives(planner: &Planner<'_>, outputs: &[Id]) -> Vec<Option<[usize; 2]>> {
    let buffer = |id: Id| match planner.values[id].source {
        Source::Buffer(buffer, _) => Some(buffer),
        _ => None,
    };
    let mut last: Vec<Option<usize>> = vec![None; planner.buffers.len()];
    for id in outputs.iter().filter_map(|&id| buffer(id)) {
        last[id] = Some(planner.steps.len());
    }
    let mut lives = vec![None; planner.buffers.len()];
    for (index, step) in planner.steps.iter().enumerate().rev() {
        let Some(end) = last[step.buffer] else { continue };
        lives[step.buffer] = Some([index, end]);
        for read in step.reads.iter().flatten().filter_map(|&id| buffer(id)) {
            last[read] = Some(last[read].map_or(index, |last| last.max(index)));
        }
    }
    lives
}

/// Places buffers so that those that live at the same time do not overlap: the largest first, each at the lowest
/// free offset.
pub(crate) fn place(sizes: &[usize], lives: &[Option<[usize; 2]>]) -> (Vec<usize>, usize) {
    let mut order: Vec<usize> = (0..sizes.len()).filter(|&buffer| lives[buffer].is_some()).collect();
    order.sort_by_key(|&buffer| std::cmp::Reverse(sizes[buffer]));
    let mut starts = vec![0; sizes.len()];
    let mut placed: Vec<usize> = Vec::new();
    let mut total = 0;
    for buffer in order {
        let Some([first, last]) = lives[buffer] else { continue };
        let mut taken: BTreeMap<usize, usize> = BTreeMap::new();
        for &other in &placed {
            if lives[other].is_some_and(|[from, to]| from <= last && first <= to) {
                let end = taken.entry(starts[other]).or_default();
                *end = (*end).max(starts[other] + sizes[other]);
            }
        }
        let mut at = 0;
        for (start, end) in taken {
            if at + sizes[buffer] <= start {
                break;
            }
            at = at.max(end.next_multiple_of(ALIGNMENT));
        }
        starts[buffer] = at;
        total = total.max(at + sizes[buffer]);
        placed.push(buffer);
    }
    (starts, total + SLACK)
}
