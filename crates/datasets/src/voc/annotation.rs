//! Annotation files of Pascal VOC.

use std::path::Path;

use opendr_engine::target::{BoundingBox, Segment};
use roxmltree::{Document, Node, ParsingOptions};

use crate::Problem;
use crate::picture_box::leaves_picture;

/// Largest number of XML nodes of a file.
const MAX_NODES: u32 = 1 << 20;

/// Content of an annotation file.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Annotation {
    /// File name of the image, if stated.
    pub filename: Option<String>,
    /// Width and height in pixels, 0 if not stated.
    pub size: [u32; 2],
    /// Objects with class labels; a difficult object is a crowd without mask.
    pub objects: Vec<BoundingBox>,
}

impl Annotation {
    /// Parses `text`, the content of `file`.
    pub fn new(file: &Path, text: &str) -> Result<Self, Problem> {
        let options =
            ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options).map_err(|error| {
            Problem::at_line(file, u64::from(error.pos().row), format!("not the XML of VOC: {error}"))
        })?;
        let reader = Reader { file, document: &document };
        reader.annotation(document.root_element())
    }
}

struct Reader<'a> {
    file: &'a Path,
    document: &'a Document<'a>,
}

impl<'a> Reader<'a> {
    fn annotation(&self, root: Node<'a, 'a>) -> Result<Annotation, Problem> {
        if !root.has_tag_name("annotation") {
            let found = root.tag_name().name();
            return Err(self.wrong(root, format!("found <{found:.40}> instead of <annotation>")));
        }
        let size = match child(root, "size") {
            Some(size) => [self.side(size, "width")?, self.side(size, "height")?],
            None => [0, 0],
        };
        let objects = root.children().filter(|node| node.has_tag_name("object"));
        let objects = objects.map(|object| self.object(object, size)).collect::<Result<_, _>>()?;
        let filename =
            child(root, "filename").and_then(|node| node.text()).map(|name| name.trim().to_owned());
        Ok(Annotation { filename, size, objects })
    }

    fn object(&self, object: Node<'a, 'a>, size: [u32; 2]) -> Result<BoundingBox, Problem> {
        let name = self.text(object, "name")?;
        if name.is_empty() {
            return Err(self.wrong(object, "an object has no name".to_owned()));
        }
        let bounds = self.child(object, "bndbox")?;
        let corner = |tag| self.number(bounds, tag);
        let [x0, y0, x1, y1] = [corner("xmin")?, corner("ymin")?, corner("xmax")?, corner("ymax")?];
        // Corners are pixel indices from 1, and both are inside the box.
        let found = BoundingBox::from_corners(name, [x0 - 1.0, y0 - 1.0, x1, y1], 1.0);
        if found.width < 0.0 || found.height < 0.0 {
            return Err(
                self.wrong(bounds, format!("a box from {x0},{y0} to {x1},{y1}; the minimum comes first"))
            );
        }
        if leaves_picture([found.left, found.top, found.width, found.height], size) {
            let [width, height] = size;
            return Err(self.wrong(
                bounds,
                format!("a box from {x0},{y0} to {x1},{y1}, outside of its image of {width}x{height} pixels"),
            ));
        }
        let difficult =
            child(object, "difficult").and_then(|node| node.text()).is_some_and(|text| text.trim() == "1");
        let crowd = || Box::new(Segment { area: found.area(), iscrowd: true, ..Segment::default() });
        Ok(BoundingBox { segment: difficult.then(crowd), ..found })
    }

    fn child(&self, node: Node<'a, 'a>, tag: &str) -> Result<Node<'a, 'a>, Problem> {
        child(node, tag).ok_or_else(|| {
            let parent = node.tag_name().name();
            self.wrong(node, format!("<{parent}> has no <{tag}>"))
        })
    }

    fn text(&self, node: Node<'a, 'a>, tag: &str) -> Result<&'a str, Problem> {
        Ok(self.child(node, tag)?.text().unwrap_or_default().trim())
    }

    fn number(&self, node: Node<'a, 'a>, tag: &str) -> Result<f32, Problem> {
        let text = self.text(node, tag)?;
        let number = text.parse().ok().filter(|number: &f32| number.is_finite());
        number.ok_or_else(|| self.wrong(node, format!("<{tag}> is {text:.40?}, not a finite number")))
    }

    fn side(&self, node: Node<'a, 'a>, tag: &str) -> Result<u32, Problem> {
        let text = self.text(node, tag)?;
        text.parse().map_err(|_| self.wrong(node, format!("<{tag}> is {text:.40?}, not a number of pixels")))
    }

    fn wrong(&self, node: Node<'a, 'a>, message: String) -> Problem {
        let line = self.document.text_pos_at(node.range().start).row;
        Problem::at_line(self.file, line.into(), message)
    }
}

fn child<'a>(node: Node<'a, 'a>, tag: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|child| child.has_tag_name(tag))
}
