//! The known persons of a face recogniser.

use opendr_engine::model::Model;
use opendr_engine::target::Classes;
use opendr_engine::{Error, JsonFormat, Result, ResultExt as _};
use opendr_perception_common::embedding_network::normalise;
use serde::{Deserialize, Serialize};

/// File name of the number of images per class.
const HEADER: &str = "gallery.json";
/// Format of that file. Version 2 renamed `pictures` to `images`.
const FORMAT: JsonFormat = JsonFormat::new("gallery of persons", 2);
/// File name of their embeddings, one after the other: 32-bit floats, little-endian.
const EMBEDDINGS: &str = "gallery.f32";

#[derive(Serialize, Deserialize)]
struct Header {
    dimension: usize,
    #[serde(alias = "pictures")]
    images: Vec<usize>,
}

/// Persons with the embeddings of their images.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Gallery {
    dimension: usize,
    persons: Vec<Person>,
}

#[derive(Debug, Clone, Default, PartialEq)]
struct Person {
    name: String,
    /// Embeddings of length 1, one after the other.
    embeddings: Vec<f32>,
}

impl Gallery {
    /// Creates an empty gallery.
    pub fn new(dimension: usize) -> Self {
        Self { dimension, persons: Vec::new() }
    }

    /// Reads the gallery of a container; it is empty when the container has none.
    ///
    /// # Errors
    /// `Format` when its files are inconsistent, or have embeddings of another network.
    pub fn of_model(model: &Model, dimension: usize) -> Result<Self> {
        if !model.manifest().files.iter().any(|file| file.name == HEADER) {
            return Ok(Self::new(dimension));
        }
        Self::from_bytes(&model.file(HEADER)?, &model.file(EMBEDDINGS)?, model.classes(), dimension)
    }

    fn from_bytes(header: &[u8], embeddings: &[u8], names: &Classes, dimension: usize) -> Result<Self> {
        let header: Header = FORMAT.read(header).context(|| HEADER.to_owned())?;
        if header.dimension != dimension {
            return Err(Error::format(format!(
                "the gallery has embeddings of length {}, the network has {dimension}; store the references again with fit",
                header.dimension
            )));
        }
        let sum = header.images.iter().try_fold(0usize, |sum, count| sum.checked_add(*count));
        let bytes = sum.and_then(|sum| sum.checked_mul(4 * dimension));
        if bytes != Some(embeddings.len()) || header.images.len() != names.len() {
            return Err(Error::format(format!(
                "the gallery has {} bytes of embeddings and {} names for {:?} images of {} persons; store the references again with fit",
                embeddings.len(),
                names.len(),
                sum,
                header.images.len()
            )));
        }
        let mut numbers = embeddings.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes));
        let persons = names.iter().zip(&header.images).map(|(name, count)| {
            let mut embeddings: Vec<f32> = numbers.by_ref().take(count * dimension).collect();
            let sound = embeddings.chunks_exact_mut(dimension.max(1)).all(normalise);
            let error =
                || Error::format(format!("an embedding of {name:.80?} in the gallery is zero or not finite"));
            sound.then(|| Person { name: name.to_owned(), embeddings }).ok_or_else(error)
        });
        Ok(Self { dimension, persons: persons.collect::<Result<_>>()? })
    }

    /// Returns the names by class index.
    pub fn names(&self) -> Classes {
        self.persons.iter().map(|person| person.name.as_str()).collect()
    }

    /// Returns the class index of the person with the embedding closest to `embedding`, and their cosine; -1 without
    /// persons.
    pub fn nearest(&self, embedding: &[f32]) -> (usize, f32) {
        let mut nearest = (0, -1.0);
        for (at, person) in self.persons.iter().enumerate() {
            for other in person.embeddings.chunks_exact(self.dimension.max(1)) {
                let cosine = other.iter().zip(embedding).map(|(a, b)| a * b).sum::<f32>();
                if cosine > nearest.1 {
                    nearest = (at, cosine);
                }
            }
        }
        nearest
    }
}

/// Functions for storing references.
#[cfg(any(feature = "training", test))]
impl Gallery {
    /// Returns the files of the container, whose classes are the persons.
    pub fn to_files(&self) -> Result<[(&'static str, Vec<u8>); 2]> {
        let images = self.persons.iter().map(|person| person.embeddings.len() / self.dimension.max(1));
        let header = Header { dimension: self.dimension, images: images.collect() };
        let header = FORMAT.to_json(&header)?.into_bytes();
        let numbers = self.persons.iter().flat_map(|person| &person.embeddings);
        Ok([(HEADER, header), (EMBEDDINGS, numbers.flat_map(|number| number.to_le_bytes()).collect())])
    }

    /// Returns whether a file of a container belongs to its gallery.
    #[cfg(feature = "training")]
    pub fn is_file(name: &str) -> bool {
        name == HEADER || name == EMBEDDINGS
    }

    /// Returns the length of an embedding.
    #[cfg(feature = "training")]
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Adds an embedding of length 1 to a person.
    pub fn add(&mut self, name: &str, embedding: &[f32]) {
        let at = self.persons.iter().position(|person| person.name == name).unwrap_or_else(|| {
            self.persons.push(Person { name: name.to_owned(), embeddings: Vec::new() });
            self.persons.len() - 1
        });
        self.persons[at].embeddings.extend_from_slice(embedding);
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;

    use super::*;

    fn gallery() -> Gallery {
        let mut gallery = Gallery::new(2);
        gallery.add("ann", &[1.0, 0.0]);
        gallery.add("bob", &[0.0, 1.0]);
        gallery.add("ann", &[0.6, 0.8]);
        gallery
    }

    #[test]
    fn the_closest_of_all_embeddings_counts() {
        let (person, cosine) = gallery().nearest(&[0.8, 0.6]);
        assert_eq!(person, 0);
        assert!((cosine - 0.96).abs() < 1e-6);
        assert_eq!(gallery().nearest(&[0.0, 1.0]), (1, 1.0));
        assert_eq!(Gallery::new(2).nearest(&[0.0, 1.0]), (0, -1.0));
        assert_eq!(gallery().nearest(&[f32::NAN, 1.0]).1, -1.0);
    }

    #[test]
    fn a_gallery_survives_its_files() {
        let [(_, header), (_, embeddings)] = gallery().to_files().unwrap();
        let read = |header: &[u8], embeddings: &[u8], names: &[&str], dimension| {
            Gallery::from_bytes(header, embeddings, &names.iter().copied().collect(), dimension)
        };
        assert_eq!(read(&header, &embeddings, &["ann", "bob"], 2).unwrap(), gallery());
        let former = br#"{"dimension": 2, "pictures": [2, 1]}"#;
        assert_eq!(read(former, &embeddings, &["ann", "bob"], 2).unwrap(), gallery());
        let newer = br#"{"format_version": 3, "dimension": 2}"#;
        let error = read(newer, &embeddings, &["ann", "bob"], 2).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Unsupported, "{error}");
        let huge = br#"{"dimension": 2, "pictures": [18446744073709551615, 18446744073709551615]}"#;
        for (header, embeddings, names, dimension) in [
            (&header[..], &embeddings[..], &["ann"][..], 2),
            (&header, &embeddings[4..], &["ann", "bob"], 2),
            (&header, &embeddings, &["ann", "bob"], 3),
            (&header, &[255; 24], &["ann", "bob"], 2),
            (huge, &embeddings, &["ann", "bob"], 2),
            (b"{}", &embeddings, &["ann", "bob"], 2),
        ] {
            let error = read(header, embeddings, names, dimension).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Format, "{error}");
        }
    }
}
