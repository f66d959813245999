//! Writer of time series as a `.ts` file.

use std::fmt::Write as _;
use std::path::Path;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Error, Progress, Result, Value};

use crate::folder::{name_of, path_inside, write_file};
use crate::picture_files::write_each;
use crate::{Problems, WriteOptions};

/// Writes `NAME_TRAIN.ts`, with the name of the folder; NaN becomes `?`.
pub(super) fn write(
    dataset: &dyn DatasetIterator,
    path: &Path,
    options: &WriteOptions,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<()> {
    let name = word(&name_of(path));
    let part = options.split.as_deref().unwrap_or("train").to_uppercase();
    let file = path_inside(path, &format!("{name}_{part}.ts")).map_err(Error::invalid_param)?;
    let mut classes: Vec<String> = dataset.classes().iter().map(word).collect();
    let named = classes.len();
    let (mut text, mut shapes, mut missing) = (String::new(), Vec::new(), false);
    write_each(dataset, problems, progress, |index| {
        let (line, label, shape) = series_line(dataset, index, shapes.first())?;
        text += &line;
        missing |= line.contains('?');
        if !classes.contains(&label) {
            classes.push(label);
        }
        shapes.push(shape);
        Ok(())
    })?;
    // Numbers are sorted by value; the classes of the data set keep their indices.
    classes
        .get_mut(named..)
        .into_iter()
        .for_each(|new| new.sort_by_key(|label| label.parse::<i64>().unwrap_or(i64::MAX)));
    let [length, features] = shapes.first().copied().unwrap_or([1, 1]);
    let equal = shapes.iter().all(|shape| shape[0] == length);
    let mut head = format!(
        "@problemName {name}\n@timeStamps false\n@missing {missing}\n@univariate {}\n",
        features == 1
    );
    if features != 1 {
        // Writing to a String cannot fail.
        writeln!(head, "@dimensions {features}").ok();
    }
    write!(
        head,
        "@equalLength {equal}\n{}",
        if equal { format!("@seriesLength {length}\n") } else { String::new() }
    )
    .ok();
    write!(head, "@classLabel true {}\n@data\n", classes.join(" ")).ok();
    write_file(&file, (head + &text).as_bytes())
}

/// Returns one word, as required for labels of `.ts` files.
fn word(text: &str) -> String {
    let word: String =
        text.chars().map(|c| if c.is_whitespace() || matches!(c, ':' | ',') { '_' } else { c }).collect();
    if word.is_empty() { "_".to_owned() } else { word }
}

fn series_line(
    dataset: &dyn DatasetIterator,
    index: usize,
    first: Option<&[usize; 2]>,
) -> Result<(String, String, [usize; 2])> {
    let sample = dataset.get(index)?;
    let (Some(Value::Timeseries(series)), Some(Value::Category(category))) =
        (sample.data.first(), &sample.target)
    else {
        return Err(Error::invalid_input("the sample needs a Timeseries and a Category"));
    };
    let shape = series.shape();
    let features = first.map_or(shape[1], |first| first[1]);
    if shape[1] != features {
        return Err(Error::invalid_input(format!(
            "the series has {} features instead of {features}",
            shape[1]
        )));
    }
    let label = category.description.as_deref().map_or_else(|| category.class.to_string(), word);
    let value = |number: &f32| if number.is_finite() { number.to_string() } else { "?".to_owned() };
    let feature = |at: usize| {
        series.as_slice().iter().skip(at).step_by(features).map(value).collect::<Vec<_>>().join(",")
    };
    let columns: Vec<_> = (0..features).map(feature).collect();
    Ok((format!("{}:{label}\n", columns.join(":")), label, shape))
}
