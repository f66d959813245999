//! An image as the kernels read it, and the choice of the kernel.

use std::ops::Range;

use opendr_engine::data::{ImageView, Samples};

use crate::preprocess::band::Row;
use crate::preprocess::border::Border;
use crate::preprocess::packed::{Packed, PackedRow};
use crate::preprocess::plan::{Plan, TAP_BYTES};
use crate::preprocess::sample::Written;
use crate::preprocess::strided::{Finish, blend_row};
use crate::preprocess::warped::{Line, warp_row};

/// A view with the conversion of its pixels.
pub(super) struct Source<'a> {
    view: ImageView<'a>,
    finish: Finish,
    packed: Option<Packed>,
}

impl<'a> Source<'a> {
    /// Chooses the kernel for `view`.
    pub(super) fn new(view: ImageView<'a>, finish: Finish) -> Self {
        Self { view, finish, packed: Packed::for_view(&view, &finish) }
    }

    /// Returns the source with the plain kernel.
    #[cfg(test)]
    pub(super) fn plain(self) -> Self {
        Self { packed: None, ..self }
    }

    /// Returns the bytes from pixel to pixel for the packed kernel; 0 without it.
    pub(super) fn step(&self) -> usize {
        if self.packed.is_some() { self.view.strides()[1] } else { 0 }
    }

    /// Copies the last row for the packed kernel, which reads some bytes beyond the last pixel.
    pub(super) fn prepare(&self, plan: &mut Plan) {
        let (Some(_), Samples::U8(samples)) = (self.packed, self.view.samples()) else { return };
        let last = samples.get((self.view.height() - 1) * self.view.strides()[0]..).unwrap_or_default();
        plan.last_row.clear();
        if last.len() < plan.packed().reach() {
            plan.last_row.extend_from_slice(last);
            plan.last_row.resize(last.len() + TAP_BYTES, 0);
        }
    }

    /// Writes `columns` of row `index` of the plan.
    pub(super) fn write<W: Written>(
        &self,
        plan: &Plan,
        index: usize,
        columns: Range<usize>,
        row: &mut Row<'_, W>,
    ) {
        let tap = plan.rows[index];
        let [row_stride, column_stride, _] = self.view.strides();
        if let (Some(packed), Samples::U8(samples)) = (self.packed, self.view.samples()) {
            let source_row = |y: u32| {
                let at_end = y as usize + 1 == self.view.height() && !plan.last_row.is_empty();
                if at_end {
                    &plan.last_row
                } else {
                    samples.get(y as usize * row_stride..).unwrap_or_default()
                }
            };
            let rows = [source_row(tap.first), source_row(tap.second)];
            if packed.write(&PackedRow { rows, weight: tap.weight }, plan.packed(), columns.clone(), row) {
                return;
            }
        }
        let columns = &plan.columns[columns];
        let strides = [row_stride, column_stride];
        match self.view.samples() {
            Samples::U8(samples) => blend_row(samples, strides, tap, columns, &self.finish, row),
            Samples::U16(samples) => blend_row(samples, strides, tap, columns, &self.finish, row),
            Samples::F32(samples) => blend_row(samples, strides, tap, columns, &self.finish, row),
        }
    }
    /// Writes the pixels along `line`.
    pub(super) fn warp<W: Written>(&self, line: Line, border: Border, row: &mut Row<'_, W>) {
        match self.view.samples() {
            Samples::U8(samples) => warp_row(samples, &self.view, line, border, &self.finish, row),
            Samples::U16(samples) => warp_row(samples, &self.view, line, border, &self.finish, row),
            Samples::F32(samples) => warp_row(samples, &self.view, line, border, &self.finish, row),
        }
    }
}
