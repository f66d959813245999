//! Synonyms of classes in published data sets.

/// Names of the same class in COCO, COCO panoptic, Pascal VOC, KITTI, Cityscapes, CamVid, ADE20K, Open Images, AffectNet and
/// RAVDESS. A name may occur in several lines; earlier ones take precedence.
const SYNONYMS: &[&[&str]] = &[
    &["airplane", "aeroplane"],
    &["rider", "cyclist", "bicyclist"],
    &["bicycle", "bike", "cyclist", "bicyclist"],
    &["building", "building-other-merged"],
    &["car", "automobile"],
    &["cell phone", "mobile phone"],
    &["couch", "sofa"],
    &["cow", "cattle"],
    &["dining table", "table"],
    &["donut", "doughnut"],
    &["fence", "fence-merged"],
    &["grass", "grass-merged"],
    &["hair drier", "hair dryer"],
    &["motorcycle", "motorbike", "motorcyclescooter", "minibike"],
    &["person", "pedestrian", "people", "human"],
    &["pole", "column pole"],
    &["potted plant", "houseplant"],
    &["refrigerator", "fridge"],
    &["remote", "remote control"],
    &["sidewalk", "pavement", "pavement-merged"],
    &["sky", "sky-other-merged"],
    &["sports ball", "ball"],
    &["traffic light", "traffic signal"],
    &["traffic sign", "sign symbol"],
    &["train", "tram"],
    &["truck", "lorry"],
    &["tv", "tv monitor", "television", "television receiver"],
    &["vegetation", "tree", "tree-merged"],
    &["wall", "wall-other-merged"],
    &["anger", "angry"],
    &["disgust", "disgusted"],
    &["fear", "fearful"],
    &["happiness", "happy"],
    &["neutral", "neutrality"],
    &["sadness", "sad"],
    &["surprise", "surprised"],
];

/// A published grouping of finer classes; it applies to data sets with all of its classes.
struct Grouping {
    /// Each class with its finer classes.
    groups: &'static [(&'static str, &'static [&'static str])],
}

/// SegNet's grouping of CamVid's 32 classes into 11 (V. Badrinarayanan, A. Kendall, R. Cipolla, arXiv 1511.00561), with the names of
/// the same classes in Cityscapes.
const GROUPINGS: &[Grouping] = &[Grouping {
    groups: &[
        ("sky", &[]),
        ("building", &["wall", "bridge", "tunnel", "archway"]),
        ("pole", &["traffic cone"]),
        ("road", &["LaneMkgsDriv", "LaneMkgsNonDriv"]),
        ("pavement", &["ParkingBlock", "RoadShoulder"]),
        ("tree", &["VegetationMisc", "terrain"]),
        ("SignSymbol", &["Misc_Text", "traffic light"]),
        ("fence", &[]),
        ("car", &["SUVPickupTruck", "Truck_Bus", "OtherMoving", "truck", "bus", "train"]),
        ("pedestrian", &["child", "CartLuggagePram", "animal"]),
        ("bicyclist", &["MotorcycleScooter", "motorcycle"]),
    ],
}];

/// Returns the letters and digits in lower case: names are compared without case, spaces, hyphens and underscores.
pub(super) fn plain(label: &str) -> String {
    label.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Returns the spellings of a name in normalised form; a name may list several (ADE20K's "car, auto, automobile").
pub(super) fn spellings(label: &str) -> impl Iterator<Item = String> + '_ {
    let parts = label.split(',').filter(move |part| part.len() < label.len());
    std::iter::once(label).chain(parts).map(plain).filter(|name| !name.is_empty())
}

/// How a class was matched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MatchedBy {
    /// By a pair of the user.
    Pair,
    /// By its name.
    Name,
    /// By a synonym.
    Synonym,
    /// As a part of a class in a published grouping.
    Grouping,
}

/// Returns the index of the first of `classes` that `label` matches, and how.
pub(super) fn find<'a>(label: &str, classes: impl Iterator<Item = &'a str>) -> Option<(usize, MatchedBy)> {
    let known: Vec<Vec<String>> = classes.map(|class| spellings(class).collect()).collect();
    let named = |wanted: &str| known.iter().position(|spellings| spellings.iter().any(|name| name == wanted));
    let own: Vec<String> = spellings(label).collect();
    if let Some(index) = own.iter().find_map(|name| named(name)) {
        return Some((index, MatchedBy::Name));
    }
    for name in &own {
        let lines = SYNONYMS.iter().filter(|words| words.iter().any(|word| plain(word) == *name));
        if let Some(index) = lines.flat_map(|words| words.iter()).find_map(|word| named(&plain(word))) {
            return Some((index, MatchedBy::Synonym));
        }
    }
    for Grouping { groups } in GROUPINGS {
        if groups.iter().any(|(class, _)| named(&plain(class)).is_none()) {
            continue;
        }
        let group = groups.iter().find(|(_, finer)| finer.iter().any(|word| own.contains(&plain(word))));
        if let Some(index) = group.and_then(|(class, _)| named(&plain(class))) {
            return Some((index, MatchedBy::Grouping));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::classes::tests::CAMVID;

    fn found(label: &str, classes: &[&'static str]) -> Option<(&'static str, MatchedBy)> {
        find(label, classes.iter().copied()).map(|(index, by)| (classes[index], by))
    }

    #[test]
    fn names_precede_synonyms_and_groupings() {
        let classes =
            ["aeroplane", "Traffic_Light", "pedestrian", "car, auto, automobile", "rider", "bicycle"];
        let cases = [
            ("traffic light", Some(("Traffic_Light", MatchedBy::Name))),
            ("Automobile", Some(("car, auto, automobile", MatchedBy::Name))),
            ("airplane", Some(("aeroplane", MatchedBy::Synonym))),
            ("Cyclist", Some(("rider", MatchedBy::Synonym))),
            ("bike", Some(("bicycle", MatchedBy::Synonym))),
            ("truck", None),
            ("", None),
            (",", None),
        ];
        for (label, wanted) in cases {
            assert_eq!(found(label, &classes), wanted, "{label}");
        }
    }

    #[test]
    fn groupings_apply_to_their_own_data_set() {
        assert_eq!(found("truck", &CAMVID), Some(("Car", MatchedBy::Grouping)));
        assert_eq!(found("wall", &CAMVID), Some(("Building", MatchedBy::Grouping)));
        assert_eq!(found("sidewalk", &CAMVID), Some(("Pavement", MatchedBy::Synonym)));
        assert_eq!(found("truck", &CAMVID[1..]), None);
    }
}
