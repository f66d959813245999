//! A depthwise convolution and the pointwise one that follows it, band by band: what lies between them stays in the cache.

use super::depthwise::DepthwiseConvolution;
use super::geometry::{Convolution, Strides, Window};
use super::piece;
use crate::aligned::{BANDS, with_buffer};
use crate::compute::Compute;
use crate::cost::LayerCost;
use crate::pool::Pieces;

/// Numbers between the two convolutions that a thread has at a time.
const BAND: usize = 1 << 15;

/// A depthwise convolution and the pointwise one that reads its output.
#[derive(Debug, Clone)]
pub struct DepthwisePointwise {
    depthwise: DepthwiseConvolution,
    pointwise: Convolution,
}

impl DepthwisePointwise {
    /// Joins two convolutions; `None` where the second is not a pointwise one of the first one's output with channels last and few
    /// weights, which every band reads.
    pub fn new(depthwise: &DepthwiseConvolution, pointwise: &Convolution) -> Option<Self> {
        let window = pointwise.window;
        let (filters, between) = (&pointwise.filters, depthwise.window.output);
        let (inner, outer) = (filters.channels(), filters.outputs());
        let y = Strides::channels_last(between, outer);
        let fits = window.is_pointwise()
            && window.input == between
            && pointwise.batch == depthwise.batch
            && filters.groups() == 1
            && !filters.is_planar()
            && inner == depthwise.filters.channels()
            && depthwise.y == Strides::channels_last(between, inner)
            && pointwise.x == depthwise.y
            && pointwise.y == y
            && pointwise.residual == y;
        let [height, width] = between;
        let has_bands = height * width * inner > BAND && width * inner <= BAND && inner * outer <= BAND;
        (fits && has_bands).then(|| Self { depthwise: depthwise.clone(), pointwise: pointwise.clone() })
    }

    /// Makes the pair write its output to some of the channels of wider images, which lie last.
    pub fn widen(&mut self, channels: usize) {
        self.pointwise.y = Strides::channels_last(self.pointwise.window.output, channels);
    }

    /// Returns the arithmetic and the bytes of the weights.
    pub fn cost(&self) -> LayerCost {
        self.depthwise.cost() + self.pointwise.cost()
    }

    /// Computes both convolutions. `residual` has the shape of the output.
    ///
    /// # Panics
    /// When the slices are shorter than the shapes and strides require.
    pub fn run(&self, compute: &Compute, x: &[f32], residual: Option<&[f32]>, y: &mut [f32]) {
        let Self { depthwise, pointwise } = self;
        if depthwise.is_empty() || pointwise.filters.outputs() == 0 {
            return;
        }
        depthwise.check(x);
        let [height, width] = depthwise.window.output;
        let (inner, outer) = (pointwise.filters.channels(), pointwise.filters.outputs());
        let (pixels, total) = (depthwise.batch * height * width, pointwise.y.pixel);
        assert!(total >= outer, "pixels of the output must lie apart");
        let is_long = y.len() >= (pixels - 1) * total + outer
            && residual.is_none_or(|residual| residual.len() >= pixels * outer);
        assert!(is_long, "the output or the residual is too short");
        if let Some(slopes) = &pointwise.finish.slopes {
            assert!(
                slopes.len() >= pointwise.filters.padded_outputs(),
                "one slope per output channel, rounded up"
            );
        }
        let at_least = height.div_ceil(4 * compute.pool().threads()).max(1);
        let job = depthwise.job(x, (BAND / (width * inner)).clamp(1, at_least));
        let isa = compute.isa();
        let lines = Pieces::new(y, width * total);
        compute.pool().run(job.pieces(), |piece| {
            let (image, rows) = job.rows(piece);
            let (pixels, first) = (rows.len() * width, image * height + rows.start);
            with_buffer(&BANDS, pixels * inner, |between| {
                // SAFETY: the input has been checked, and the buffer has the length of the rows.
                unsafe { job.run_to(isa, piece, between) };
                let size = [1, pixels];
                let band = Convolution {
                    window: Window { input: size, output: size, ..pointwise.window },
                    batch: 1,
                    x: Strides::channels_last(size, inner),
                    y: Strides::channels_last(size, total),
                    residual: Strides::channels_last(size, outer),
                    ..pointwise.clone()
                };
                // SAFETY: pieces write disjoint lines.
                let y = unsafe { lines.span(first, rows.len()) };
                let residual = residual.map(|residual| &residual[first * width * outer..]);
                // SAFETY: sizes have been checked.
                unsafe { piece::run(&band, None, between, residual, y.as_mut_ptr()) };
            });
        });
    }
}
