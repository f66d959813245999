//! The fast kernels: `u8` images with pixels of 3 or 4 contiguous bytes.
//!
//! # Dispatch
//! At run time, by CPU features:
//! * x86-64 with AVX2 and FMA: `kernels_x86.rs`.
//! * Anything else: the kernel of `strided.rs`, which the compiler vectorises as far as it can.
//!
//! Both blend to within about 0.01 of a level; the order of summation differs, and so do the last bits.

use std::ops::Range;

use opendr_engine::data::{ImageView, Samples};

use crate::preprocess::band::Row;
#[cfg(target_arch = "x86_64")]
use crate::preprocess::kernels_x86 as kernels;
use crate::preprocess::packed::{BLOCK, Packed, PackedRow};
use crate::preprocess::plan::{PackedColumns, TAP_BYTES};
use crate::preprocess::sample::Written;
use crate::preprocess::strided::Finish;

impl Packed {
    /// Returns `None` where the kernels cannot read `view` or the CPU does not support them.
    pub(super) fn for_view(view: &ImageView<'_>, finish: &Finish) -> Option<Self> {
        let [row, step, channel] = view.strides();
        let reads = matches!(view.samples(), Samples::U8(_))
            && (step == 3 || step == 4)
            && channel == 1
            && view.width() >= TAP_BYTES
            && row >= view.width() * step
            && view.format().channels() >= 3
            && view.width().max(row) < (i32::MAX / 4) as usize
            && !finish.luminance;
        if !reads || !supported() {
            return None;
        }
        let mut shuffle = [0x80; 16];
        for (word, &channel) in shuffle.as_chunks_mut::<4>().0.iter_mut().zip(&finish.channels) {
            *word = [channel as u8, 0x80, (channel + step) as u8, 0x80];
        }
        Some(Self { shuffle, scale: finish.scale, bias: finish.bias })
    }

    /// Writes `columns` into `row`; returns `false` when there are too few for a kernel.
    pub(super) fn write<W: Written>(
        &self,
        source: &PackedRow<'_>,
        plan: &PackedColumns,
        columns: Range<usize>,
        row: &mut Row<'_, W>,
    ) -> bool {
        let fits = columns.len() >= BLOCK && row.channels == 3 && row.columns() == columns.len();
        if fits {
            kernels_write(self, source, plan, columns, row);
        }
        fits
    }
}

#[cfg(target_arch = "x86_64")]
fn supported() -> bool {
    kernels::supported()
}

#[cfg(target_arch = "x86_64")]
fn kernels_write<W: Written>(
    packed: &Packed,
    source: &PackedRow<'_>,
    plan: &PackedColumns,
    columns: Range<usize>,
    row: &mut Row<'_, W>,
) {
    kernels::write(packed, source, plan, columns, row);
}

#[cfg(not(target_arch = "x86_64"))]
fn supported() -> bool {
    false
}

#[cfg(not(target_arch = "x86_64"))]
fn kernels_write<W: Written>(
    _: &Packed,
    _: &PackedRow<'_>,
    _: &PackedColumns,
    _: Range<usize>,
    _: &mut Row<'_, W>,
) {
}
