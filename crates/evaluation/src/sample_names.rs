//! Matching of samples by name.

use std::collections::HashMap;

use opendr_engine::dataset::DatasetIterator;

/// The samples of a data set by their names, as far as these are unique.
pub struct SampleNames {
    by_name: HashMap<String, Option<usize>>,
}

impl SampleNames {
    /// Indexes a data set: each sample by its name, by suffixes of it, and by its file name without extension.
    pub fn of(dataset: &dyn DatasetIterator) -> Self {
        let mut by_name = HashMap::new();
        let mut add = |name: &str, at: usize| {
            by_name
                .entry(name.to_owned())
                .and_modify(|known| {
                    if *known != Some(at) {
                        *known = None;
                    }
                })
                .or_insert(Some(at));
        };
        for at in 0..dataset.len() {
            let name = dataset.name(at).replace('\\', "/");
            for ending in endings(&name) {
                add(ending, at);
            }
            add(stem(&name), at);
        }
        Self { by_name }
    }

    /// Returns the sample of a path: that of its longest suffix that is unique to a sample.
    pub fn find(&self, path: &str) -> Option<usize> {
        let path = path.replace('\\', "/");
        let known = |name: &str| self.by_name.get(name).copied().flatten();
        endings(&path).find_map(known).or_else(|| known(stem(&path)))
    }
}

/// Returns a path, and what follows each of its slashes.
fn endings(path: &str) -> impl Iterator<Item = &str> {
    std::iter::once(path)
        .chain(path.match_indices('/').map(|(at, _)| &path[at + 1..]))
        .filter(|end| !end.is_empty())
}

/// Returns the file name without its extension.
fn stem(path: &str) -> &str {
    let file = path.rsplit('/').next().unwrap_or(path);
    file.rsplit_once('.').map_or(file, |(stem, _)| if stem.is_empty() { file } else { stem })
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::Result;
    use opendr_engine::dataset::{Dataset, Sample};

    struct Named(&'static [&'static str]);

    impl Dataset for Named {}

    impl DatasetIterator for Named {
        fn len(&self) -> usize {
            self.0.len()
        }

        fn get(&self, _index: usize) -> Result<Sample> {
            Ok(Sample { data: Vec::new(), target: None })
        }

        fn name(&self, index: usize) -> String {
            self.0[index].to_owned()
        }
    }

    #[test]
    fn samples_are_matched_by_unique_suffixes() {
        let names = SampleNames::of(&Named(&["train/1.jpg", "val/1.jpg", "val/2.jpg", ".hidden"]));
        let find = |path: &str| names.find(path);
        assert_eq!([find("/data/val/1.jpg"), find("train/1.jpg"), find("1.jpg")], [Some(1), Some(0), None]);
        assert_eq!([find("2.png"), find("answers/2.txt"), find("2")], [Some(2), Some(2), Some(2)]);
        assert_eq!([find(""), find("3.jpg"), find(".hidden")], [None, None, Some(3)]);
    }
}
