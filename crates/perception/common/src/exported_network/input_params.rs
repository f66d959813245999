//! Parameters of a network's image input, and what is recognised of it.

use opendr_engine::params::Params;

opendr_engine::choices! {
    /// How an image becomes the network's input.
    pub enum InputResize {
        /// Recognised from the network.
        Auto = "auto",
        /// The aspect ratio is kept; padding on all sides.
        Letterbox = "letterbox",
        /// The aspect ratio is kept; padding on the right and at the bottom.
        TopLeft = "top_left",
        /// The same, with truncated sides (YOLOX).
        TopLeftTruncated = "top_left_truncated",
        /// The whole input is filled.
        Stretch = "stretch",
    }
}

opendr_engine::choices! {
    /// Order of the colour channels of the network's input.
    pub enum InputColour {
        /// Recognised from the network.
        Auto = "auto",
        /// Red, green, blue.
        Rgb = "rgb",
        /// Blue, green, red.
        Bgr = "bgr",
    }
}

opendr_engine::choices! {
    /// Range of the samples of the network's input.
    pub enum InputLevels {
        /// Recognised from the network.
        Auto = "auto",
        /// 0 to 255.
        Bytes = "0_255",
        /// 0 to 1.
        Unit = "0_1",
        /// -1 to 1.
        Signed = "-1_1",
        /// Mean 0 and variance 1 over ImageNet.
        ImageNet = "imagenet",
        /// Mean 0 and variance 1 over the images of CLIP's training.
        Clip = "clip",
    }
}

const IMAGENET_MEAN: [f32; 3] = [123.675, 116.28, 103.53];
const IMAGENET_STD: [f32; 3] = [58.395, 57.12, 57.375];
// Those of the original CLIP (Radford et al., "Learning Transferable Visual Models From Natural Language Supervision", ICML 2021), times 255.
const CLIP_MEAN: [f32; 3] = [122.770_94, 116.746_01, 104.093_74];
const CLIP_STD: [f32; 3] = [68.500_53, 66.632_19, 70.323_16];

impl InputLevels {
    /// Returns mean and standard deviation of red, green and blue, in levels of 0 to 255, by which samples are normalised.
    pub const fn mean_and_std(self) -> ([f32; 3], [f32; 3]) {
        match self {
            Self::Auto | Self::Bytes => ([0.0; 3], [1.0; 3]),
            Self::Unit => ([0.0; 3], [255.0; 3]),
            Self::Signed => ([127.5; 3], [127.5; 3]),
            Self::ImageNet => (IMAGENET_MEAN, IMAGENET_STD),
            Self::Clip => (CLIP_MEAN, CLIP_STD),
        }
    }
}

/// Parameters of a network's image input.
#[derive(Debug, Clone, Params)]
pub struct InputParams {
    /// How an image becomes the network's input.
    pub resize: InputResize,
    /// Level of the padding of a letterbox; recognised from the network if absent.
    #[param(range = 0..=255)]
    pub padding: Option<usize>,
    /// Order of the colour channels of the network's input.
    pub colour: InputColour,
    /// Range of the samples of the network's input.
    pub levels: InputLevels,
    /// Side of the network's input, for models of dynamic size; if absent that of its convention, 640 for most.
    #[param(range = 32..=4096, unit = "px")]
    pub size: Option<usize>,
}

/// What is known of a network's image input; `Auto` where a parameter has to state it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputConvention {
    /// How an image becomes the network's input.
    pub resize: InputResize,
    /// Level of the padding of a letterbox.
    pub padding: usize,
    /// Order of the colour channels.
    pub colour: InputColour,
    /// Range of the samples.
    pub levels: InputLevels,
    /// Side of an input of dynamic size.
    pub size: usize,
}

impl InputConvention {
    /// Nothing is known but the usual side of inputs of dynamic size.
    pub const UNKNOWN: Self = Self {
        resize: InputResize::Auto,
        padding: 0,
        colour: InputColour::Auto,
        levels: InputLevels::Auto,
        size: 640,
    };

    /// Input of YOLOv3 to v12 and YOLO26: letterbox with padding of 114, RGB, 0 to 1.
    pub const YOLO: Self = Self {
        resize: InputResize::Letterbox,
        padding: 114,
        colour: InputColour::Rgb,
        levels: InputLevels::Unit,
        ..Self::UNKNOWN
    };

    /// Returns the names of the parameters that are still to be set.
    pub fn missing(&self) -> impl Iterator<Item = &'static str> {
        let all = [
            ("resize", self.resize == InputResize::Auto),
            ("colour", self.colour == InputColour::Auto),
            ("levels", self.levels == InputLevels::Auto),
        ];
        all.into_iter().filter(|(_, is_missing)| *is_missing).map(|(name, _)| name)
    }
}

impl InputParams {
    /// Returns the side of an input of dynamic size.
    pub fn side(&self) -> usize {
        self.size.unwrap_or(InputConvention::UNKNOWN.size)
    }

    /// Combines the parameters with what was recognised, and writes the result into the parameters.
    pub fn settle(&mut self, known: InputConvention) -> InputConvention {
        if self.resize == InputResize::Auto {
            self.resize = known.resize;
        }
        if self.colour == InputColour::Auto {
            self.colour = known.colour;
        }
        if self.levels == InputLevels::Auto {
            self.levels = known.levels;
        }
        let padding = *self.padding.get_or_insert(known.padding);
        let size = self.size.unwrap_or(known.size);
        InputConvention { resize: self.resize, padding, colour: self.colour, levels: self.levels, size }
    }
}
