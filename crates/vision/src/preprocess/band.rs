//! Bands of rows of a network's input, one per thread.

use std::ops::Range;
use std::sync::Mutex;

use opendr_engine::data::Layout;

use crate::preprocess::sample::{InputSample, Written};

/// Maximum number of bands; enough to balance threads that start late or are interrupted.
pub(super) const MAX_BANDS: usize = 16;

/// Columns that are buffered on the stack when samples need conversion.
const TILE: usize = 128;

/// Consecutive rows of a network's input.
pub(super) struct Band<'a, T> {
    first_row: usize,
    rows: usize,
    all: Row<'a, T>,
}

/// Some columns of one row, or of several consecutive rows of a band.
pub(super) struct Row<'a, T> {
    /// One slice per channel; interleaved channels share the first.
    pub(super) planes: [&'a mut [T]; 3],
    /// 1 or 3.
    pub(super) channels: usize,
    /// Whether the three channels are interleaved.
    pub(super) interleaved: bool,
}

impl<'a, T: InputSample> Band<'a, T> {
    /// Returns the whole input of `width` x `height` pixels.
    pub(super) fn whole(
        out: &'a mut [T],
        [width, height]: [usize; 2],
        channels: usize,
        layout: Layout,
    ) -> Self {
        let interleaved = layout == Layout::Hwc && channels == 3;
        let planes = if channels == 3 && !interleaved {
            let (first, rest) = out.split_at_mut(width * height);
            let (second, third) = rest.split_at_mut(width * height);
            [first, second, third]
        } else {
            [out, Default::default(), Default::default()]
        };
        Self { first_row: 0, rows: height, all: Row { planes, channels, interleaved } }
    }

    /// Cuts the band into `count` bands for threads to take.
    pub(super) fn cut(mut self, count: usize) -> [Mutex<Option<Self>>; MAX_BANDS] {
        let count = count.clamp(1, MAX_BANDS);
        std::array::from_fn(|index| {
            let band = (index < count).then(|| self.take_front(self.rows / (count - index)));
            Mutex::new(band)
        })
    }

    fn take_front(&mut self, rows: usize) -> Self {
        let planes = self.all.planes.each_mut().map(|plane| {
            let samples = plane.len() / self.rows.max(1) * rows;
            let (front, back) = std::mem::take(plane).split_at_mut(samples);
            *plane = back;
            front
        });
        let front = Self { first_row: self.first_row, rows, all: Row { planes, ..self.all } };
        self.first_row += rows;
        self.rows -= rows;
        front
    }

    /// Calls `write` with the row index (in the whole input) and the columns of each row.
    pub(super) fn for_each_row(&mut self, mut write: impl FnMut(usize, Row<'_, T>)) {
        let columns = self.all.columns() / self.rows.max(1);
        for row in 0..self.rows {
            write(self.first_row + row, self.all.part(row * columns..(row + 1) * columns));
        }
    }
}

impl<T> Row<'_, T> {
    /// Returns the number of pixels.
    pub(super) fn columns(&self) -> usize {
        self.planes[0].len() / self.pixel()
    }

    /// Returns the samples from one pixel to the next within a slice.
    fn pixel(&self) -> usize {
        if self.interleaved { 3 } else { 1 }
    }

    /// Returns the pixels of `columns`.
    pub(super) fn part(&mut self, columns: Range<usize>) -> Row<'_, T> {
        let samples = columns.start * self.pixel()..columns.end * self.pixel();
        Row {
            planes: self.planes.each_mut().map(|plane| plane.get_mut(samples.clone()).unwrap_or_default()),
            channels: self.channels,
            interleaved: self.interleaved,
        }
    }
}

impl<T: InputSample> Row<'_, T> {
    /// Sets every pixel to `values`, one per channel.
    pub(super) fn fill(&mut self, values: [f32; 3]) {
        let values = values.map(|value| T::from_written(T::Written::from_value(value)));
        if self.interleaved {
            // From the second pixel on, each doubling is one copy.
            let mut done = self.planes[0].len().min(3);
            self.planes[0][..done].copy_from_slice(&values[..done]);
            while done < self.planes[0].len() {
                let more = done.min(self.planes[0].len() - done);
                self.planes[0].copy_within(..more, done);
                done += more;
            }
        } else {
            for (plane, value) in self.planes.iter_mut().zip(values) {
                plane.fill(value);
            }
        }
    }

    /// Calls `write` for successive columns of the row, with a buffer where samples need conversion.
    pub(super) fn fill_with(mut self, mut write: impl FnMut(Range<usize>, Row<'_, T::Written>)) {
        let (columns, channels, interleaved) = (self.columns(), self.channels, self.interleaved);
        if let [Some(first), Some(second), Some(third)] =
            self.planes.each_mut().map(|plane| T::in_place(plane))
        {
            return write(0..columns, Row { planes: [first, second, third], channels, interleaved });
        }
        let mut written = [T::Written::default(); 3 * TILE];
        for start in (0..columns).step_by(TILE) {
            let range = start..columns.min(start + TILE);
            let planes = if interleaved {
                [&mut written[..3 * range.len()], Default::default(), Default::default()]
            } else {
                let (first, rest) = written.split_at_mut(TILE);
                let (second, third) = rest.split_at_mut(TILE);
                [first, second, third].map(|plane| &mut plane[..range.len()])
            };
            let mut tile = Row { planes, channels, interleaved };
            write(range.clone(), tile.part(0..range.len()));
            for (samples, written) in self.part(range).planes.into_iter().zip(&tile.planes) {
                for (sample, written) in samples.iter_mut().zip(written.iter()) {
                    *sample = T::from_written(*written);
                }
            }
        }
    }
}
