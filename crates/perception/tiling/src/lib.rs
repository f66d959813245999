//! Large pictures in tiles: small things in them are found by networks that see only a few hundred pixels.
//!
//! [`Tiles`] says which tiles of a picture are worth a look, and in which order: those with detail that were not looked at
//! yet or changed since, where objects were seen first, the others in turn. [`look_side_by_side`] looks at them on several
//! threads until the time is over; where time is short, small parts of several tiles are put side by side and looked at as one
//! ([`Looks`]). What lies in the overlap of tiles or is cut by their borders is put together by
//! [`merge_pieces`]. [`picture_learner`](PictureLearner) is what looks: any learner of one picture that remembers nothing.
//!
//! Tiles that did not change keep the answer of their last look, so a camera that stands pays for what moves (the idea of
//! regions of interest by difference, after B. Unel et al., "The Power of Tiling for Small Object Detection", CVPR
//! Workshops 2019, and F. C. Akyon et al., "Slicing Aided Hyper Inference", ICIP 2022, for tiles and their merging).

mod looking;
mod packing;
mod picture_learner;
mod pieces;
mod schedule;
mod tile_picture;

use opendr_engine::params::Params;

pub use looking::{Allowance, look_side_by_side};
pub use packing::{Looks, Slot};
pub use picture_learner::{Open, PictureLearner, open_as, open_copies, open_picture_learner};
pub use pieces::{Cut, Piece, merge_pieces};
pub use schedule::{Tile, Tiles};
pub use tile_picture::TilePicture;

/// How a large picture is looked at.
#[derive(Debug, Clone, Params)]
pub struct TilingParams {
    /// Side of a tile in the picture. What is looked for should fill a tenth of it or more.
    #[param(default = 256, range = 32..=4096, unit = "px", live)]
    pub tile: usize,
    /// What neighbouring tiles share: what is smaller lies whole in one of them. At most half of a tile counts.
    #[param(default = 48, range = 0..=2048, unit = "px", live)]
    pub tile_overlap: usize,
    /// Whether the whole picture is looked at, too: for what is larger than a tile.
    #[param(default = true, live)]
    pub whole: bool,
    /// Time for one picture; a tile that has begun is finished, and one is always looked at. 0: no limit, and answers that
    /// depend on nothing but the pictures.
    #[param(default = 0.0, range = 0.0..=60000.0, unit = "ms", live)]
    pub time_budget: f32,
    /// At most so many tiles of one picture are looked at, the others in the next ones; 0: no limit.
    #[param(default = 0, range = 0..=100000, live)]
    pub max_tiles: usize,
    /// A tile in which brightness differs by no more than this within 16 pixels, 0..=255, is empty; 0: no tile is.
    #[param(default = 16.0, range = 0.0..=255.0, live)]
    pub detail_threshold: f32,
    /// A tile is looked at again once the brightness of 16 x 16 pixels in it changed by more than this, 0..=255; until then
    /// its last answer holds. 0: always.
    #[param(default = 6.0, range = 0.0..=255.0, live)]
    pub change_threshold: f32,
    /// For so many pictures the answer of a tile that changed holds, if there was no time to look again.
    #[param(default = 5, range = 0..=1000, live)]
    pub memory: u32,
    /// In every so-manyth picture the tile that was not looked at for longest is, be there anything or not; 0: never.
    #[param(default = 4, range = 0..=1000, live)]
    pub rotation: u32,
    /// Tiles that are looked at side by side, each on a thread with a copy of the network; 0: as many as there are cores,
    /// at most four.
    #[param(default = 0, range = 0..=64)]
    pub parallel_tiles: usize,
}
