//! Connected-component labelling.
//!
//! A. Rosenfeld, J. L. Pfaltz, "Sequential operations in digital picture processing", J. ACM 1966: two passes, with
//! R. Tarjan's union-find.

/// Connectivity of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Connectivity {
    /// 4-connectivity: left, right, above and below.
    Four,
    /// 8-connectivity: the diagonal neighbours too.
    Eight,
}

/// Labels of the connected components of an image; its memory is reused.
#[derive(Debug, Clone, Default)]
pub struct Components {
    labels: Vec<u32>,
    /// Union-find parents while labelling. Smaller labels are the roots.
    leaders: Vec<u32>,
    areas: Vec<u32>,
}

impl Components {
    /// Labels the components of an image of `width` x `height` pixels, from 1 on, in the order of their first pixels,
    /// row by row. `belongs` returns whether a pixel, by its index `y * width + x`, is foreground; `joined` returns
    /// whether two neighbouring foreground pixels are in one component. Returns the number of components.
    pub fn label(
        &mut self,
        [width, height]: [usize; 2],
        touching: Connectivity,
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
                if touching == Connectivity::Eight && y > 0 {
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
        // Roots have smaller labels, so they are final before their members.
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

    /// Returns the label of each pixel, row by row; 0 is background.
    pub fn labels(&self) -> &[u32] {
        &self.labels
    }

    /// Returns the number of pixels of each component by its label; the first entry counts the background.
    pub fn areas(&self) -> &[u32] {
        &self.areas
    }
}

/// Returns the root of a label, with path compression.
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

    fn labels(picture: &[&str], touching: Connectivity) -> (Vec<u32>, Vec<u32>) {
        let size = [picture[0].len(), picture.len()];
        let pixels: Vec<u8> = picture.concat().into_bytes();
        let mut components = Components::default();
        components.label(size, touching, |at| pixels[at] != b'.', |a, b| pixels[a] == pixels[b]);
        (components.labels().to_vec(), components.areas().to_vec())
    }

    #[test]
    fn u_shape_is_one_component_and_diagonals_connect_on_request() {
        let picture = ["#.#.", "#.#a", "###a", "...."];
        let (sides, areas) = labels(&picture, Connectivity::Four);
        assert_eq!(sides, [1, 0, 1, 0, 1, 0, 1, 2, 1, 1, 1, 2, 0, 0, 0, 0]);
        assert_eq!(areas, [7, 7, 2]);
        let picture = ["#.", ".#"];
        assert_eq!(labels(&picture, Connectivity::Four).0, [1, 0, 0, 2]);
        assert_eq!(labels(&picture, Connectivity::Eight).0, [1, 0, 0, 1]);
    }

    #[test]
    fn nothing_has_no_components() {
        let mut components = Components::default();
        assert_eq!(components.label([0, 7], Connectivity::Four, |_| true, |_, _| true), 0);
        assert_eq!(components.label([3, 1], Connectivity::Four, |_| false, |_, _| true), 0);
        assert_eq!(components.areas(), [3]);
    }

    proptest! {
        #[test]
        fn agrees_with_flood_fill(width in 1usize..12, pixels in prop::collection::vec(0u8..3, 0..140), corners: bool) {
            let height = pixels.len() / width;
            let touching = if corners { Connectivity::Eight } else { Connectivity::Four };
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
