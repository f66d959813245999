//! Test reports in JUnit's XML format, which nextest and pytest write.

use std::path::Path;

use crate::shell::Result;

/// A test in a report.
#[derive(Clone, Debug, PartialEq)]
pub struct Test {
    /// Full name: program or file, then test.
    pub name: String,
    /// Duration in seconds.
    pub seconds: f64,
    /// Outcome of the test.
    pub outcome: Outcome,
}

/// Outcome of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The test passed.
    Passed,
    /// The test failed, or its setup or teardown did.
    Failed,
    /// The test was skipped.
    Skipped,
}

/// Reads a report.
pub fn read(path: &Path) -> Result<Vec<Test>> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    parse(&text).map_err(|error| format!("{}: {error}", path.display()))
}

fn parse(text: &str) -> Result<Vec<Test>> {
    let document = roxmltree::Document::parse(text).map_err(|error| error.to_string())?;
    let tests = document.descendants().filter(|node| node.has_tag_name("testcase"));
    Ok(tests
        .map(|node| {
            let attribute = |name| node.attribute(name).unwrap_or_default();
            let has = |names: &[&str]| node.children().any(|child| names.contains(&child.tag_name().name()));
            let outcome = match () {
                () if has(&["failure", "error"]) => Outcome::Failed,
                () if has(&["skipped"]) => Outcome::Skipped,
                () => Outcome::Passed,
            };
            Test {
                name: format!("{} {}", attribute("classname"), attribute("name")),
                seconds: attribute("time").parse().unwrap_or(0.0),
                outcome,
            }
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outcomes_of_both_runners_are_read() {
        let text = r#"<testsuites><testsuite>
            <testcase classname="opendr-engine" name="json::reads" time="0.25"/>
            <testcase classname="tests.metrics.test_voc" name="test_equal" time="1.5"><failure>no</failure></testcase>
            <testcase classname="a" name="b" time="0"><skipped message="no torch"/></testcase>
            <testcase classname="a" name="c"><error/></testcase>
        </testsuite></testsuites>"#;
        let tests = parse(text).unwrap();
        assert_eq!(tests[0].name, "opendr-engine json::reads");
        assert_eq!(tests[1].seconds, 1.5);
        let outcomes: Vec<_> = tests.iter().map(|test| test.outcome).collect();
        assert_eq!(outcomes, [Outcome::Passed, Outcome::Failed, Outcome::Skipped, Outcome::Failed]);
    }

    #[test]
    fn invalid_reports_are_errors() {
        assert!(parse("<testsuite>").is_err());
    }
}
