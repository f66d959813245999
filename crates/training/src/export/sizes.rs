//! Fixed sizes and sizes that follow the batch.

use std::collections::HashMap;

use burn::backend::capture::TensorId;
use burn::backend::ir::{BaseOperationIr, IrVisitorMut, OperationIr, SliceOpIr, TensorIr};
use burn::tensor::Slice;
use opendr_engine::{Error, Result};

use super::operation_name::operation_name;
use super::trace::Trace;

/// Size of a tensor along one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Size {
    /// The same for every batch.
    Fixed(usize),
    /// A multiple of the batch size.
    Batch(usize),
}

impl Size {
    /// Returns the size if it is fixed.
    pub(super) fn fixed(self) -> Option<usize> {
        match self {
            Self::Fixed(size) => Some(size),
            Self::Batch(_) => None,
        }
    }

    /// Returns the name of the size in the file; empty where it has none.
    pub(super) fn open_name(self) -> &'static str {
        if self == Self::Batch(1) { "batch" } else { "" }
    }
}

/// Sizes of all tensors of a recording.
pub(super) enum Sizes {
    /// As recorded.
    Fixed,
    /// Reconciled from two recordings.
    Reconciled(HashMap<TensorId, Vec<Size>>),
}

impl Sizes {
    /// Returns the sizes of a tensor.
    pub(super) fn of(&self, tensor: &TensorIr) -> Vec<Size> {
        let recorded = || tensor.shape.iter().map(|&dim| Size::Fixed(dim)).collect();
        match self {
            Self::Fixed => recorded(),
            Self::Reconciled(sizes) => sizes.get(&tensor.id).cloned().unwrap_or_else(recorded),
        }
    }

    /// Returns the sizes of the tensor with this id, if they were reconciled.
    pub(super) fn of_id(&self, id: TensorId) -> &[Size] {
        match self {
            Self::Fixed => &[],
            Self::Reconciled(sizes) => sizes.get(&id).map_or(&[], Vec::as_slice),
        }
    }

    /// Compares recordings with two batch sizes. They must be equal except for sizes in proportion to the batch; slices of
    /// `first` that count from the end of such an axis are rewritten accordingly.
    ///
    /// # Errors
    /// `Unsupported` with the name of the operation that differs.
    pub(super) fn reconciled(first: &mut Trace, second: &Trace, batches: [usize; 2]) -> Result<Self> {
        if first.operations.len() != second.operations.len() {
            return Err(Error::unsupported(format!(
                "the network runs {} operations for a batch of {} and {} for one of {}; it cannot be exported with an \
                 open batch",
                first.operations.len(),
                batches[0],
                second.operations.len(),
                batches[1]
            )));
        }
        let mut sizes = HashMap::new();
        let mut ids = HashMap::new();
        for (a, b) in first.operations.iter_mut().zip(&second.operations) {
            reconcile(a, b, batches, &mut sizes, &mut ids)?;
        }
        check_values(first, second, &ids)?;
        Ok(Self::Reconciled(sizes))
    }
}

/// Tensors and ranges of an operation, in the order of Burn's visitor.
#[derive(Default)]
struct Collected {
    tensors: Vec<TensorIr>,
    ranges: Vec<Slice>,
}

impl IrVisitorMut for Collected {
    fn visit_tensor_mut(&mut self, tensor: &mut TensorIr) {
        self.tensors.push(tensor.clone());
    }

    fn visit_range_mut(&mut self, range: &mut Slice) {
        self.ranges.push(*range);
    }
}

impl Collected {
    fn from_operation(operation: &OperationIr) -> Self {
        let mut collected = Self::default();
        operation.clone().visit_mut(&mut collected);
        collected
    }
}

/// Replaces tensors and ranges of an operation, in the same order.
struct Replaced<T, R> {
    tensors: T,
    ranges: R,
}

impl<T: Iterator<Item = TensorIr>, R: Iterator<Item = Slice>> IrVisitorMut for Replaced<T, R> {
    fn visit_tensor_mut(&mut self, tensor: &mut TensorIr) {
        if let Some(other) = self.tensors.next() {
            *tensor = other;
        }
    }

    fn visit_range_mut(&mut self, range: &mut Slice) {
        if let Some(other) = self.ranges.next() {
            *range = other;
        }
    }
}

fn reconcile(
    a: &mut OperationIr,
    b: &OperationIr,
    batches: [usize; 2],
    sizes: &mut HashMap<TensorId, Vec<Size>>,
    ids: &mut HashMap<TensorId, TensorId>,
) -> Result<()> {
    let of_a = Collected::from_operation(a);
    let of_b = Collected::from_operation(b);
    let differs = || {
        Error::unsupported(format!(
            "{} depends on the batch size other than by the sizes of its tensors; it cannot be \
             exported with an open batch",
            operation_name(b)
        ))
    };
    if of_a.tensors.len() != of_b.tensors.len() || of_a.ranges.len() != of_b.ranges.len() {
        return Err(differs());
    }
    for (x, y) in of_a.tensors.iter().zip(&of_b.tensors) {
        let same = *ids.entry(x.id).or_insert(y.id) == y.id;
        let paired = pair(&x.shape, &y.shape, batches).filter(|_| same).ok_or_else(differs)?;
        sizes.insert(x.id, paired);
    }
    // With its own tensors and ranges replaced, the other recording must be equal.
    let mut copy = b.clone();
    copy.visit_mut(&mut Replaced { tensors: of_a.tensors.into_iter(), ranges: of_a.ranges.into_iter() });
    if let (Some(BaseOperationIr::RepeatDim(x)), Some(BaseOperationIr::RepeatDim(y))) =
        (base(a), base_mut(&mut copy))
    {
        y.times = x.times;
    }
    if *a != copy {
        return Err(differs());
    }
    if let (Some(BaseOperationIr::Slice(x)), Some(BaseOperationIr::Slice(y))) = (base_mut(a), base(b)) {
        reconcile_slices(x, y).ok_or_else(differs)?;
    }
    Ok(())
}

fn base(operation: &OperationIr) -> Option<&BaseOperationIr> {
    match operation {
        OperationIr::BaseFloat(base) | OperationIr::BaseInt(base) | OperationIr::BaseBool(base) => Some(base),
        _ => None,
    }
}

fn base_mut(operation: &mut OperationIr) -> Option<&mut BaseOperationIr> {
    match operation {
        OperationIr::BaseFloat(base) | OperationIr::BaseInt(base) | OperationIr::BaseBool(base) => Some(base),
        _ => None,
    }
}

fn pair(a: &[usize], b: &[usize], batches: [usize; 2]) -> Option<Vec<Size>> {
    let size = |(&a, &b): (&usize, &usize)| {
        if a == b {
            return Some(Size::Fixed(a));
        }
        let proportional = a % batches[0] == 0 && b % batches[1] == 0 && a / batches[0] == b / batches[1];
        proportional.then_some(Size::Batch(a / batches[0]))
    };
    (a.len() == b.len()).then(|| a.iter().zip(b).map(size).collect())?
}

/// Makes positions on a growing axis count from its end, where both recordings agree on that.
fn reconcile_slices(a: &mut SliceOpIr, b: &SliceOpIr) -> Option<()> {
    let dims = a.tensor.shape.iter().zip(b.tensor.shape.iter());
    for ((x, y), (&dim_x, &dim_y)) in a.ranges.iter_mut().zip(&b.ranges).zip(dims) {
        let (dim_x, dim_y) = (isize::try_from(dim_x).ok()?, isize::try_from(dim_y).ok()?);
        let position = |x: isize, y: isize| match x == y {
            true => Some(x),
            false => (x - dim_x == y - dim_y).then_some(x - dim_x),
        };
        x.start = position(x.start, y.start)?;
        x.end = match position(x.end.unwrap_or(dim_x), y.end.unwrap_or(dim_y))? {
            0 if dim_x != 0 => None,
            end => Some(end),
        };
        if x.step != y.step {
            return None;
        }
    }
    Some(())
}

/// Checks that tensors created from data are the same for every batch.
fn check_values(first: &Trace, second: &Trace, ids: &HashMap<TensorId, TensorId>) -> Result<()> {
    for (id, value) in &first.values {
        if let Some(other) = ids.get(id).and_then(|id| second.values.get(id))
            && value.as_bytes() != other.as_bytes()
        {
            return Err(Error::unsupported(format!(
                "the forward pass creates a constant of sizes {:?} that depends on the batch size; create it from \
                 one row and expand it",
                value.shape().as_slice()
            )));
        }
    }
    Ok(())
}
