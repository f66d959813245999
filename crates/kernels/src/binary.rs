//! Functions of two numbers, row by row.

use crate::isa::{Isa, for_every_isa};
use crate::lanes::Lanes;

/// A function of two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Binary {
    /// `a + b`.
    Add,
    /// `a - b`.
    Sub,
    /// `a * b`.
    Mul,
    /// `a / b`.
    Div,
    /// The larger one.
    Max,
    /// The smaller one.
    Min,
}

/// A row of numbers, or one number for a whole row.
#[derive(Debug, Clone, Copy)]
pub enum Operand<'a> {
    /// As many numbers as the result has.
    Row(&'a [f32]),
    /// The same number everywhere.
    Scalar(f32),
}

impl Binary {
    /// Computes a row.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn apply(self, isa: Isa, a: Operand<'_>, b: Operand<'_>, y: &mut [f32]) {
        let mut scalars = [0.0; 2];
        let mut place = |operand: Operand<'_>, index: usize| match operand {
            Operand::Row(row) => {
                assert_eq!(row.len(), y.len(), "the rows must have equal lengths");
                (row.as_ptr(), true)
            }
            Operand::Scalar(value) => {
                scalars[index] = value;
                (std::ptr::null(), false)
            }
        };
        let (a, b) = (place(a, 0), place(b, 1));
        // SAFETY: rows have the length of `y`; the others are not read.
        unsafe { dispatch_binary(isa, self, a, b, scalars, y.as_mut_ptr(), y.len()) }
    }

    /// Computes `y = function(y, x)`.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn apply_to(self, isa: Isa, y: &mut [f32], x: &[f32]) {
        assert_eq!(x.len(), y.len(), "the rows must have equal lengths");
        let at = y.as_mut_ptr();
        // SAFETY: both rows have this length; each number of `y` is read before it is written.
        unsafe {
            dispatch_binary(isa, self, (at.cast_const(), true), (x.as_ptr(), true), [0.0; 2], at, y.len())
        }
    }

    /// Computes `y = function(y, scalar)`.
    pub fn apply_scalar(self, isa: Isa, y: &mut [f32], scalar: f32) {
        let at = y.as_mut_ptr();
        // SAFETY: each number of `y` is read before it is written; the scalar is no row.
        unsafe {
            dispatch_binary(
                isa,
                self,
                (at.cast_const(), true),
                (std::ptr::null(), false),
                [0.0, scalar],
                at,
                y.len(),
            )
        }
    }

    #[inline(always)]
    unsafe fn of<V: Lanes>(self, a: V, b: V) -> V {
        // SAFETY: the contract of `Lanes`, passed on.
        unsafe {
            match self {
                Self::Add => a.add(b),
                Self::Sub => a.sub(b),
                Self::Mul => a.mul(b),
                Self::Div => a.div(b),
                // The second operand comes out where one is NaN.
                Self::Max => a.max(b),
                Self::Min => a.min(b),
            }
        }
    }
}

for_every_isa!(
    fn dispatch_binary = binary_row(
        function: Binary,
        a: (*const f32, bool),
        b: (*const f32, bool),
        scalars: [f32; 2],
        y: *mut f32,
        length: usize,
    )
);

#[inline(always)]
unsafe fn binary_row<V: Lanes>(
    function: Binary,
    a: (*const f32, bool),
    b: (*const f32, bool),
    scalars: [f32; 2],
    y: *mut f32,
    length: usize,
) {
    // SAFETY: whole registers lie within `length`; the rest is counted.
    unsafe {
        let scalars = scalars.map(|scalar| V::splat(scalar));
        for i in (0..length).step_by(V::WIDTH) {
            let count = (length - i).min(V::WIDTH);
            let load = |operand: (*const f32, bool), scalar: V| match operand.1 {
                true if count == V::WIDTH => V::load(operand.0.add(i)),
                true => V::load_some(operand.0.add(i), count),
                false => scalar,
            };
            let result = function.of(load(a, scalars[0]), load(b, scalars[1]));
            if count == V::WIDTH { result.store(y.add(i)) } else { result.store_some(y.add(i), count) }
        }
    }
}
