//! Storage order of a tensor's axes relative to TensorFlow's order.
//!
//! TensorFlow graphs are channels-last, ONNX convolutions channels-first. Instead of inserting transpositions and
//! removing them again, every tensor has an [`Order`]: a convolution stores its result channels-first, the following
//! operators work on any order, a TensorFlow `Transpose` only renames axes, and a transposition is written only where
//! elements must move, as when channels are flattened.

use opendr_onnx::Dim;

/// The order of stored axes: stored axis `i` is TensorFlow's axis `order[i]`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Order(Vec<usize>);

impl Order {
    /// Returns TensorFlow's own order.
    pub fn plain(rank: usize) -> Self {
        Self((0..rank).collect())
    }

    /// Returns the order of `[batch, height, width, channels]` stored as `[batch, channels, height, width]`.
    pub fn channels_first() -> Self {
        Self(vec![0, 3, 1, 2])
    }

    /// Creates an order from TensorFlow's axes in stored order; they must be a permutation.
    pub fn new(axes: Vec<usize>) -> Self {
        Self(axes)
    }

    /// Returns TensorFlow's axes in stored order.
    pub fn axes(&self) -> &[usize] {
        &self.0
    }

    /// Returns the number of axes.
    pub fn rank(&self) -> usize {
        self.0.len()
    }

    /// Returns whether the stored order is TensorFlow's.
    pub fn is_plain(&self) -> bool {
        self.0.iter().enumerate().all(|(stored, &axis)| stored == axis)
    }

    /// Returns the stored position of TensorFlow's axis.
    pub fn stored(&self, axis: usize) -> usize {
        self.0.iter().position(|&own| own == axis).unwrap_or(axis)
    }

    /// Returns whether a conversion from this order to `target` moves no element, because all axes that change places
    /// have size one. `dims` are the stored dimensions.
    pub fn is_reshape_to(&self, target: &Self, dims: &[Dim]) -> bool {
        let ranks =
            self.0.iter().zip(dims).filter(|(_, dim)| **dim != Some(1)).map(|(&axis, _)| target.stored(axis));
        ranks.is_sorted()
    }

    /// Returns the permutation for ONNX's `Transpose` from this order to `target`.
    pub fn permutation_to(&self, target: &Self) -> Vec<i64> {
        target.0.iter().map(|&axis| self.stored(axis) as i64).collect()
    }

    /// Returns the order after TensorFlow's `Transpose` by `perm`: the new axis `i` is the old axis `perm[i]`; no
    /// element moves.
    #[must_use]
    pub fn transposed(&self, perm: &[usize]) -> Self {
        Self(self.0.iter().map(|&old| perm.iter().position(|&axis| axis == old).unwrap_or(old)).collect())
    }

    /// Returns the order after removal of TensorFlow's axes `gone`.
    #[must_use]
    pub fn without(&self, gone: &[usize]) -> Self {
        let kept = self.0.iter().filter(|axis| !gone.contains(axis));
        Self(kept.map(|&axis| axis - gone.iter().filter(|&&gone| gone < axis).count()).collect())
    }

    /// Returns the order after insertion of TensorFlow's axis `axis`, and its stored position: before the axis that
    /// it shifts.
    #[must_use]
    pub fn with(&self, axis: usize) -> (Self, usize) {
        let position = if axis < self.rank() { self.stored(axis) } else { self.rank() };
        let mut axes: Vec<usize> =
            self.0.iter().map(|&own| if own >= axis { own + 1 } else { own }).collect();
        axes.insert(position, axis);
        (Self(axes), position)
    }

    /// Returns TensorFlow's dimensions of a tensor stored with `dims`.
    pub fn logical(&self, dims: &[Dim]) -> Vec<Dim> {
        let mut logical = vec![None; dims.len()];
        for (&axis, &dim) in self.0.iter().zip(dims) {
            if let Some(slot) = logical.get_mut(axis) {
                *slot = dim;
            }
        }
        logical
    }

    /// Returns the stored dimensions of a tensor with TensorFlow's dimensions `logical`.
    pub fn stored_dims(&self, logical: &[Dim]) -> Vec<Dim> {
        self.0.iter().map(|&axis| logical.get(axis).copied().flatten()).collect()
    }

    /// Returns the order in which a tensor of TensorFlow's dimensions `from` can be stored after a reshape to `to`
    /// without moving an element: possible when the axes that merge or split are adjacent.
    pub fn reshaped(&self, from: &[usize], to: &[usize]) -> Option<Self> {
        let groups = matching_groups(from, to)?;
        let group_of = |axis: usize| groups.iter().position(|group| group.from.contains(&axis));
        let mut axes = Vec::with_capacity(to.len());
        axes.extend(0..groups.first().map_or(to.len(), |group| group.to.start));
        let mut stored = self.0.iter().filter(|&&axis| from[axis] != 1).peekable();
        while let Some(&axis) = stored.next() {
            let group = &groups[group_of(axis)?];
            let mut expected = group.from.clone().filter(|&axis| from[axis] != 1);
            if expected.next() != Some(axis) {
                return None;
            }
            for axis in expected {
                if stored.next() != Some(&axis) {
                    return None;
                }
            }
            axes.extend(group.to.clone());
        }
        (axes.len() == to.len()).then_some(Self(axes))
    }
}

/// Axes of one shape with the same elements as axes of another.
struct Group {
    from: std::ops::Range<usize>,
    to: std::ops::Range<usize>,
}

/// Returns the finest division of two shapes into groups of equal size; axes of size one join the preceding group.
/// Returns `None` when there are no elements, or the numbers of elements differ.
fn matching_groups(from: &[usize], to: &[usize]) -> Option<Vec<Group>> {
    let first = |dims: &[usize]| dims.iter().position(|&dim| dim != 1).unwrap_or(dims.len());
    let (mut i, mut j) = (first(from), first(to));
    let mut groups = Vec::new();
    while i < from.len() && j < to.len() {
        let (start_i, start_j) = (i, j);
        let (mut size_i, mut size_j) = (from[i], to[j]);
        (i, j) = (i + 1, j + 1);
        while size_i != size_j {
            if size_i < size_j {
                size_i = size_i.checked_mul(*from.get(i)?)?;
                i += 1;
            } else {
                size_j = size_j.checked_mul(*to.get(j)?)?;
                j += 1;
            }
        }
        i += from[i..].iter().take_while(|&&dim| dim == 1).count();
        j += to[j..].iter().take_while(|&&dim| dim == 1).count();
        groups.push(Group { from: start_i..i, to: start_j..j });
    }
    (i == from.len() && j == to.len() && !from.contains(&0)).then_some(groups)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transpose_to_the_stored_order_is_free() {
        let order = Order::channels_first().transposed(&[0, 3, 1, 2]);
        assert!(order.is_plain());
        assert_eq!(order.transposed(&[0, 2, 3, 1]), Order::channels_first());
    }

    #[test]
    fn axes_come_and_go() {
        let order = Order::channels_first();
        assert_eq!(order.without(&[1, 2]), Order::plain(2));
        assert_eq!(order.without(&[0]).axes(), [2, 0, 1]);
        let (order, position) = order.without(&[0]).with(0);
        assert_eq!((order.axes(), position), (&[3, 0, 1, 2][..], 1));
        assert_eq!(Order::plain(2).with(2), (Order::plain(3), 2));
    }

    #[test]
    fn single_elements_move_freely() {
        let order = Order::channels_first();
        let plain = Order::plain(4);
        assert!(order.is_reshape_to(&plain, &[Some(1), Some(8), Some(1), Some(1)]));
        assert!(order.is_reshape_to(&plain, &[Some(1), Some(1), None, None]));
        assert!(!order.is_reshape_to(&plain, &[Some(1), Some(8), Some(1), Some(2)]));
        assert_eq!(order.permutation_to(&plain), [0, 2, 3, 1]);
    }

    #[test]
    fn reshape_keeps_the_order_where_it_can() {
        let order = Order::channels_first();
        let reshaped = |to: &[usize]| order.reshaped(&[1, 4, 5, 6], to).map(|order| order.axes().to_vec());
        assert_eq!(reshaped(&[1, 20, 6]), Some(vec![0, 2, 1]));
        assert_eq!(reshaped(&[20, 6]), Some(vec![1, 0]));
        assert_eq!(reshaped(&[1, 4, 5, 2, 3]), Some(vec![0, 3, 4, 1, 2]));
        assert_eq!(reshaped(&[1, 40, 3]), None);
        assert_eq!(reshaped(&[1, 120]), None);
        assert_eq!(reshaped(&[7]), None);
        assert_eq!(order.reshaped(&[1, 1, 1, 6], &[1, 6]), Some(Order::plain(2)));
        assert_eq!(order.reshaped(&[1, 1, 1, 6], &[6, 1, 1]), Some(Order::plain(3)));
        assert_eq!(order.reshaped(&[1, 0, 1, 6], &[0]), None);
    }
}
