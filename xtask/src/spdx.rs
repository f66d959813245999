//! SPDX licence expressions, as the manifests of crates have them.

use crate::shell::Result;

/// A licence expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A licence, with its exception where it has one: `Apache-2.0 WITH LLVM-exception`.
    Licence(String),
    /// All of them apply.
    All(Vec<Expression>),
    /// The user chooses one of them.
    Any(Vec<Expression>),
}

impl Expression {
    /// Parses an expression. A slash is the older form of `OR`.
    pub fn parse(text: &str) -> Result<Self> {
        let spaced = text.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
        let mut words: Vec<&str> = spaced.split_whitespace().rev().collect();
        let expression = any(&mut words).map_err(|error| format!("licence {text:?}: {error}"))?;
        if words.is_empty() {
            Ok(expression)
        } else {
            Err(format!("licence {text:?}: unexpected {:?}", words.last()))
        }
    }

    /// Returns the licences to comply with: of alternatives, the one whose licences are first in `preferred`. `None` if no alternative
    /// consists of preferred licences.
    pub fn choose(&self, preferred: &[String]) -> Option<Vec<String>> {
        self.ranked(preferred).map(|(_, chosen)| chosen)
    }

    /// Returns the choice with the rank of its least preferred licence.
    fn ranked(&self, preferred: &[String]) -> Option<(usize, Vec<String>)> {
        match self {
            Self::Licence(name) => {
                let rank = preferred.iter().position(|licence| licence == name)?;
                Some((rank, vec![name.clone()]))
            }
            Self::Any(alternatives) => {
                alternatives.iter().filter_map(|one| one.ranked(preferred)).min_by_key(|(rank, _)| *rank)
            }
            Self::All(parts) => {
                let (mut rank, mut chosen) = (0, Vec::new());
                for part in parts {
                    let (part_rank, licences) = part.ranked(preferred)?;
                    rank = rank.max(part_rank);
                    chosen.extend(licences);
                }
                Some((rank, chosen))
            }
        }
    }
}

fn any(words: &mut Vec<&str>) -> Result<Expression> {
    let mut parts = vec![all(words)?];
    while words.last() == Some(&"OR") {
        words.pop();
        parts.push(all(words)?);
    }
    Ok(if parts.len() == 1 { parts.remove(0) } else { Expression::Any(parts) })
}

fn all(words: &mut Vec<&str>) -> Result<Expression> {
    let mut parts = vec![one(words)?];
    while words.last() == Some(&"AND") {
        words.pop();
        parts.push(one(words)?);
    }
    Ok(if parts.len() == 1 { parts.remove(0) } else { Expression::All(parts) })
}

fn one(words: &mut Vec<&str>) -> Result<Expression> {
    match words.pop() {
        Some("(") => {
            let inner = any(words)?;
            if words.pop() == Some(")") {
                Ok(inner)
            } else {
                Err("a closing parenthesis is missing".to_owned())
            }
        }
        Some(word @ ("AND" | "OR" | "WITH" | ")")) => Err(format!("unexpected {word:?}")),
        Some(licence) if words.last() == Some(&"WITH") => {
            words.pop();
            let exception = words.pop().ok_or("the exception after WITH is missing")?;
            Ok(Expression::Licence(format!("{licence} WITH {exception}")))
        }
        Some(licence) => Ok(Expression::Licence(licence.to_owned())),
        None => Err("a licence is missing".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn choice(text: &str, preferred: &[&str]) -> Option<Vec<String>> {
        let preferred: Vec<_> = preferred.iter().map(|&licence| licence.to_owned()).collect();
        Expression::parse(text).unwrap().choose(&preferred)
    }

    #[test]
    fn chooses_the_preferred_alternative() {
        let preferred = ["Apache-2.0", "MIT", "IJG"];
        assert_eq!(choice("MIT/Apache-2.0", &preferred).unwrap(), ["Apache-2.0"]);
        assert_eq!(choice("(MIT OR Apache-2.0) AND IJG", &preferred).unwrap(), ["Apache-2.0", "IJG"]);
        assert_eq!(choice("Apache-2.0 WITH LLVM-exception OR MIT", &preferred).unwrap(), ["MIT"]);
        assert_eq!(choice("GPL-3.0-only AND MIT", &preferred), None);
    }

    #[test]
    fn refuses_what_is_no_expression() {
        for text in ["", "MIT OR", "(MIT", "MIT)", "MIT Apache-2.0", "AND MIT", "MIT WITH"] {
            assert!(Expression::parse(text).is_err(), "{text:?}");
        }
    }
}
