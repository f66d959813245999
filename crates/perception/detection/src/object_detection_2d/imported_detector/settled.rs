//! The convention that parameters and recognition settle together.

use opendr_engine::{Error, Result};
use opendr_perception_common::exported_network::Facts;

use super::convention::{Convention, UNKNOWN};
use super::params::{
    BoxAngle, BoxFormat, BoxUnit, ImportedDetectorParams, MaskOutput, Objectness, OutputLayout, RowOrder,
    ScoreFormat,
};

/// Combines the parameters with what was recognised, and writes the result into the parameters.
///
/// # Errors
/// `Unsupported` when something is neither recognised nor given; the message has the network's outputs and the parameters to set.
pub(super) fn settle(
    params: &mut ImportedDetectorParams,
    recognised: Option<Convention>,
    facts: &Facts,
) -> Result<Convention> {
    let known = recognised.unwrap_or(UNKNOWN);
    macro_rules! take {
        ($field:ident, $of:expr, $auto:path) => {
            if params.$field == $auto {
                params.$field = $of;
            }
        };
    }
    take!(layout, known.layout, OutputLayout::Auto);
    // What was recognised together with another layout does not apply to this one.
    let known =
        if params.layout == known.layout { known } else { Convention { layout: params.layout, ..UNKNOWN } };
    take!(boxes, known.boxes, BoxFormat::Auto);
    take!(unit, known.unit, BoxUnit::Auto);
    take!(scores, known.scores, ScoreFormat::Auto);
    take!(objectness, known.objectness, Objectness::Auto);
    take!(row_order, known.row_order, RowOrder::Auto);
    take!(angle, known.angle, BoxAngle::Auto);
    take!(masks, known.masks, MaskOutput::Auto);
    let input = params.input.settle(known.input);
    let first_class = *params.first_class.get_or_insert(known.first_class);
    let convention = Convention {
        layout: params.layout,
        boxes: params.boxes,
        unit: params.unit,
        scores: params.scores,
        objectness: params.objectness,
        row_order: params.row_order,
        angle: params.angle,
        masks: params.masks,
        input,
        first_class,
    };
    if convention.masks == MaskOutput::Prototypes && facts.prototypes().is_none() {
        return Err(Error::unsupported(format!(
            "the network has no output of four dimensions, which the prototypes of masks are; set masks to absent ({})",
            facts.describe()
        )));
    }
    if convention.angle == BoxAngle::Last && convention.masks == MaskOutput::Prototypes {
        return Err(Error::unsupported(
            "a network with rotated boxes and masks is not supported; set masks to absent",
        ));
    }
    match missing(&convention)[..] {
        [] => Ok(convention),
        ref missing => Err(facts.unsettled(missing)),
    }
}

/// Returns the names of the parameters that are still to be set.
fn missing(convention: &Convention) -> Vec<&'static str> {
    use OutputLayout::{Auto, Candidates, Detections};
    let layout = convention.layout;
    let is_grid = layout == OutputLayout::GridCandidates;
    let all = [
        ("layout", layout == Auto),
        ("boxes", !is_grid && convention.boxes == BoxFormat::Auto),
        ("unit", !is_grid && convention.unit == BoxUnit::Auto),
        ("scores", !is_grid && layout != Detections && convention.scores == ScoreFormat::Auto),
        ("objectness", layout == Candidates && convention.objectness == Objectness::Auto),
    ];
    let of_outputs = all.into_iter().filter(|(_, is_missing)| *is_missing).map(|(name, _)| name);
    of_outputs.chain(convention.input.missing()).collect()
}
