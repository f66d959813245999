//! KITTI's rules: classes, overlaps, difficulties, and which objects count.

/// An evaluated class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KittiClass {
    /// Cars; vans are ignored.
    Car,
    /// Pedestrians; sitting persons are ignored.
    Pedestrian,
    /// Cyclists.
    Cyclist,
}

/// Kind of overlap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KittiOverlap {
    /// Boxes in the image.
    Image,
    /// Rotated boxes on the ground, in bird's-eye view.
    Ground,
    /// 3D boxes.
    Space,
}

/// Difficulty: the ground truth that counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KittiDifficulty {
    /// Visible, at most 15 % outside the image, more than 40 pixels high.
    Easy,
    /// At most partly occluded, at most 30 % outside the image, more than 25 pixels high.
    Moderate,
    /// At most largely occluded, at most 50 % outside the image, more than 25 pixels high.
    Hard,
}

impl KittiClass {
    /// All classes.
    pub const ALL: [Self; 3] = [Self::Car, Self::Pedestrian, Self::Cyclist];

    /// Returns the name in keys, e.g. `"car"`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Car => "car",
            Self::Pedestrian => "pedestrian",
            Self::Cyclist => "cyclist",
        }
    }
}

impl KittiOverlap {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Image, Self::Ground, Self::Space];

    /// Returns the name in keys: `"2d"`, `"bev"` or `"3d"`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Image => "2d",
            Self::Ground => "bev",
            Self::Space => "3d",
        }
    }
}

impl KittiDifficulty {
    /// All difficulties.
    pub const ALL: [Self; 3] = [Self::Easy, Self::Moderate, Self::Hard];

    /// Returns the name in keys, e.g. `"moderate"`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Easy => "easy",
            Self::Moderate => "moderate",
            Self::Hard => "hard",
        }
    }

    /// Returns the minimum height in pixels.
    const fn least_height(self) -> f64 {
        match self {
            Self::Easy => 40.0,
            Self::Moderate | Self::Hard => 25.0,
        }
    }

    fn counts(self, ground_truth: &Traits) -> bool {
        let (occluded, truncated) = match self {
            Self::Easy => (0, 0.15),
            Self::Moderate => (1, 0.3),
            Self::Hard => (2, 0.5),
        };
        ground_truth.occluded <= occluded
            && ground_truth.truncated <= truncated
            && ground_truth.height > self.least_height()
    }
}

/// Types that the rules distinguish.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ObjectKind {
    Class(KittiClass),
    Van,
    PersonSitting,
    DontCare,
    Other,
}

impl ObjectKind {
    pub(super) fn from_name(name: &str) -> Self {
        let kinds = [
            ("car", Self::Class(KittiClass::Car)),
            ("pedestrian", Self::Class(KittiClass::Pedestrian)),
            ("cyclist", Self::Class(KittiClass::Cyclist)),
            ("van", Self::Van),
            ("person_sitting", Self::PersonSitting),
            ("dontcare", Self::DontCare),
        ];
        kinds
            .into_iter()
            .find(|(label, _)| label.eq_ignore_ascii_case(name))
            .map_or(Self::Other, |(_, kind)| kind)
    }

    fn is_neighbour_of(self, class: KittiClass) -> bool {
        matches!((self, class), (Self::Van, KittiClass::Car) | (Self::PersonSitting, KittiClass::Pedestrian))
    }
}

/// Properties of an object that the rules use.
#[derive(Debug, Clone, Copy)]
pub(super) struct Traits {
    pub kind: ObjectKind,
    /// Height in the image, in pixels.
    pub height: f64,
    pub truncated: f64,
    pub occluded: i32,
}

/// Role of an object in the matching.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Ground truth and predictions that count.
    Counts,
    /// Takes part in the matching, but neither it nor its partner counts.
    Ignored,
    /// Does not take part, as an object of another class.
    Absent,
}

/// One row and column of KITTI's result tables.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rules {
    pub class: KittiClass,
    pub overlap: KittiOverlap,
    pub difficulty: KittiDifficulty,
    /// Whether to use the lower limits for boxes on the ground and in space.
    pub is_loose: bool,
}

impl Rules {
    /// Returns all rows and columns.
    pub fn all() -> impl Iterator<Item = Self> {
        KittiClass::ALL.into_iter().flat_map(|class| {
            KittiOverlap::ALL.into_iter().flat_map(move |overlap| {
                let looseness = if overlap == KittiOverlap::Image { &[false][..] } else { &[false, true] };
                looseness.iter().flat_map(move |&is_loose| {
                    KittiDifficulty::ALL.map(|difficulty| Self { class, overlap, difficulty, is_loose })
                })
            })
        })
    }

    /// Returns the limit of the overlap: matching boxes overlap by more.
    pub fn least_overlap(&self) -> f64 {
        match (self.class, self.is_loose) {
            (KittiClass::Car, false) => 0.7,
            (KittiClass::Car, true) | (_, false) => 0.5,
            (_, true) => SMALLEST_LEAST_OVERLAP,
        }
    }

    pub fn role_of_ground_truth(&self, ground_truth: &Traits) -> Role {
        if ground_truth.kind == ObjectKind::Class(self.class) {
            return if self.difficulty.counts(ground_truth) { Role::Counts } else { Role::Ignored };
        }
        if ground_truth.kind.is_neighbour_of(self.class) { Role::Ignored } else { Role::Absent }
    }

    /// Returns the role of a prediction. Small predictions of every class are ignored, even if they match, as in KITTI's development kit.
    pub fn role_of_found(&self, found: &Traits) -> Role {
        if found.height.abs() < self.difficulty.least_height() {
            return Role::Ignored;
        }
        if found.kind == ObjectKind::Class(self.class) { Role::Counts } else { Role::Absent }
    }
}

/// Lowest limit of the overlap over all rules.
pub(super) const SMALLEST_LEAST_OVERLAP: f64 = 0.25;
