//! Search space from text.

use opendr_engine::params::{Field, ParamKind, ParamValue};
use opendr_engine::{Error, Result};
use opendr_tuning::{Distribution, SearchSpace};
use serde_json::Value;

/// Parses parameters given as `NAME` (the range of the learner), `NAME=LOW..HIGH` (logarithmic if the learner's range is), or
/// `NAME=A,B,C`.
///
/// # Errors
/// `InvalidParam` for an unknown parameter, one without a range, or wrong values.
pub fn search_space(fields: &[Field], texts: &[String]) -> Result<SearchSpace> {
    if texts.is_empty() {
        let names: Vec<_> = fields.iter().map(|field| field.name).collect();
        return Err(Error::invalid_param(format!("nothing to search; name some of {}", names.join(", "))));
    }
    texts.iter().try_fold(SearchSpace::new(), |space, text| {
        let (name, values) = text.split_once('=').unwrap_or((text, ""));
        let field = fields.iter().find(|field| field.is_called(name)).ok_or_else(|| {
            let names: Vec<_> = fields.iter().map(|field| field.name).collect();
            Error::invalid_param(format!("no parameter {name:?} to search; there are {}", names.join(", ")))
        })?;
        let name = field.name;
        if values.is_empty() {
            let own = SearchSpace::from_fields(fields, &[name])?;
            return own
                .parameters()
                .iter()
                .try_fold(space, |space, own| space.with(name, own.distribution.clone()));
        }
        let distribution = match values.split_once("..") {
            Some((low, high)) => range(field, low, high)?,
            None => choices(field, values)?,
        };
        space.with(name, distribution)
    })
}

fn range(field: &Field, low: &str, high: &str) -> Result<Distribution> {
    let [low, high] = [field.parse(low)?, field.parse(high)?];
    for bound in [&low, &high] {
        field.check(bound)?;
    }
    match (field.kind, low.as_float().zip(high.as_float())) {
        (ParamKind::Int, Some((low, high))) if field.log_scale => {
            Distribution::log_int(low as i64, high as i64)
        }
        (ParamKind::Int, Some((low, high))) => Distribution::int(low as i64, high as i64),
        (ParamKind::Float, Some((low, high))) if field.log_scale => Distribution::log_float(low, high),
        (ParamKind::Float, Some((low, high))) => Distribution::float(low, high),
        _ => Err(Error::invalid_param(format!("{} has no range; name its values: {0}=A,B", field.name))),
    }
    .map_err(|error| error.context(field.name))
}

fn choices(field: &Field, values: &str) -> Result<Distribution> {
    let choices = values.split(',').map(|text| {
        let value = field.parse(text)?;
        field.check(&value)?;
        Ok(match value {
            ParamValue::Bool(value) => Value::from(value),
            ParamValue::Int(value) => Value::from(value),
            ParamValue::Float(value) => Value::from(value),
            ParamValue::Text(value) => Value::from(value),
            ParamValue::None => Value::Null,
            ParamValue::List(_) => {
                return Err(Error::invalid_param(format!("{} is a list; it cannot be searched", field.name)));
            }
        })
    });
    Distribution::categorical(choices.collect::<Result<Vec<Value>>>()?)
}

#[cfg(test)]
mod tests {
    use opendr_engine::params::Params as _;
    use opendr_rl::PpoFitParams;

    use super::*;

    fn space(texts: &[&str]) -> Result<SearchSpace> {
        let texts: Vec<_> = texts.iter().map(|text| (*text).to_owned()).collect();
        search_space(PpoFitParams::FIELDS, &texts)
    }

    #[test]
    fn ranges_and_choices_are_read() {
        let space = space(&["gamma", "learning_rate=1e-5..1e-2", "n_steps=32,64", "activation_fn=relu,tanh"])
            .unwrap();
        let found: Vec<_> =
            space.parameters().iter().map(|parameter| parameter.distribution.clone()).collect();
        assert_eq!(found[0], Distribution::float(0.0, 1.0).unwrap());
        assert_eq!(found[1], Distribution::log_float(1e-5, 1e-2).unwrap());
        assert_eq!(found[2], Distribution::categorical([32, 64]).unwrap());
        assert_eq!(found[3], Distribution::categorical(["relu", "tanh"]).unwrap());
    }

    #[test]
    fn invalid_search_spaces_are_refused() {
        for (texts, word) in [
            (&[][..], "nothing to search"),
            (&["colour"], "learning_rate"),
            (&["gamma=0.5..2.0"], "gamma"),
            (&["n_steps=many"], "n_steps"),
            (&["activation_fn=relu..tanh"], "activation_fn"),
        ] {
            let error = space(texts).unwrap_err().to_string();
            assert!(error.contains(word), "{texts:?}: {error}");
        }
    }
}
