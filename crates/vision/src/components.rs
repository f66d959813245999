//! Connected components: pixels that touch and belong together get one number.
//!
//! A. Rosenfeld, J. L. Pfaltz, "Sequential operations in digital picture processing", J. ACM 1966, in two passes with
//! R. Tarjan's union of sets.

/// Which pixels touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touching {
    /// The four beside, above and below.
    Sides,
    /// Those at the corners too.
    Corners,
}

/// Numbers of the components of a picture; memory is used again.
#[derive(Debug, Clone, Default)]
pub struct Components {
    labels: Vec<u32>,
    /// While labelling: who a number is united with. Smaller numbers lead.
    leaders: Vec<u32>,
    areas: Vec<u32>,
}

impl Components {
    /// Numbers the components of a picture of `width` x `height` pixels, from 1 on, in the order of their first pixels,
    /// row by row. `belongs` tells of a pixel's index (`y * width + x`) whether it belongs to any component, `joined` of
    /// two pixels that touch and belong whether they are in one. Returns how many there are.
    pub fn label(
        &mut self,
        [width, height]: [usize; 2],
        touching: Touching,
        belongs: impl Fn(usize) -> bool,
        joined: impl Fn(usize, usize) -> bool,
    ) -> usize {
        let Self { labels, leaders, areas } = self;
        labels.clear();
        labels.resize(width * height, 0);
        leaders.clear();
        leaders.push(0);
        for y in 0..height {
            for x in 0..width {
                let at = y * width + x;
                if !belongs(at) {
                    continue;
                }
                let mut label = 0;
                let mut meet = |other: usize| {
                    if labels[other] == 0 || !joined(at, other) {
                        return;
                    }
                    let there = leader(leaders, labels[other]);
                    if label == 0 {
                        label = there;
                    } else if label != there {
                        let (low, high) = (label.min(there), label.max(there));
                        leaders[high as usize] = low;
                        label = low;
                    }
                };
                if x > 0 {
                    meet(at - 1);
                }
                if y > 0 {
                    meet(at - width);
                }
                if touching == Touching::Corners && y > 0 {
                    if x > 0 {
                        meet(at - width - 1);
                    }
                    if x + 1 < width {
                        meet(at - width + 1);
                    }
                }
                if label == 0 {
                    label = leaders.len() as u32;
                    leaders.push(label);
                }
                labels[at] = label;
            }
        }
        // Leaders have smaller numbers, so theirs are settled first.
        areas.clear();
        areas.push(0);
        for label in 1..leaders.len() {
            let above = leaders[label] as usize;
            leaders[label] = if above == label {
                areas.push(0);
                areas.len() as u32 - 1
            } else {
                leaders[above]
            };
        }
        for label in labels.iter_mut() {
            *label = leaders[*label as usize];
            areas[*label as usize] += 1;
        }
        areas.len() - 1
    }

    /// The number of each pixel's component, row by row; 0 where it belongs to none.
    pub fn labels(&self) -> &[u32] {
        &self.labels
    }

    /// Pixels of each component by its number; the first entry counts those of none.
    pub fn areas(&self) -> &[u32] {
        &self.areas
    }
}

/// Who leads, with the way to it made shorter.
fn leader(leaders: &mut [u32], mut label: u32) -> u32 {
    while leaders[label as usize] != label {
        let above = leaders[leaders[label as usize] as usize];
        leaders[label as usize] = above;
        label = above;
    }
    label
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn labels(picture: &[&str], touching: Touching) -> (Vec<u32>, Vec<u32>) {
        let size = [picture[0].len(), picture.len()];
        let pixels: Vec<u8> = picture.concat().into_bytes();
        let mut components = Components::default();
        components.label(size, touching, |at| pixels[at] != b'.', |a, b| pixels[a] == pixels[b]);
        (components.labels().to_vec(), components.areas().to_vec())
    }

    #[test]
    fn a_u_is_one_and_corners_touch_when_told() {
        let picture = ["#.#.", "#.#a", "###a", "...."];
        let (sides, areas) = labels(&picture, Touching::Sides);
        assert_eq!(sides, [1, 0, 1, 0, 1, 0, 1, 2, 1, 1, 1, 2, 0, 0, 0, 0]);
        assert_eq!(areas, [7, 7, 2]);
        let picture = ["#.", ".#"];
        assert_eq!(labels(&picture, Touching::Sides).0, [1, 0, 0, 2]);
        assert_eq!(labels(&picture, Touching::Corners).0, [1, 0, 0, 1]);
    }

    #[test]
    fn nothing_has_no_components() {
        let mut components = Components::default();
        assert_eq!(components.label([0, 7], Touching::Sides, |_| true, |_, _| true), 0);
        assert_eq!(components.label([3, 1], Touching::Sides, |_| false, |_, _| true), 0);
        assert_eq!(components.areas(), [3]);
    }

    proptest! {
        #[test]
        fn as_flooding_says(width in 1usize..12, pixels in prop::collection::vec(0u8..3, 0..140), corners: bool) {
            let height = pixels.len() / width;
            let touching = if corners { Touching::Corners } else { Touching::Sides };
            let mut components = Components::default();
            let same = |a: usize, b: usize| pixels[a] == pixels[b];
            components.label([width, height], touching, |at| pixels[at] > 0, same);
            let mut flooded = vec![0; width * height];
            let mut count = 0;
            for start in 0..width * height {
                if pixels[start] == 0 || flooded[start] > 0 {
                    continue;
                }
                count += 1;
                let mut stack = vec![start];
                while let Some(at) = stack.pop() {
                    if std::mem::replace(&mut flooded[at], count) == count {
                        continue;
                    }
                    for (other, &number) in flooded.iter().enumerate() {
                        let apart = [(at % width).abs_diff(other % width), (at / width).abs_diff(other / width)];
                        let near = if corners { apart[0].max(apart[1]) } else { apart[0] + apart[1] };
                        if near == 1 && same(at, other) && number == 0 {
                            stack.push(other);
                        }
                    }
                }
            }
            prop_assert_eq!(components.labels(), &flooded[..]);
        }
    }
}
