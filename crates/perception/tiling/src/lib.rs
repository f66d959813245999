//! Tiled inference over large images: scheduling of tiles, time budgets, and merging of boxes.
//!
//! Networks with inputs of a few hundred pixels miss small objects in large images; over tiles they detect them. [`Tiles`]
//! selects the tiles to process in each image and their order: tiles with detail that are new or changed, those with objects
//! and others in turn. [`run_within_budget`] processes them on several threads until the time budget is used. With little time,
//! small parts of several tiles share one inference ([`TileInferences`]). [`merge_pieces`] merges the boxes of overlapping tiles and of
//! objects that tile borders cut. [`ImageLearner`] is a learner of one image without state, which runs on the tiles.
//!
//! Tiles without a change keep the result of their last inference, so a fixed camera pays for motion only. The regions of
//! interest by difference follow B. Unel et al., "The Power of Tiling for Small Object Detection", CVPR Workshops 2019; tiles
//! and their merging also F. C. Akyon et al., "Slicing Aided Hyper Inference", ICIP 2022.
//!
//! The learners over tiles are in `opendr-detection` and `opendr-segmentation`, regions and brightness per cell in
//! `opendr-perception-common`. Begin with [`Tiles`].
//!
//! ```
//! use opendr_engine::data::Image;
//! use opendr_tiling::{Tiles, TilingParams};
//!
//! let params = TilingParams { tile: 64, tile_overlap: 16, detail_threshold: 0.0, ..TilingParams::default() };
//! let image = Image::from_rgb8(vec![128; 160 * 120 * 3], 160, 120)?;
//! let mut tiles = Tiles::default();
//! let is_other_scene = tiles.plan(&params, image.view(), |_, _| false)?;
//! assert!(is_other_scene);
//! // The whole image is the first tile.
//! assert_eq!(tiles.tiles()[0].region.width, 160);
//! assert_eq!(tiles.order().len(), tiles.tiles().len());
//! # Ok::<(), opendr_engine::Error>(())
//! ```

mod image_learner;
mod packing;
mod pieces;
mod schedule;
mod tile_picture;
mod time_budget;

use opendr_engine::params::Params;

pub use image_learner::{ImageLearner, Open, open_as, open_copies, open_image_learner};
pub use packing::{Slot, TileInferences};
pub use pieces::{Cut, Piece, merge_pieces};
pub use schedule::{Tile, Tiles};
pub use tile_picture::TileImage;
pub use time_budget::{TimeBudget, run_within_budget};

/// Parameters of the tiling.
#[derive(Debug, Clone, Params)]
pub struct TilingParams {
    /// Side of a tile in the image. Objects should cover a tenth of it or more.
    #[param(default = 256, range = 32..=4096, unit = "px", live)]
    pub tile: usize,
    /// Overlap of neighbouring tiles: a smaller object is completely in one of them. At most half of a tile counts.
    #[param(default = 48, range = 0..=2048, unit = "px", live)]
    pub tile_overlap: usize,
    /// Whether the whole image is processed too, for objects larger than a tile.
    #[param(default = true, live)]
    pub whole: bool,
    /// Time budget per image. A tile in progress is finished, and one is always processed. With 0 there is no limit, and
    /// the results are deterministic.
    #[param(default = 0.0, range = 0.0..=60000.0, unit = "ms", live)]
    pub time_budget: f32,
    /// Maximum number of tiles per image; the others are processed in the next images. 0: no limit.
    #[param(default = 0, range = 0..=100000, live)]
    pub max_tiles: usize,
    /// Range of brightness within 16 pixels, 0..=255, up to which a tile is empty; 0: no tile is.
    #[param(default = 16.0, range = 0.0..=255.0, live)]
    pub detail_threshold: f32,
    /// Change of the brightness of 16 x 16 pixels, 0..=255, above which a tile is processed again; until then its last
    /// result is valid. 0: always.
    #[param(default = 6.0, range = 0.0..=255.0, live)]
    pub change_threshold: f32,
    /// Number of images for which the last result of a changed tile stays valid, if there is no time to process it again.
    #[param(default = 5, range = 0..=1000, live)]
    pub memory: u32,
    /// Number of images after which the tile that was processed longest ago is processed again, in any case; 0: never.
    #[param(default = 4, range = 0..=1000, live)]
    pub rotation: u32,
    /// Number of tiles that are processed in parallel, each on a thread with a copy of the network; 0: the number of cores,
    /// at most four.
    #[param(default = 0, range = 0..=64)]
    pub parallel_tiles: usize,
}
