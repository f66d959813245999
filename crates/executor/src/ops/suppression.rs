//! Selection of boxes that do not overlap better ones.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use crate::attributes::Attributes;
use crate::constant::Constant;

pub(crate) fn non_max_suppression(node: &NodeProto, inputs: &[Option<&Constant>]) -> Result<Vec<Constant>> {
    let input = |slot: usize| inputs.get(slot).copied().flatten();
    let floats = |slot: usize| input(slot).and_then(Constant::floats);
    let (Some(boxes), Some(scores)) = (input(0), input(1)) else {
        return Err(node.damaged("it needs boxes and scores"));
    };
    let (&[batch, count, 4], &[score_batch, classes, score_count]) =
        (boxes.shape.as_slice(), scores.shape.as_slice())
    else {
        return Err(node.damaged(&format!("boxes {:?} and scores {:?}", boxes.shape, scores.shape)));
    };
    if [batch, count] != [score_batch, score_count] {
        return Err(node.damaged(&format!("boxes {:?} and scores {:?}", boxes.shape, scores.shape)));
    }
    let (Some(boxes), Some(scores)) = (floats(0), floats(1)) else {
        return Err(node.refused("boxes or scores that are not floats"));
    };
    let most = input(2).and_then(Constant::ints).and_then(|most| most.first().copied()).unwrap_or(0);
    let most = usize::try_from(most).unwrap_or(0);
    let number = |slot: usize| floats(slot).and_then(|values| values.first().copied());
    let (max_iou, min_score) = (number(3).unwrap_or(0.0), number(4));
    let is_centered = node.int_or("center_point_box", 0) != 0;
    let corners: Vec<Corners> =
        boxes.as_chunks().0.iter().map(|own| Corners::new(*own, is_centered)).collect();
    let mut selected: Vec<i64> = Vec::new();
    if count == 0 || most == 0 {
        return Ok(vec![Constant::from_ints(vec![0, 3], &[])]);
    }
    let mut order: Vec<usize> = Vec::new();
    for (row, scores) in scores.chunks(count).enumerate() {
        let (image, class) = (row / classes, row % classes);
        let corners = &corners[image * count..][..count];
        order.clear();
        order.extend((0..count).filter(|&at| min_score.is_none_or(|least| scores[at] > least)));
        order.sort_by(|&a, &b| scores[b].total_cmp(&scores[a]));
        let mut kept: Vec<usize> = Vec::new();
        for &at in &order {
            if kept.len() >= most {
                break;
            }
            if kept.iter().all(|&other| corners[at].iou(&corners[other]) <= max_iou) {
                kept.push(at);
            }
        }
        selected.extend(kept.iter().flat_map(|&at| [image as i64, class as i64, at as i64]));
    }
    Ok(vec![Constant::from_ints(vec![selected.len() / 3, 3], &selected)])
}

/// A box by its lower and upper corner.
struct Corners {
    low: [f32; 2],
    high: [f32; 2],
}

impl Corners {
    /// Reads a box: two opposite corners, y before x, or with `is_centered` its centre and size, x before y.
    fn new([a, b, c, d]: [f32; 4], is_centered: bool) -> Self {
        let (first, second) = if is_centered {
            ([b - d / 2.0, a - c / 2.0], [b + d / 2.0, a + c / 2.0])
        } else {
            ([a, b], [c, d])
        };
        let [low, high] = [f32::min, f32::max]
            .map(|pick: fn(f32, f32) -> f32| [pick(first[0], second[0]), pick(first[1], second[1])]);
        Self { low, high }
    }

    fn area(&self) -> f32 {
        (self.high[0] - self.low[0]) * (self.high[1] - self.low[1])
    }

    /// Returns the intersection over union of two boxes; 0 where one of them is empty.
    fn iou(&self, other: &Self) -> f32 {
        let side = |d: usize| (self.high[d].min(other.high[d]) - self.low[d].max(other.low[d])).max(0.0);
        let shared = side(0) * side(1);
        let (own, others) = (self.area(), other.area());
        if own <= 0.0 || others <= 0.0 || shared <= 0.0 { 0.0 } else { shared / (own + others - shared) }
    }
}
