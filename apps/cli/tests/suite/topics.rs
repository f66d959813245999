//! The page of topics in the documentation matches the registry.

use std::fmt::Write as _;

use opendr::ros::default_topics;

const HEAD: &str = "\
# Topics of every learner

Made by `cargo xtask generate` from the registry: not edited by hand. What nodes have besides, and how to change any of it,
stands in [ros.md](ros.md). Names are relative to the node's namespace; `~` is the node, which is called as its learner.

| learner | takes | message | answers | message |
|---|---|---|---|---|
";

fn page() -> String {
    let mut page = HEAD.to_owned();
    let entries = opendr::registry().entries();
    // The test learner is part of test builds only.
    for entry in entries.iter().filter(|entry| entry.spec.name != "counter") {
        let topics = default_topics(entry);
        let rows = topics.inputs.len().max(topics.outputs.len());
        assert!(topics.inputs.len() == entry.ports.len() && topics.outputs.len() == entry.outputs.len());
        for row in 0..rows {
            let cells = |topics: &[opendr::ros::TopicOptions]| match topics.get(row) {
                Some(topic) => {
                    (format!("`{}`", topic.topic), format!("`{}`", topic.message_type.ros2_name()))
                }
                None => Default::default(),
            };
            let name = if row == 0 { format!("`{}`", entry.spec.name) } else { String::new() };
            let ((topic, message), (out, out_message)) = (cells(&topics.inputs), cells(&topics.outputs));
            writeln!(page, "| {name} | {topic} | {message} | {out} | {out_message} |").unwrap();
        }
    }
    page
}

#[test]
fn the_page_is_what_the_registry_makes() {
    let path = std::env::var("CARGO_MANIFEST_DIR").unwrap() + "/../../docs/ros_topics.md";
    if std::env::var_os("OPENDR_UPDATE").is_some() {
        std::fs::write(path, page()).unwrap();
        return;
    }
    let there = std::fs::read_to_string(path).unwrap();
    assert!(there == page(), "docs/ros_topics.md is old; run `cargo xtask generate`");
}
